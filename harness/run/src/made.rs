//! A trial as it is made.

use calibench_records::results::{Calibrated, Trial};

/// What was made of a trial.
#[derive(Default)]
pub(crate) struct Made {
    /// Its points, and what was adjusted from them.
    pub trial: Trial,
    /// What was counted beside the points.
    pub counted: Vec<Calibrated>,
}

impl Made {
    /// The trial with everything.
    pub fn into_trial(mut self) -> Trial {
        self.trial.calibrations.extend(self.counted);
        self.trial
    }
}

impl From<Trial> for Made {
    fn from(trial: Trial) -> Self {
        Self { trial, counted: Vec::new() }
    }
}
