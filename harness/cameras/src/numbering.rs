//! The numbers by which a list names its cameras.

use std::collections::HashSet;

use super::{CameraFileError, NamedCamera};

/// The numbers of some cameras of a list.
#[derive(Clone, Copy, Debug)]
pub(super) struct Numbering {
    /// The place of the first in the list, counted from 0.
    pub first: usize,
    /// The names are numbers that differ throughout the list; if they are not, 1, 2, ... stand for them.
    pub own: bool,
}

impl Numbering {
    /// That of a whole list.
    pub fn of(cameras: &[NamedCamera]) -> Self {
        let own: Option<Vec<u32>> = cameras.iter().map(|camera| camera.name.parse().ok()).collect();
        let differ = |ids: &Vec<u32>| ids.iter().collect::<HashSet<_>>().len() == ids.len();
        Self { first: 0, own: own.as_ref().is_some_and(differ) }
    }

    /// The number of a camera in this place among them.
    ///
    /// # Errors
    /// A camera beyond the last number.
    pub fn id(self, index: usize, camera: &NamedCamera) -> Result<u32, CameraFileError> {
        let own = self.own.then(|| camera.name.parse().ok()).flatten();
        let id = own.or_else(|| u32::try_from(self.first + index + 1).ok());
        id.ok_or_else(|| CameraFileError::new(format!("more cameras than a list can number; expected at most {}", u32::MAX)))
    }
}
