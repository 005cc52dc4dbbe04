//! A list of cameras, written in pieces.

use super::CameraList;
use crate::format::Parts;
use crate::numbering::Numbering;
use crate::{CameraFileError, CameraFormat, checked_for, is_readable};
use calibench_model::NamedCamera;

/// The bytes of a list, a piece after the other: together they are those of [`super::super::camera_bytes`].
pub struct ListWriter {
    format: &'static CameraFormat,
    parts: &'static Parts,
    own_numbers: bool,
    count: usize,
    written: usize,
}

impl ListWriter {
    /// For a file of `format` of all cameras of `list`, whose names they have; with what stands before the first.
    ///
    /// # Errors
    /// A format whose files are not written in pieces.
    pub fn new(format: &'static CameraFormat, list: &CameraList) -> Result<(Self, Vec<u8>), CameraFileError> {
        let parts = format.parts.as_ref();
        let parts = parts.ok_or_else(|| CameraFileError::new(format!("the files of {} are not written in pieces", format.name)))?;
        let writer = Self { format, parts, own_numbers: list.own_numbers, count: list.count, written: 0 };
        Ok((writer, (parts.head)(list.count)))
    }

    /// The bytes of the next cameras.
    ///
    /// # Errors
    /// As [`super::super::camera_bytes`]; more cameras than the list has.
    pub fn piece(&mut self, cameras: &[NamedCamera]) -> Result<Vec<u8>, CameraFileError> {
        if cameras.is_empty() {
            return Ok(Vec::new());
        }
        let options = checked_for(self.format, cameras)?;
        let numbering = Numbering { first: self.written, own: self.own_numbers };
        let body = (self.parts.body)(cameras, numbering)?;
        is_readable(self.format, &[(self.parts.head)(cameras.len()), body.clone()].concat(), &options)?;
        self.written += cameras.len();
        if self.written > self.count { Err(self.other_count()) } else { Ok(body) }
    }

    /// Says that all pieces have been written.
    ///
    /// # Errors
    /// Fewer cameras than the list has.
    pub fn end(self) -> Result<(), CameraFileError> {
        if self.written == self.count { Ok(()) } else { Err(self.other_count()) }
    }

    fn other_count(&self) -> CameraFileError {
        CameraFileError::new(format!("{} cameras were given; expected the {} of the list", self.written, self.count))
    }
}
