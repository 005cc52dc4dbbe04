//! Ids by which other files of a tool name its cameras: each stands once.

use std::collections::HashMap;

use super::CameraFileError;
use super::number::shortened;

/// The ids of a file so far, with their lines.
#[derive(Default)]
pub(super) struct Ids(HashMap<String, usize>);

impl Ids {
    /// Takes the id of the camera on `line`; leading zeros of a number are none of it.
    ///
    /// # Errors
    /// An id that stands on an earlier line.
    pub fn take(&mut self, id: &str, line: usize) -> Result<(), CameraFileError> {
        let key = id.parse::<u64>().map_or_else(|_| id.to_owned(), |number| number.to_string());
        match self.0.insert(key, line) {
            None => Ok(()),
            Some(first) => Err(twice(id, first, line)),
        }
    }
}

/// The error of an id that stands on two lines.
pub(super) fn twice(id: &str, first: usize, line: usize) -> CameraFileError {
    let problem = format!("the id of two cameras, first on line {first}; expected each id once: rename or remove one");
    CameraFileError::new(problem).on_line(line).of(shortened(id))
}
