//! Inputs within limits: what is larger than any file of its kind is refused before it is in memory.
//!
//! Each is opened once, so that pipes are read as files are.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// The largest table that is read, bytes: some ten million points.
pub const LARGEST_TABLE: u64 = 1 << 30;
/// The longest line of a table, bytes: of cells that stand in messages whole.
pub const LONGEST_LINE: usize = 64 << 10;
/// The largest text that somebody writes or a program lists files in (scenarios, settings, manifests), bytes.
pub const LARGEST_TEXT: u64 = 64 << 20;

/// As [`std::fs::read_to_string`], of a file of at most [`LARGEST_TEXT`].
///
/// # Errors
/// What is larger, what is no UTF-8, and what the file system refuses; none names the path.
pub fn text(path: &Path) -> io::Result<String> {
    let no_text = |_| io::Error::new(io::ErrorKind::InvalidData, "expected text in UTF-8, found other bytes");
    String::from_utf8(whole(path, LARGEST_TEXT)?).map_err(no_text)
}

/// All bytes of a file that holds a table, which has lines: at most [`LARGEST_TABLE`], no line longer than [`LONGEST_LINE`].
///
/// # Errors
/// What is beyond that, with the limit, and what the file system refuses; none names the path.
pub fn table(path: &Path) -> io::Result<Vec<u8>> {
    lines(whole(path, LARGEST_TABLE)?)
}

/// As [`table`], from anything that can be read.
///
/// # Errors
/// As [`table`].
pub fn table_of(input: impl Read) -> io::Result<Vec<u8>> {
    lines(all(input, 0, LARGEST_TABLE)?)
}

fn lines(bytes: Vec<u8>) -> io::Result<Vec<u8>> {
    match long_line(&bytes, LONGEST_LINE) {
        None => Ok(bytes),
        Some(line) => Err(io::Error::new(
            io::ErrorKind::InvalidData,
            format!("line {line} is longer than {} kB, the limit of a table's line; expected CSV, one row a line", LONGEST_LINE >> 10),
        )),
    }
}

/// All bytes of a file, at most so many.
fn whole(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let file = File::open(path)?;
    let length = file.metadata()?.len();
    all(file, length, most)
}

/// All bytes of an input that says to have so many, at most `most`. What is no ordinary file says to have none: it is read up to the limit.
fn all(input: impl Read, length: u64, most: u64) -> io::Result<Vec<u8>> {
    let refused = || {
        let limit = if most < 1 << 20 { format!("{most} bytes") } else { format!("{} MB", most >> 20) };
        io::Error::new(io::ErrorKind::FileTooLarge, format!("is larger than {limit}, the limit of a file of this kind"))
    };
    if length > most {
        return Err(refused());
    }
    let mut bytes = Vec::with_capacity(length as usize);
    input.take(most + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most { Err(refused()) } else { Ok(bytes) }
}

/// The number of a line, counted from 1, that is longer than `most` bytes. Looks at the ends of such stretches alone.
fn long_line(bytes: &[u8], most: usize) -> Option<usize> {
    let mut from = 0;
    while bytes.len() - from > most {
        match bytes[from..=from + most].iter().rposition(|byte| matches!(byte, b'\n' | b'\r')) {
            Some(end) => from += end + 1,
            None => {
                let ends = |end: u8| bytes[..from].split(|byte| *byte == end).count();
                return Some(ends(b'\n').max(ends(b'\r')));
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_larger_is_refused_with_its_limit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        for (length, is_whole) in [(0, true), (10, true), (11, false), (1 << 40, false)] {
            // A file of that length, which takes no place on the disk.
            let file = File::create(&path).unwrap();
            file.set_len(length).unwrap();
            match whole(&path, 10) {
                Ok(bytes) => assert!(is_whole && bytes.len() as u64 == length),
                Err(error) => assert!(!is_whole && error.to_string().contains("10 bytes"), "{error}"),
            }
        }
        // Without a length that is known.
        assert_eq!(all(&b"0123456789"[..], 0, 10).unwrap(), b"0123456789");
        assert!(all(&b"0123456789a"[..], 0, 10).is_err());
    }

    #[test]
    fn a_long_line_is_found_wherever_it_stands() {
        let lines = |lengths: &[usize]| lengths.iter().map(|length| "x".repeat(*length)).collect::<Vec<_>>().join("\n").into_bytes();
        for (lengths, expected) in [
            (&[5, 5, 5][..], None),
            (&[6], Some(1)),
            (&[5, 6, 5], Some(2)),
            (&[0, 0, 0, 7], Some(4)),
            (&[1, 5, 5, 2, 9], Some(5)),
            (&[], None),
        ] {
            assert_eq!(long_line(&lines(lengths), 5), expected, "{lengths:?}");
        }
        let error = table_of(&vec![b'x'; LONGEST_LINE + 1][..]).unwrap_err().to_string();
        assert!(error.contains("line 1 is longer than 64 kB"), "{error}");
    }

    #[cfg(unix)]
    #[test]
    fn a_pipe_is_read_as_a_file_is() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("pipe");
        rustix::fs::mknodat(rustix::fs::CWD, &path, rustix::fs::FileType::Fifo, 0o600.into(), 0).unwrap();
        let written = path.clone();
        let writer = std::thread::spawn(move || std::fs::write(written, "a,b\n").unwrap());
        assert_eq!(table(&path).unwrap(), b"a,b\n");
        writer.join().unwrap();
    }
}
