//! What a run makes of the points of a trial.

use calibench_random::Key;
use calibench_records::results::{Calibrated, PointResult};
use calibench_scenario::ViewsSubject;

/// A study that adjusts image points.
pub trait Adjust {
    /// What it makes of the `points` of the trial of `key`, of each of `methods`, which are places in the scenario's list: in the order of methods, then of sets.
    /// `subject` is what is pictured, with stations that are the same in all trials.
    fn adjust(&self, subject: &ViewsSubject, points: &[PointResult], methods: &[usize], key: Key<'_>) -> Vec<Calibrated>;
}
