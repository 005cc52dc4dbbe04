//! Free networks of what was measured, in a report: what each block says, how well its points were located, what residuals have in common.

mod pictures;
mod section;
mod tables;
#[cfg(test)]
mod tests;

use super::scored;
use super::section::Section;
use super::shown::{OnPage, Shown};
use crate::load::Loaded;

/// Points of which free networks are made.
pub struct Blocks;

impl Section for Blocks {
    fn of(&self, loaded: &Loaded, on: OnPage<'_>) -> Shown {
        section::section(loaded, on).map_or_else(|| scored::section(loaded, on), Shown::from)
    }
}
