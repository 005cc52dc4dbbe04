//! What a run yields: outcomes of points, by trial.

use std::sync::Arc;

use crate::network::Calibrated;
use calibench_model::{Measurement, PixelPoint, Rejection};

/// A point more than this far from the truth, px, is lost: something else was measured.
pub const LOST: f64 = 1.0;

/// A method of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MethodInfo {
    /// Its label, as in `forstner:window=11`.
    pub label: Arc<str>,
    /// Its version.
    pub version: Arc<str>,
    /// Why it measured nothing, if so.
    pub unavailable: Option<String>,
}

/// What became of one point in the hands of one method.
#[derive(Clone, Debug, PartialEq)]
pub struct PointResult {
    /// The image.
    pub view: Arc<str>,
    /// The target.
    pub target: Arc<str>,
    /// The method's place in the list of methods.
    pub method: usize,
    /// Measured or rejected.
    pub outcome: Outcome,
    /// The Cramér-Rao bound of the position for what the method estimates, px: the square root of its trace. `None` where there is none.
    pub bound: Option<f64>,
    /// The standard deviation of the position as the method itself gives it, px: the square root of the trace of its covariance.
    pub predicted: Option<f64>,
}

impl PointResult {
    /// A result of which no uncertainty is known.
    pub fn new(view: impl Into<Arc<str>>, target: impl Into<Arc<str>>, method: usize, outcome: Outcome) -> Self {
        Self { view: view.into(), target: target.into(), method, outcome, bound: None, predicted: None }
    }

    /// What came of measuring a target that is truly at `truth`.
    pub fn scored(view: Arc<str>, target: Arc<str>, method: usize, truth: PixelPoint, result: Result<Measurement, Rejection>) -> Self {
        match result {
            Err(rejection) => Self::new(view, target, method, Outcome::Rejected(rejection)),
            Ok(found) => {
                let error = Some((found.position.x - truth.x, found.position.y - truth.y));
                let predicted = found.covariance.map(|covariance| (covariance.sxx + covariance.syy).sqrt());
                Self { predicted, ..Self::new(view, target, method, Outcome::Measured { position: found.position, error }) }
            }
        }
    }
}

/// Measured or rejected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// Measured.
    Measured {
        /// Where.
        position: PixelPoint,
        /// Measured less true position (dx, dy), px, where the truth is known.
        error: Option<(f64, f64)>,
    },
    /// Rejected by the operator.
    Rejected(Rejection),
}

impl Outcome {
    /// The error (dx, dy) of a point that was measured and not lost.
    pub fn kept_error(&self) -> Option<(f64, f64)> {
        match self {
            Self::Measured { error: Some((dx, dy)), .. } if dx.hypot(*dy) <= LOST => Some((*dx, *dy)),
            _ => None,
        }
    }

    /// Was it measured more than [`LOST`] px from the truth?
    pub fn is_lost(&self) -> bool {
        matches!(self, Self::Measured { error: Some((dx, dy)), .. } if dx.hypot(*dy) > LOST)
    }

    /// The measured position, lost or not.
    pub fn position(&self) -> Option<PixelPoint> {
        match self {
            Self::Measured { position, .. } => Some(*position),
            Self::Rejected(_) => None,
        }
    }
}

/// One trial: every point of every view, by method and then in the order of the scenario.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trial {
    /// Counted from 0.
    pub number: u64,
    /// All points of all available methods.
    pub points: Vec<PointResult>,
    /// Views without approximate positions, and why.
    pub missed_views: Vec<(Arc<str>, String)>,
    /// Adjustments of what was measured, by method and then by set of parameters, where the scenario asks for them.
    pub calibrations: Vec<Calibrated>,
}
