//! Self-calibration within a run: what each method measured in a trial goes through the bundle adjustment and is scored against the truth.
//!
//! The adjustment is told what a user would know: image coordinates, surveyed control, a data sheet's principal distance. Poses start from resections.

mod adjustment;
pub(crate) mod angles;
pub(crate) mod check;
mod discs;
mod job;
mod observe;
mod seen;

use calibench_model::Pose;
use calibench_random::Key;
use calibench_records::figures::Quantity;
use calibench_records::results::{Calibrated, Figure, PointResult};
use calibench_scenario::{Calibration, ViewsSubject};

#[cfg(test)]
pub(crate) use adjustment::control_point;
pub use adjustment::{Adjusted, Wanted, adjusted, resections};
pub use check::check;
pub use job::Job;
pub use observe::{ImagePoint, Observed, draw, observe};
use seen::Seen;

use super::adjust::Adjust;

impl Adjust for Calibration {
    fn adjust(&self, subject: &ViewsSubject, points: &[PointResult], methods: &[usize], key: Key<'_>) -> Vec<Calibrated> {
        let ViewsSubject { camera, field, unit, stations, .. } = subject;
        calibrate(&Job { calibration: self, field, unit: *unit, camera, stations }, points, methods, key)
    }
}

/// Adjusts what each of `methods` measured in the trial of `key`: every set of parameters, the first with the second step.
pub fn calibrate(job: &Job<'_>, points: &[PointResult], methods: &[usize], key: Key<'_>) -> Vec<Calibrated> {
    let observed = observe(job, points, key);
    let mut all = Vec::new();
    for &method in methods {
        let seen = match Seen::of(job, &observed, method) {
            Ok(seen) => seen,
            Err(why) => {
                let failed = |set| Calibrated { method, set, outcome: Err(why.clone()), check_failed: None };
                all.extend((0..job.calibration.sets.len()).map(failed));
                continue;
            }
        };
        let mut starts = resections(&seen.job(job), &seen.observed, method);
        for set in 0..job.calibration.sets.len() {
            let (calibrated, poses) = one(job, &observed, &seen, (method, set), &starts, key.trial == 0);
            all.push(calibrated);
            // The other sets start where the first ended: from nothing but the same observations.
            if let Some(poses) = poses.filter(|_| set == 0) {
                starts = Ok(poses);
            }
        }
    }
    all
}

type Poses = Result<Vec<Pose>, String>;

fn one(
    job: &Job<'_>,
    observed: &Observed,
    seen: &Seen<'_>,
    (method, set): (usize, usize),
    starts: &Poses,
    points: bool,
) -> (Calibrated, Option<Vec<Pose>>) {
    let parameters: Vec<&str> = job.calibration.sets[set].parameters.iter().map(String::as_str).collect();
    let what = match (set, points) {
        (0, true) => Wanted::Points,
        (0, false) => Wanted::All,
        _ => Wanted::Interior,
    };
    let result = starts.clone().and_then(|starts| adjusted(&seen.job(job), &seen.observed, method, &parameters, &starts, what));
    let (mut poses, mut check_failed) = (None, None);
    let outcome = result.map(|adjusted| {
        let mut figures = adjusted.figures;
        if seen.left_out > 0 {
            figures.push(Figure::plain(Quantity::ImagesLeftOut, seen.left_out as f64, ""));
        }
        poses = Some(adjusted.poses);
        if let Some(plan) = job.calibration.check.as_ref().filter(|_| set == 0) {
            match check(job, plan, observed, method, &adjusted.camera) {
                Ok(found) => figures.extend(found),
                Err(why) => check_failed = Some(why),
            }
        }
        figures
    });
    (Calibrated { method, set, outcome, check_failed }, poses)
}
