//! Tests by check points.

mod remarks;

use std::collections::HashMap;

use calibench_model::ControlRow;
use statrs::distribution::{ChiSquared, ContinuousCDF};
use thiserror::Error;

pub use remarks::{OF_CLASS, POINTS, Remark, TooFew};

use crate::Decision;

/// The names of coordinates.
pub const AXES: [&str; 3] = ["X", "Y", "Z"];

/// Root mean squares that accuracies are held against, in the unit of the points; those that are asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Classes {
    /// Of X and Y together.
    pub horizontal: Option<f64>,
    /// Of Z.
    pub vertical: Option<f64>,
    /// Of all three together.
    pub spatial: Option<f64>,
}

/// Root mean square errors of the survey of the check points, in their unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Survey {
    /// Of X and Y together.
    pub horizontal: f64,
    /// Of Z.
    pub vertical: f64,
}

/// What is tested, and by what.
#[derive(Clone, Copy, Debug)]
pub struct PointTest<'a> {
    /// The check points as they were surveyed; their standard deviations are the survey's errors, unless `survey` tells these.
    pub surveyed: &'a [ControlRow],
    /// What was measured, by name; other points are passed over.
    pub measured: &'a [ControlRow],
    /// The classes.
    pub classes: Classes,
    /// The survey's errors of all points together.
    pub survey: Option<Survey>,
}

/// No check point was measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("no check point has the name of a measured point; expected targets that both files name")]
pub struct NoPoints;

/// A measured check point.
#[derive(Clone, Debug, PartialEq)]
pub struct PointResult {
    /// The target.
    pub target: String,
    /// Measured less surveyed X, Y, Z, in their unit.
    pub error: [f64; 3],
}

/// The errors of a coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisErrors {
    /// Their mean, in the unit of the points.
    pub mean: f64,
    /// Their standard deviation about it; `None` of a single point.
    pub deviation: Option<f64>,
    /// Their root mean square.
    pub rmse: f64,
}

/// An accuracy: a root mean square, in the unit of the points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accuracy {
    /// What it is of: `horizontal`, `vertical` or `3D`.
    pub what: &'static str,
    /// Of the errors at the check points.
    pub of_points: f64,
    /// Of the survey.
    pub of_survey: f64,
    /// Both, added in squares.
    pub total: f64,
    /// Where it lies at 95 %, for normal errors without a mean.
    pub interval: [f64; 2],
    /// The class, if one is asked for.
    pub class: Option<f64>,
    /// Whether it is met, likewise.
    pub decision: Option<Decision>,
}

/// The outcome of a test.
#[derive(Clone, Debug, PartialEq)]
pub struct PointAcceptance {
    /// The measured check points, in the order of the survey.
    pub results: Vec<PointResult>,
    /// Those that were not measured.
    pub missing: Vec<String>,
    /// Of X, Y and Z.
    pub axes: [AxisErrors; 3],
    /// Horizontal, vertical and 3D.
    pub accuracies: [Accuracy; 3],
    /// Why it cannot be decided, if so.
    pub too_few: Option<TooFew>,
    /// What is to be known besides.
    pub remarks: Vec<Remark>,
    /// Of all classes that are asked for.
    pub decision: Decision,
}

