//! Adjustments within a run, in a report: published tables, every method, sets of parameters, the network and its residuals.

pub mod pictures;
mod section;
mod sweep;
mod sweep_orientation;
pub mod tables;
#[cfg(test)]
mod tests;

use super::scored;
use super::section::Section;
use super::shown::{OnPage, Shown};
use crate::LoadError;
use crate::load::{Loaded, LoadedSweep};

/// Points that are adjusted with control.
pub struct Network;

impl Section for Network {
    fn of(&self, loaded: &Loaded, on: OnPage<'_>) -> Shown {
        section::section(loaded, on).map_or_else(|| scored::section(loaded, on), Shown::from)
    }

    fn of_sweep(&self, loaded: &LoadedSweep, on: OnPage<'_>) -> Result<Shown, LoadError> {
        sweep::section(loaded, on)?.map_or_else(|| scored::sweep(loaded, on), |shown| Ok(shown.into()))
    }
}
