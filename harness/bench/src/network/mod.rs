//! Self-calibration within a run: what each method measured in a trial goes through the bundle adjustment and is scored against the truth.
//!
//! The adjustment is told what a user would know: image coordinates, surveyed control, a data sheet's principal distance. Poses start from resections.

mod adjustment;
mod angles;
mod check;
mod observe;
pub mod records;

use std::sync::Arc;

use calibench_model::camera::Camera;
use calibench_model::{Pose, Testfield};
use calibench_synth::random::Key;
use calibench_synth::stations::Station;

use crate::results::PointResult;
use crate::scenario::{Calibration, Unit};

pub use adjustment::{Adjusted, Wanted, adjusted, resections};
pub use observe::{ImagePoint, Observed, draw, observe};

/// What a figure is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Group {
    /// A parameter of the interior orientation, by name.
    Iop,
    /// A parameter of an exterior orientation, as in `6/phi`.
    Eop,
    /// The adjustment as a whole: sigma0, redundancy, iterations, image points.
    Network,
    /// The camera over the frame: its rms distance from the true one after the best rotation.
    Frame,
    /// The second step: errors of check points.
    Check,
    /// Root mean square residual of an image, by its name.
    Residual,
    /// A residual of the first trial, as in `6/left/3/x`.
    Point,
}

impl Group {
    /// All groups with their names in files.
    pub const ALL: [(Self, &'static str); 7] = [
        (Self::Iop, "iop"),
        (Self::Eop, "eop"),
        (Self::Network, "network"),
        (Self::Frame, "frame"),
        (Self::Check, "check"),
        (Self::Residual, "residual"),
        (Self::Point, "point"),
    ];

    /// The name in files.
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(group, _)| *group == self).map_or("", |(_, name)| name)
    }
}

/// A figure of an adjustment.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// What it is about.
    pub group: Group,
    /// Its name within the group.
    pub name: Arc<str>,
    /// Its value.
    pub value: f64,
    /// Its standard deviation as the adjustment gives it, with the estimated variance factor.
    pub sigma: Option<f64>,
    /// Value less truth.
    pub error: Option<f64>,
    /// The unit of all three.
    pub unit: &'static str,
}

impl Figure {
    fn plain(group: Group, name: impl Into<Arc<str>>, value: f64, unit: &'static str) -> Self {
        Self { group, name: name.into(), value, sigma: None, error: None, unit }
    }
}

/// What became of one set of parameters with one method's points in one trial.
#[derive(Clone, Debug, PartialEq)]
pub struct Calibrated {
    /// The method's place in the list of methods.
    pub method: usize,
    /// The set's place in the list of sets.
    pub set: usize,
    /// Figures, or why there are none.
    pub outcome: Result<Vec<Figure>, String>,
    /// Why the second step has no figures, if so.
    pub check_failed: Option<String>,
}

/// What is true, and what the scenario says of the adjustment.
#[derive(Clone, Copy)]
pub struct Job<'a> {
    /// What to do.
    pub calibration: &'a Calibration,
    /// The wall as it is, with its coordinates as surveyed.
    pub field: &'a Testfield,
    /// The object unit.
    pub unit: Unit,
    /// The true camera.
    pub camera: &'a Camera,
    /// The true poses.
    pub stations: &'a [Station],
}

/// Adjusts what each of `methods` measured in the trial of `key`: every set of parameters, the first with the second step.
pub fn calibrate(job: &Job<'_>, points: &[PointResult], methods: &[usize], key: Key<'_>) -> Vec<Calibrated> {
    let observed = observe(job, points, key);
    let mut all = Vec::new();
    for &method in methods {
        let mut starts = resections(job, &observed, method);
        for set in 0..job.calibration.sets.len() {
            let (calibrated, poses) = one(job, &observed, method, set, &starts, key.trial == 0);
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

fn one(job: &Job<'_>, observed: &Observed, method: usize, set: usize, starts: &Poses, points: bool) -> (Calibrated, Option<Vec<Pose>>) {
    let parameters: Vec<&str> = job.calibration.sets[set].parameters.iter().map(String::as_str).collect();
    let what = match (set, points) {
        (0, true) => Wanted::Points,
        (0, false) => Wanted::All,
        _ => Wanted::Interior,
    };
    let result = starts.clone().and_then(|starts| adjusted(job, observed, method, &parameters, &starts, what));
    let (mut poses, mut check_failed) = (None, None);
    let outcome = result.map(|adjusted| {
        let mut figures = adjusted.figures;
        poses = Some(adjusted.poses);
        if let Some(plan) = job.calibration.check.as_ref().filter(|_| set == 0) {
            match check::check(job, plan, observed, method, &adjusted.camera) {
                Ok(found) => figures.extend(found),
                Err(why) => check_failed = Some(why),
            }
        }
        figures
    });
    (Calibrated { method, set, outcome, check_failed }, poses)
}
