//! What a study shows of a scenario on the page of its family.

use super::scored;
use super::shown::{OnPage, Shown};
use crate::LoadError;
use crate::load::{Loaded, LoadedSweep};

/// A study as pages show it.
pub trait Section {
    /// The section of a scenario without a sweep.
    fn of(&self, loaded: &Loaded, on: OnPage<'_>) -> Shown;

    /// The section of a sweep: its scores, where the study has nothing of its own to say of one.
    ///
    /// # Errors
    /// Records that cannot be read, or do not belong together.
    fn of_sweep(&self, loaded: &LoadedSweep, on: OnPage<'_>) -> Result<Shown, LoadError> {
        scored::sweep(loaded, on)
    }
}
