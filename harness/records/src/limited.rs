//! Readers that end: compressed files may grow without end while they are read.

use std::fs::File;
use std::io::{self, BufReader, Read};

use flate2::bufread::MultiGzDecoder;

/// Tables of records unpack to a tenth of this many times their length, those of methods that are all unavailable to a third.
const MOST_GROWTH: u64 = 500;
/// Whatever the length of a file, this many bytes may come out of it.
const LEAST_LIMIT: u64 = 64 << 20;

/// What a compressed file of records holds; beyond what such a file can hold it ends with an error that names the limit.
///
/// # Errors
/// What the file system refuses.
pub fn unpacked(file: File) -> io::Result<impl Read + use<>> {
    let most = file.metadata()?.len().saturating_mul(MOST_GROWTH).max(LEAST_LIMIT);
    Ok(Limited { input: MultiGzDecoder::new(BufReader::with_capacity(1 << 16, file)), left: most, most })
}

struct Limited<R> {
    input: R,
    left: u64,
    most: u64,
}

impl<R: Read> Read for Limited<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.input.read(buffer)?;
        let left = self.left.checked_sub(read as u64);
        self.left = left.ok_or_else(|| {
            let words = format!("unpacks to more than {} MB, the limit of records of this length", self.most >> 20);
            io::Error::new(io::ErrorKind::FileTooLarge, words)
        })?;
        Ok(read)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_grows_is_read_up_to_the_limit() {
        let read = |most| Limited { input: io::repeat(0).take(3 << 20), left: most, most }.read_to_end(&mut Vec::new());
        assert_eq!(read(3 << 20).unwrap(), 3 << 20);
        assert!(read((3 << 20) - 1).unwrap_err().to_string().contains("more than 2 MB"));
    }
}
