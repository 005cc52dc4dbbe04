//! A file of ours in a folder that is not all ours.

use std::io;
use std::path::Path;

use super::manifest::{MANIFEST, Manifest};
use crate::atomic::write_atomically;

/// Writes the file `name` into `folder`, which may hold anything else; the folder's manifest lists it. One that is there is replaced if calibench
/// wrote it and it was not changed since.
///
/// # Errors
/// Another file of this name, and what the file system refuses.
pub fn write_beside(folder: &Path, name: &str, content: &[u8]) -> io::Result<()> {
    let path = folder.join(name);
    let mut manifest = Manifest::read(folder)?.unwrap_or_default();
    let new = blake3::hash(content).to_hex();
    if path.exists() {
        let there = super::manifest::digest(&path)?;
        if there == new.as_str() && manifest.has(name, &there) {
            return Ok(());
        }
        if there != new.as_str() && !manifest.has(name, &there) {
            let why = "calibench did not write it, or it was changed since; it is not replaced: move it elsewhere";
            return Err(io::Error::new(io::ErrorKind::AlreadyExists, format!("{}: {why}", path.display())));
        }
    }
    // Killed in between, the file is the old or the new one, and both are ours.
    manifest.add(name, new.as_str());
    write_manifest(folder, &manifest)?;
    write_atomically(&path, |file| file.write_all(content))?;
    manifest.set(name, new.as_str());
    write_manifest(folder, &manifest)
}

fn write_manifest(folder: &Path, manifest: &Manifest) -> io::Result<()> {
    write_atomically(&folder.join(MANIFEST), |file| file.write_all(manifest.text().as_bytes()))
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn a_page_of_the_users_own_is_kept_and_ours_is_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let page = folder.path().join("README.md");
        fs::write(folder.path().join("notes.txt"), "mine").unwrap();
        write_beside(folder.path(), "README.md", b"one").unwrap();
        write_beside(folder.path(), "README.md", b"two").unwrap();
        let whole = fs::read(folder.path().join(MANIFEST)).unwrap();
        write_beside(folder.path(), "README.md", b"two").unwrap();
        assert!(fs::read(folder.path().join(MANIFEST)).unwrap() == whole);
        fs::write(&page, "two, corrected").unwrap();
        let error = write_beside(folder.path(), "README.md", b"three").unwrap_err().to_string();
        assert!(error.contains("README.md: calibench did not write it"), "{error}");
        assert_eq!(fs::read_to_string(&page).unwrap(), "two, corrected");
        fs::remove_file(folder.path().join(MANIFEST)).unwrap();
        assert!(write_beside(folder.path(), "README.md", b"three").is_err());
        fs::remove_file(&page).unwrap();
        write_beside(folder.path(), "README.md", b"three").unwrap();
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 3);
    }

    #[test]
    fn one_that_was_interrupted_is_taken_up() {
        let folder = tempfile::tempdir().unwrap();
        write_beside(folder.path(), "README.md", b"one").unwrap();
        let mut manifest = Manifest::read(folder.path()).unwrap().unwrap();
        manifest.add("README.md", blake3::hash(b"two").to_hex().as_str());
        for there in ["one", "two"] {
            write_manifest(folder.path(), &manifest).unwrap();
            fs::write(folder.path().join("README.md"), there).unwrap();
            write_beside(folder.path(), "README.md", b"three").unwrap();
            write_beside(folder.path(), "README.md", b"one").unwrap();
        }
    }
}
