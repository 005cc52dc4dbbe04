//! Digests of files, and the list of them as `sha256sum` writes and checks it.

use std::fmt::Write;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use sha2::{Digest, Sha256};

/// SHA-256 of bytes, as hexadecimal digits.
pub fn digest_of(bytes: &[u8]) -> String {
    hex(Sha256::digest(bytes).as_ref())
}

/// SHA-256 of a file, and its size; it is read piece by piece.
///
/// # Errors
/// What the file system refuses.
pub fn digest_of_file(path: &Path) -> io::Result<(String, u64)> {
    let mut file = File::open(path)?;
    let (mut hasher, mut bytes) = (Sha256::new(), 0);
    let mut piece = vec![0; 1 << 18];
    loop {
        match file.read(&mut piece)? {
            0 => return Ok((hex(hasher.finalize().as_ref()), bytes)),
            read => {
                hasher.update(&piece[..read]);
                bytes += read as u64;
            }
        }
    }
}

fn hex(digest: &[u8]) -> String {
    let mut text = String::with_capacity(2 * digest.len());
    for byte in digest {
        // Writing to a String cannot fail.
        let _ = write!(text, "{byte:02x}");
    }
    text
}

/// A line of the list: as `sha256sum` has it, names with a backslash or a line end behind a backslash.
pub fn line(digest: &str, path: &str) -> String {
    if path.contains(['\\', '\n', '\r']) {
        let path = path.replace('\\', "\\\\").replace('\n', "\\n").replace('\r', "\\r");
        return format!("\\{digest}  {path}\n");
    }
    format!("{digest}  {path}\n")
}

/// The digest of a line of the list.
pub fn of_line(line: &str) -> Option<&str> {
    let digest = line.strip_prefix('\\').unwrap_or(line).get(..64)?;
    digest.bytes().all(|byte| byte.is_ascii_hexdigit()).then_some(digest)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Source: FIPS 180-4, examples of NIST.
    #[test]
    fn digests_are_those_of_the_standard() {
        assert_eq!(digest_of(b""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
        assert_eq!(digest_of(b"abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("million");
        std::fs::write(&path, vec![b'a'; 1_000_000]).unwrap();
        let (digest, bytes) = digest_of_file(&path).unwrap();
        assert_eq!((digest.as_str(), bytes), ("cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0", 1_000_000));
    }

    #[test]
    fn a_line_is_that_of_sha256sum() {
        let digest = digest_of(b"");
        assert_eq!(line(&digest, "a b.png"), format!("{digest}  a b.png\n"));
        assert_eq!(line(&digest, "a\\b\n.png"), format!("\\{digest}  a\\\\b\\n.png\n"));
        assert_eq!([of_line(&line(&digest, "a")), of_line(&line(&digest, "a\\"))], [Some(digest.as_str()); 2]);
        assert_eq!([of_line("abc  a"), of_line("")], [None; 2]);
    }
}
