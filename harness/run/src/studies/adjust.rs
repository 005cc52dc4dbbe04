//! What a run makes of the points of a trial.

use calibench_random::Key;
use calibench_records::results::{Calibrated, PointResult};
use calibench_scenario::ViewsSubject;

/// A study that adjusts image points.
pub trait Adjust {
    /// What it makes of the `points` of the trial of `key`, of each of `methods`, which are places in the scenario's list: in the order of methods, then of sets.
    /// `subject` is what is pictured; where stations are drawn anew in each trial, `key` has those.
    fn adjust(&self, subject: &ViewsSubject, points: &[PointResult], methods: &[usize], key: Key<'_>) -> Vec<Calibrated>;
}

impl<T: Adjust> Adjust for &T {
    fn adjust(&self, subject: &ViewsSubject, points: &[PointResult], methods: &[usize], key: Key<'_>) -> Vec<Calibrated> {
        (**self).adjust(subject, points, methods, key)
    }
}
