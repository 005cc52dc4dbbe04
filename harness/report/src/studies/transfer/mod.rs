//! Calibrated here, applied there, in a report: what check points make of each calibration under each condition, and which cause makes how much of it.

mod boards;
mod cases;
mod check_points;
mod decomposition;
mod errors;
mod section;
mod sweep;
#[cfg(test)]
mod tests;

use super::scored;
use super::section::Section;
use super::shown::{OnPage, Shown};
use crate::LoadError;
use crate::load::{Loaded, LoadedSweep};

/// Calibrations that are applied elsewhere.
pub struct Transfer;

impl Section for Transfer {
    fn of(&self, loaded: &Loaded, on: OnPage<'_>) -> Shown {
        section::section(loaded, on).map_or_else(|| scored::section(loaded, on), Shown::from)
    }

    fn of_sweep(&self, loaded: &LoadedSweep, on: OnPage<'_>) -> Result<Shown, LoadError> {
        sweep::section(loaded, on)?.map_or_else(|| scored::sweep(loaded, on), |shown| Ok(shown.into()))
    }
}
