//! The numbers by which a list names its cameras.

use std::collections::HashSet;

use crate::camera::{CameraFileError, NamedCamera};

/// The numbers of some cameras of a list.
#[derive(Clone, Copy, Debug)]
pub(in crate::camera) struct Numbering {
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

/// Numbers so far, with their places, 8 bytes each.
#[derive(Default)]
pub(super) struct Numbers {
    all: Vec<(u32, u32)>,
    rises: bool,
}

impl Numbers {
    /// Takes one that stands in a place, a line or a number of cameras.
    pub fn push(&mut self, id: u32, place: usize) {
        self.rises = self.all.last().map_or(true, |(last, _)| self.rises && *last < id);
        self.all.push((id, u32::try_from(place).unwrap_or(u32::MAX)));
    }

    /// The first one that stood before: it, its first place and this one.
    pub fn twice(&mut self) -> Option<(u32, usize, usize)> {
        // As tools write them, in order.
        if self.rises {
            return None;
        }
        self.all.sort_unstable();
        let same = self.all.chunk_by(|a, b| a.0 == b.0).filter(|same| same.len() > 1);
        same.map(|same| (same[0].0, same[0].1 as usize, same[1].1 as usize)).min_by_key(|(.., again)| *again)
    }
}

/// Whether names are numbers that differ, as far as they have been seen.
pub(super) struct Names(Option<Numbers>);

impl Default for Names {
    fn default() -> Self {
        Self(Some(Numbers::default()))
    }
}

impl Names {
    /// Takes one.
    pub fn push(&mut self, name: &str) {
        match (name.parse(), &mut self.0) {
            (Ok(number), Some(numbers)) => numbers.push(number, 0),
            _ => self.0 = None,
        }
    }

    /// Whether all are numbers that differ.
    pub fn are_numbers(mut self) -> bool {
        self.0.as_mut().is_some_and(|numbers| numbers.twice().is_none())
    }
}
