//! The quantisation of JPEG files.

use std::fs::File;
use std::io::{self, BufReader, ErrorKind, Read};
use std::path::Path;

/// The places of coefficients of a block of 8 x 8 in the order of the file, row by row (ITU-T T.81, figure 5).
const ZIGZAG: [usize; 64] = [
    0, 1, 8, 16, 9, 2, 3, 10, 17, 24, 32, 25, 18, 11, 4, 5, 12, 19, 26, 33, 40, 48, 41, 34, 27, 20, 13, 6, 7, 14, 21, 28, 35, 42, 49, 56,
    57, 50, 43, 36, 29, 22, 15, 23, 30, 37, 44, 51, 58, 59, 52, 45, 38, 31, 39, 46, 53, 60, 61, 54, 47, 55, 62, 63,
];

/// The luminance quantisation table of a JPEG file, row by row, as its pixels are stored; `None` of a file that is no JPEG or has no table of 8 bits before its first scan.
///
/// # Errors
/// A file that cannot be opened or read.
pub fn quantisation(path: &Path) -> io::Result<Option<[u8; 64]>> {
    match first_table(&mut BufReader::new(File::open(path)?)) {
        Err(error) if error.kind() == ErrorKind::UnexpectedEof => Ok(None),
        found => found,
    }
}

fn first_table(file: &mut impl Read) -> io::Result<Option<[u8; 64]>> {
    let mut two = [0; 2];
    file.read_exact(&mut two)?;
    if two != [0xff, 0xd8] {
        return Ok(None);
    }
    loop {
        file.read_exact(&mut two)?;
        let marker = two[1];
        // The scan begins, or the file is none.
        if two[0] != 0xff || marker == 0xda {
            return Ok(None);
        }
        file.read_exact(&mut two)?;
        let mut segment = vec![0; usize::from(u16::from_be_bytes(two)).saturating_sub(2)];
        file.read_exact(&mut segment)?;
        if marker == 0xdb
            && let Some(table) = luminance(&segment)
        {
            return Ok(Some(table));
        }
    }
}

/// Table 0 of 8 bits in a segment of tables.
fn luminance(mut segment: &[u8]) -> Option<[u8; 64]> {
    while let Some((&head, rest)) = segment.split_first() {
        let length = if head >> 4 == 0 { 64 } else { 128 };
        let table = rest.get(..length)?;
        if head == 0 {
            let mut natural = [0; 64];
            ZIGZAG.iter().zip(table).for_each(|(place, value)| natural[*place] = *value);
            return Some(natural);
        }
        segment = &rest[length..];
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A head of JPEG with a comment and a table 1 before table 0.
    fn file() -> Vec<u8> {
        let mut bytes = vec![0xff, 0xd8, 0xff, 0xfe, 0, 4, b'h', b'i', 0xff, 0xdb, 0, 132, 1];
        bytes.extend([9; 64]);
        bytes.push(0);
        bytes.extend(1..=64);
        bytes.extend([0xff, 0xda, 0, 2]);
        bytes
    }

    #[test]
    fn the_luminance_table_is_found_and_put_in_rows() {
        let table = first_table(&mut file().as_slice()).unwrap().unwrap();
        assert_eq!(table[..8], [1, 2, 6, 7, 15, 16, 28, 29]);
        assert_eq!((table[8], table[63]), (3, 64));
    }

    #[test]
    fn what_is_no_jpeg_or_ends_early_has_none() {
        assert_eq!(first_table(&mut &b"\x89PNG\r\n\x1a\n"[..]).unwrap(), None);
        let whole = file();
        for end in 2..whole.len() - 4 {
            let folder = tempfile::tempdir().unwrap();
            let path = folder.path().join("short.jpg");
            std::fs::write(&path, &whole[..end]).unwrap();
            assert_eq!(quantisation(&path).unwrap(), None, "{end}");
        }
        assert_eq!(first_table(&mut &[0xff, 0xd8, 0xff, 0xda, 0, 2][..]).unwrap(), None);
    }
}
