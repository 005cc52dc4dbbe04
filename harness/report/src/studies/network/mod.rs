//! Adjustments within a run, in a report: published tables, every method, sets of parameters, the network and its residuals.

pub mod pictures;
mod section;
mod sweep;
mod sweep_orientation;
pub mod tables;
#[cfg(test)]
mod tests;

use super::section::Section;
use super::shown::{OnPage, Shown};
use super::{accepted, scored};
use crate::LoadError;
use crate::load::{Loaded, LoadedSweep};

/// Points that are adjusted with control.
pub struct Network;

impl Section for Network {
    fn of(&self, loaded: &Loaded, on: OnPage<'_>) -> Shown {
        section::section(loaded, on).map_or_else(|| scored::section(loaded, on), Shown::from)
    }

    fn of_sweep(&self, loaded: &LoadedSweep, on: OnPage<'_>) -> Result<Shown, LoadError> {
        let shown = sweep::section(loaded, on)?.map_or_else(|| scored::sweep(loaded, on), |shown| Ok(shown.into()))?;
        let Some((views, told)) = loaded.scenario.adjusted() else { return Ok(shown) };
        let Some(classes) = told.acceptance else { return Ok(shown) };
        let stem = format!("{}-acceptance", on.stem);
        let kept = accepted::sweep(loaded, OnPage { stem: &stem, ..on }, &accepted::of_classes(classes, &views.unit))?;
        let Some(kept) = kept else { return Ok(shown) };
        Ok(Shown { text: kept.text + &shown.text, pictures: kept.pictures.into_iter().chain(shown.pictures).collect(), ..shown })
    }
}
