//! Points that are scored one by one.

use super::scored;
use super::section::Section;
use super::shown::{OnPage, Shown};
use crate::load::Loaded;

/// Points, each scored against the truth.
pub struct Points;

impl Section for Points {
    fn of(&self, loaded: &Loaded, on: OnPage<'_>) -> Shown {
        scored::section(loaded, on)
    }
}
