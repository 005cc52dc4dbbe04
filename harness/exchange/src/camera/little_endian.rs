//! Numbers of binary files, the least byte first.

use super::CameraFileError;

/// What of a file is still to be read.
pub(super) struct Bytes<'a> {
    all: &'a [u8],
    at: usize,
}

impl<'a> Bytes<'a> {
    /// All of a file.
    pub fn new(all: &'a [u8]) -> Self {
        Self { all, at: 0 }
    }

    /// How many bytes are left.
    pub fn left(&self) -> usize {
        self.all.len() - self.at
    }

    /// The next `count` bytes.
    ///
    /// # Errors
    /// A file that ends before.
    pub fn take(&mut self, count: u64) -> Result<&'a [u8], CameraFileError> {
        let rest = &self.all[self.at..];
        let found = usize::try_from(count).ok().and_then(|count| rest.get(..count));
        let found = found.ok_or_else(|| {
            let (left, length) = (rest.len(), self.all.len());
            CameraFileError::new(format!(
                "the file of {length} bytes ends here: expected {count} more, found {left}; it was cut off or its counts are wrong"
            ))
        })?;
        self.at += found.len();
        Ok(found)
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N], CameraFileError> {
        let mut bytes = [0; N];
        bytes.copy_from_slice(self.take(N as u64)?);
        Ok(bytes)
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
    /// A file that ends before, bytes that are not UTF-8.
    pub fn text(&mut self) -> Result<&'a str, CameraFileError> {
        let rest = &self.all[self.at..];
        let length =
            rest.iter().position(|byte| *byte == 0).ok_or_else(|| CameraFileError::new("expected a name that ends with a zero byte"))?;
        let text = std::str::from_utf8(&rest[..length]).map_err(|_| CameraFileError::new("expected a name in UTF-8, found other bytes"))?;
        self.at += length + 1;
        Ok(text)
    }
}
