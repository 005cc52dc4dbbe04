//! Photographs, of which no truth is known.

use super::section::Section;
use super::shown::{OnPage, Shown};
use crate::load::Loaded;
use crate::photographs::{Said, section};

/// Photographs.
pub struct Photographs;

impl Section for Photographs {
    fn of(&self, loaded: &Loaded, _: OnPage<'_>) -> Shown {
        let Said { answer, text, pictures } = section(loaded);
        Shown { answer, text, pictures, scored: false }
    }
}
