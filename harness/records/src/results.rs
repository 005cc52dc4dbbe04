//! What a run yields: outcomes of points, by trial.

use std::sync::Arc;

use calibench_model::{Measurement, PixelPoint, Rejection};

use crate::figures::{FigureName, Kind};

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

/// The result of one method at one point.
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

/// Whether an error is shorter than [`LOST`] beyond doubt: nearly all are, and of these no root is drawn.
fn is_short(dx: f64, dy: f64) -> bool {
    const SURELY: f64 = 0.7 * LOST;
    dx.abs() < SURELY && dy.abs() < SURELY
}

/// Measured or rejected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// Measured.
    Measured {
        /// Image coordinates, px.
        position: PixelPoint,
        /// Measured less true position (dx, dy), px, where the truth is known.
        error: Option<(f64, f64)>,
    },
    /// Rejected by the operator.
    Rejected(Rejection),
}

impl Outcome {
    /// The error (dx, dy), px, of a point that was measured and not lost.
    pub fn kept_error(&self) -> Option<(f64, f64)> {
        match self {
            Self::Measured { error: Some((dx, dy)), .. } if is_short(*dx, *dy) || dx.hypot(*dy) <= LOST => Some((*dx, *dy)),
            _ => None,
        }
    }

    /// Whether it was measured more than [`LOST`] px from the truth.
    pub fn is_lost(&self) -> bool {
        matches!(self, Self::Measured { error: Some((dx, dy)), .. } if !is_short(*dx, *dy) && dx.hypot(*dy) > LOST)
    }

    /// The measured position, lost or not.
    pub fn position(&self) -> Option<PixelPoint> {
        match self {
            Self::Measured { position, .. } => Some(*position),
            Self::Rejected(_) => None,
        }
    }
}

/// A figure of an adjustment.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// What it is a value of.
    pub name: FigureName,
    /// Its value, in [`Self::unit`].
    pub value: f64,
    /// Its standard deviation as the adjustment gives it, with the estimated variance factor, in the same unit.
    pub sigma: Option<f64>,
    /// Value less truth, in the same unit.
    pub error: Option<f64>,
    /// The unit of all three.
    pub unit: &'static str,
}

impl Figure {
    /// A figure of which neither standard deviation nor error is known; `unit` is that of `value`.
    pub fn plain(name: impl Into<FigureName>, value: f64, unit: &'static str) -> Self {
        Self { name: name.into(), value, sigma: None, error: None, unit }
    }
}

/// The figure of this name, if it is among `figures`.
pub fn find(figures: &[Figure], name: impl Into<FigureName>) -> Option<&Figure> {
    let name = name.into();
    figures.iter().find(|figure| figure.name == name)
}

/// The adjustment of one set of parameters to one method's points of one trial.
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

impl Calibrated {
    /// What kind of result it is: as its figures say that one kind alone has; of an adjustment that failed, and of one with none of these, nothing is known.
    pub fn kind(&self) -> Option<Kind> {
        self.outcome.iter().flatten().find_map(|figure| figure.name.quantity().entry().kind)
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

#[cfg(test)]
mod tests {
    use calibench_model::Covariance;

    use super::*;

    fn off(dx: f64, dy: f64) -> Outcome {
        Outcome::Measured { position: PixelPoint::new(10.0 + dx, 20.0 + dy), error: Some((dx, dy)) }
    }

    #[test]
    fn an_error_is_the_measured_less_the_true_position() {
        let measured = |covariance| Ok(Measurement { position: PixelPoint::new(10.25, 19.0), covariance });
        let scored = |result| PointResult::scored("v".into(), "t".into(), 3, PixelPoint::new(10.0, 20.5), result);
        let found = scored(measured(Some(Covariance { sxx: 0.09, sxy: 0.05, syy: 0.16 })));
        assert_eq!((&*found.view, &*found.target, found.method, found.bound), ("v", "t", 3, None));
        assert_eq!(found.outcome, Outcome::Measured { position: PixelPoint::new(10.25, 19.0), error: Some((0.25, -1.5)) });
        assert!((found.predicted.unwrap() - 0.5).abs() < 1e-15, "sqrt(0.09 + 0.16)");
        assert_eq!(scored(measured(None)).predicted, None);
        let rejected = scored(Err(Rejection::Border));
        assert_eq!((rejected.outcome, rejected.predicted), (Outcome::Rejected(Rejection::Border), None));
    }

    #[test]
    fn a_point_is_lost_beyond_one_pixel_in_the_plane() {
        for (dx, dy, lost) in [
            (0.6, 0.8, false),
            (-1.0, 0.0, false),
            (0.0, -1.001, true),
            (0.75, -0.75, true),
            (0.25, -0.5, false),
            (0.699, -0.699, false),
            (0.3, 0.95, false),
            (0.3, -0.96, true),
        ] {
            let outcome = off(dx, dy);
            assert_eq!((outcome.is_lost(), outcome.kept_error()), (lost, (!lost).then_some((dx, dy))));
            assert_eq!(outcome.position(), Some(PixelPoint::new(10.0 + dx, 20.0 + dy)));
        }
        let unknown = Outcome::Measured { position: PixelPoint::new(1.0, 2.0), error: None };
        assert_eq!((unknown.is_lost(), unknown.kept_error(), unknown.position()), (false, None, Some(PixelPoint::new(1.0, 2.0))));
        let rejected = Outcome::Rejected(Rejection::Border);
        assert_eq!((rejected.is_lost(), rejected.kept_error(), rejected.position()), (false, None, None));
    }
}
