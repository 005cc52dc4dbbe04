//! Printed figures, recomputed, in a report.

mod grids;
mod maps;
mod pictures;
mod section;
mod tables;
#[cfg(test)]
mod tests;

use calibench_records::description::Study;

use super::section::Section;
use super::shown::{OnPage, Shown};
use crate::load::Loaded;

/// Printed figures, recomputed.
pub struct Printed;

impl Section for Printed {
    fn of(&self, loaded: &Loaded, on: OnPage<'_>) -> Shown {
        let Study::Printed(sets) = &loaded.scenario.study else { return Shown::default() };
        section::section(loaded, sets, on.stem).into()
    }
}
