//! Free networks and rigs within a run: each trial is adjusted from nothing as `calibrate` adjusts it, and what it says of itself is held against the truth.
//!
//! The adjustment is told what a user would know: image coordinates, measured distances, of a rig the surveyed targets. The truth has its part afterwards: in the errors of what
//! was estimated, and as the start of a second adjustment that tells whether the first ended in the least minimum.

mod errors;
mod free;
mod rig;

use calibench_random::Key;
use calibench_records::results::{Calibrated, PointResult};
use calibench_scenario::ViewsSubject;
use calibench_scenario::studies::networks::{Kind, Networks};

use super::adjust::Adjust;
use super::told::Trial;

impl Adjust for Networks {
    fn adjust(&self, subject: &ViewsSubject, points: &[PointResult], methods: &[usize], key: Key<'_>) -> Vec<Calibrated> {
        let of_method = |&method: &usize| {
            let trial = Trial::of((&self.model, self.sigma_px), subject, (points, method), key);
            let outcome = trial.and_then(|trial| match &self.kind {
                Kind::Free { distances, lengths, acceptance } => free::figures(&trial, (distances, lengths, acceptance.as_ref()), key),
                Kind::Rig(mounts) => rig::figures(&trial, mounts),
            });
            Calibrated { method, set: 0, outcome, check_failed: None }
        };
        methods.iter().map(of_method).collect()
    }
}
