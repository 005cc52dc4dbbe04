//! Numbers of binary files, the least byte first.

use std::io::{self, BufRead, BufReader, Read, Seek};

use super::CameraFileError;

/// The longest name, bytes: what goes on without a zero byte is none.
const LONGEST_NAME: u64 = 1 << 16;

/// Bytes that are read in order, some of them passed over.
pub(super) trait Stream: BufRead {
    /// Passes over `count` bytes, which are there.
    fn pass(&mut self, count: u64) -> io::Result<()>;
}

impl Stream for &[u8] {
    fn pass(&mut self, count: u64) -> io::Result<()> {
        *self = usize::try_from(count).ok().and_then(|count| self.get(count..)).unwrap_or_default();
        Ok(())
    }
}

impl<R: Read + Seek> Stream for BufReader<R> {
    fn pass(&mut self, mut count: u64) -> io::Result<()> {
        while count > 0 {
            let step = count.min(i64::MAX as u64);
            self.seek_relative(step.cast_signed())?;
            count -= step;
        }
        Ok(())
    }
}

/// What of a file is still to be read.
pub(super) struct Bytes<R> {
    rest: R,
    at: u64,
    length: u64,
}

impl<'a> Bytes<&'a [u8]> {
    /// All of a file.
    pub fn new(all: &'a [u8]) -> Self {
        Self::of(all, all.len() as u64)
    }
}

impl<R: Stream> Bytes<R> {
    /// A file of `length` bytes from its beginning.
    pub fn of(rest: R, length: u64) -> Self {
        Self { rest, at: 0, length }
    }

    /// How many bytes have been read.
    pub fn at(&self) -> u64 {
        self.at
    }

    /// How many bytes are left.
    pub fn left(&self) -> u64 {
        self.length - self.at
    }

    /// The source, which does not begin anew.
    pub fn source(&mut self) -> &mut R {
        &mut self.rest
    }

    /// Takes the source to be at this byte.
    pub fn stands_at(&mut self, at: u64) {
        self.at = at.min(self.length);
    }

    /// Passes over `count` bytes.
    ///
    /// # Errors
    /// A file that ends before.
    pub fn pass(&mut self, count: u64) -> Result<(), CameraFileError> {
        self.expect(count)?;
        self.rest.pass(count).map_err(|error| unreadable(&error))?;
        self.at += count;
        Ok(())
    }

    fn expect(&self, count: u64) -> Result<(), CameraFileError> {
        let (left, length) = (self.left(), self.length);
        if count <= left {
            return Ok(());
        }
        let problem =
            format!("the file of {length} bytes ends here: expected {count} more, found {left}; it was cut off or its counts are wrong");
        Err(CameraFileError::new(problem))
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N], CameraFileError> {
        self.expect(N as u64)?;
        let mut bytes = [0; N];
        self.rest.read_exact(&mut bytes).map_err(|error| unreadable(&error))?;
        self.at += N as u64;
        Ok(bytes)
    }

    pub fn u8(&mut self) -> Result<u8, CameraFileError> {
        self.array().map(u8::from_le_bytes)
    }

    pub fn u32(&mut self) -> Result<u32, CameraFileError> {
        self.array().map(u32::from_le_bytes)
    }

    pub fn i32(&mut self) -> Result<i32, CameraFileError> {
        self.array().map(i32::from_le_bytes)
    }

    pub fn u64(&mut self) -> Result<u64, CameraFileError> {
        self.array().map(u64::from_le_bytes)
    }

    /// A finite number.
    pub fn f64(&mut self) -> Result<f64, CameraFileError> {
        let value = self.array().map(f64::from_le_bytes)?;
        if value.is_finite() { Ok(value) } else { Err(CameraFileError::new(format!("expected a finite number, found {value}"))) }
    }

    /// Text up to a zero byte, which is read too.
    ///
    /// # Errors
    /// A file that ends before, a text of more than 65,536 bytes, bytes that are not UTF-8.
    pub fn text(&mut self) -> Result<String, CameraFileError> {
        let mut bytes = Vec::new();
        let found = self.rest.by_ref().take(LONGEST_NAME + 1).read_until(0, &mut bytes).map_err(|error| unreadable(&error))?;
        self.at += found as u64;
        if bytes.pop() != Some(0) {
            return Err(CameraFileError::new("expected a name that ends with a zero byte"));
        }
        String::from_utf8(bytes).map_err(|_| CameraFileError::new("expected a name in UTF-8, found other bytes"))
    }
}

fn unreadable(error: &io::Error) -> CameraFileError {
    CameraFileError::new(error.to_string())
}
