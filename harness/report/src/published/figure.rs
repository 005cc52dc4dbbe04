//! Our figure behind a printed cell.

use calibench_records::results::{Outcome, PointResult};
use calibench_records::statistics::running::Running;

use super::Metric;

/// A figure in the first run and over all of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ours {
    /// In the first trial.
    pub one: f64,
    /// Mean over the trials.
    pub mean: f64,
    /// Half the 95 % interval of the mean.
    pub half: Option<f64>,
    /// Standard deviation of a single run.
    pub scatter: Option<f64>,
    /// The same figure of true errors, with half its 95 % interval, where it makes sense.
    pub truth: Option<(f64, Option<f64>)>,
}

impl Ours {
    /// Of one run and of all.
    pub fn of(one: Option<f64>, all: &Running) -> Option<Self> {
        Some(Self { one: one?, mean: all.mean()?, half: all.half(), scatter: all.deviation(), truth: None })
    }

    /// In a unit that is `factor` times as small.
    pub fn scaled(self, factor: f64) -> Self {
        let by = |value: Option<f64>| value.map(|value| value * factor);
        Self {
            one: self.one * factor,
            mean: self.mean * factor,
            half: by(self.half),
            scatter: by(self.scatter),
            truth: self.truth.map(|(v, h)| (v * factor, by(h))),
        }
    }
}

/// The points of one method, by its place in the list of methods.
pub fn of_method(points: &[PointResult], method: usize) -> impl Iterator<Item = &PointResult> {
    points.iter().filter(move |point| point.method == method)
}

/// The errors (dx, dy) of one method's points, px, without the targets `except` and rejected points.
pub fn errors<'a>(points: &'a [PointResult], method: usize, except: &'a [String]) -> impl Iterator<Item = (f64, f64)> + 'a {
    of_method(points, method).filter(|p| !except.iter().any(|id| **id == *p.target)).filter_map(|p| match p.outcome {
        Outcome::Measured { error, .. } => error,
        Outcome::Rejected(_) => None,
    })
}

/// The figure `metric` of one method's points in one trial, px; `None` where no point of it was measured, or for figures of adjustments.
pub fn of_points(points: &[PointResult], method: usize, metric: Metric, target: Option<&str>, except: &[String]) -> Option<f64> {
    let outcome = || of_method(points, method).find(|point| Some(&*point.target) == target).map(|point| point.outcome);
    let position = || outcome()?.position();
    let error = || match outcome()? {
        Outcome::Measured { error, .. } => error,
        Outcome::Rejected(_) => None,
    };
    let mean = |value: fn((f64, f64)) -> f64| {
        let values: Vec<f64> = errors(points, method, except).map(value).collect();
        (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
    };
    match metric {
        Metric::Dx => error().map(|e| e.0),
        Metric::Dy => error().map(|e| e.1),
        Metric::Distance => error().map(|e| e.0.hypot(e.1)),
        Metric::X => position().map(|p| p.x),
        Metric::Y => position().map(|p| p.y),
        Metric::MeanDx => mean(|e| e.0),
        Metric::MeanDy => mean(|e| e.1),
        Metric::RmseX => mean(|e| e.0 * e.0).map(f64::sqrt),
        Metric::RmseY => mean(|e| e.1 * e.1).map(f64::sqrt),
        Metric::MeanDistance => mean(|e| e.0.hypot(e.1)),
        Metric::RmseXy => mean(|e| e.0 * e.0 + e.1 * e.1).map(f64::sqrt),
        _ => None,
    }
}