impl PointTest<'_> {
    /// The accuracies at the check points, with the survey's own error, against their classes; of fewer than [`POINTS`] nothing is decided.
    ///
    /// # Errors
    /// [`NoPoints`] where no check point was measured.
    ///
    /// Source: ASPRS 2023, as [`crate::basis`] knows it. The interval is ours: a sum of squares is chi-squared, with the degrees of freedom of Welch 1947 where axes differ.
    pub fn run(&self) -> Result<PointAcceptance, NoPoints> {
        let places: HashMap<&str, &[f64; 3]> = self.measured.iter().map(|point| (point.target.as_str(), &point.position)).collect();
        let is_there = |point: &&ControlRow| places.contains_key(point.target.as_str());
        let (there, gone): (Vec<&ControlRow>, Vec<&ControlRow>) = self.surveyed.iter().partition(is_there);
        let error = |point: &ControlRow| {
            let measured = places[point.target.as_str()];
            [0, 1, 2].map(|axis| measured[axis] - point.position[axis])
        };
        let results: Vec<PointResult> =
            there.iter().map(|point| PointResult { target: point.target.clone(), error: error(point) }).collect();
        if results.is_empty() {
            return Err(NoPoints);
        }
        let axes = [0, 1, 2].map(|axis| AxisErrors::of(&results, axis));
        let survey = self.survey_of(&there);
        let too_few = (results.len() < POINTS).then_some(TooFew(results.len()));
        let squares = axes.map(|axis| axis.rmse * axis.rmse);
        let of = |what, axes: &[f64], of_survey: f64, class: Option<f64>| {
            let total = |of_points: f64| of_points.hypot(of_survey);
            let of_points = axes.iter().sum::<f64>().sqrt();
            let met = |class| if total(of_points) <= class { Decision::Pass } else { Decision::Fail };
            let decision = class.map(|class| if too_few.is_some() { Decision::CannotTell } else { met(class) });
            let interval = interval(axes, results.len()).map(total);
            Accuracy { what, of_points, of_survey, total: total(of_points), interval, class, decision }
        };
        let Classes { horizontal, vertical, spatial } = self.classes;
        let accuracies = [
            of("horizontal", &squares[..2], survey.horizontal, horizontal),
            of("vertical", &squares[2..], survey.vertical, vertical),
            of("3D", &squares, survey.horizontal.hypot(survey.vertical), spatial),
        ];
        let remarks = self.remarks(&there, gone.len(), &axes, &accuracies);
        let decision = Decision::of_all(accuracies.iter().filter_map(|accuracy| accuracy.decision));
        let missing = gone.into_iter().map(|point| point.target.clone()).collect();
        Ok(PointAcceptance { results, missing, axes, accuracies, too_few, remarks, decision })
    }

    /// The survey's errors at these points; of those without standard deviations none.
    fn survey_of(&self, points: &[&ControlRow]) -> Survey {
        let root = |squares: f64| (squares / points.len() as f64).sqrt();
        let sums = points
            .iter()
            .filter_map(|point| point.sigmas)
            .fold([0.0; 2], |[horizontal, vertical], [x, y, z]| [horizontal + x * x + y * y, vertical + z * z]);
        self.survey.unwrap_or(Survey { horizontal: root(sums[0]), vertical: root(sums[1]) })
    }

    fn remarks(&self, points: &[&ControlRow], missing: usize, axes: &[AxisErrors; 3], accuracies: &[Accuracy; 3]) -> Vec<Remark> {
        let exact = points.iter().filter(|point| self.survey.is_none() && point.sigmas.is_none()).count();
        let Classes { horizontal, vertical, .. } = self.classes;
        let bias = |(axis, class): (usize, Option<f64>)| {
            let (mean, class) = (axes[axis].mean, class?);
            (mean.abs() > OF_CLASS * class).then_some(Remark::Bias { axis: AXES[axis], mean, class })
        };
        let biases = [horizontal, horizontal, vertical].into_iter().enumerate().filter_map(bias);
        let is_close =
            |accuracy: &&Accuracy| accuracy.class.is_some_and(|class| (accuracy.interval[0]..=accuracy.interval[1]).contains(&class));
        let close = accuracies.iter().filter(is_close).map(|accuracy| Remark::Close(accuracy.what));
        let first = [(exact > 0).then_some(Remark::SurveyUntold(exact)), (missing > 0).then_some(Remark::NotMeasured(missing))];
        first.into_iter().flatten().chain(biases).chain(close).collect()
    }
}

impl AxisErrors {
    fn of(results: &[PointResult], axis: usize) -> Self {
        let errors = || results.iter().map(|result| result.error[axis]);
        let count = results.len() as f64;
        let mean = errors().sum::<f64>() / count;
        let about = errors().map(|error| (error - mean).powi(2)).sum::<f64>();
        Self {
            mean,
            deviation: (results.len() > 1).then(|| (about / (count - 1.0)).sqrt()),
            rmse: (errors().map(|error| error * error).sum::<f64>() / count).sqrt(),
        }
    }
}

/// Where the root of the sum of these mean squares of `count` points lies at 95 %.
fn interval(squares: &[f64], count: usize) -> [f64; 2] {
    let (sum, fourth) = (squares.iter().sum::<f64>(), squares.iter().map(|square| square * square).sum::<f64>());
    let freedom = count as f64 * sum * sum / fourth;
    match ChiSquared::new(freedom) {
        Ok(chi) => [0.975, 0.025].map(|share| (sum * freedom / chi.inverse_cdf(share)).sqrt()),
        // Without any error.
        Err(_) => [0.0; 2],
    }
}

#[cfg(test)]
mod tests;
