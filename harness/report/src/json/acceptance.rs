//! A test of acceptance as JSON.

use calibench_accept::basis::{Basis, OF_LENGTHS, OF_POINTS};
use calibench_accept::lengths::LengthResult;
use calibench_accept::points::{AXES, Accuracy, PointResult};
use calibench_accept::{Decision, LengthAcceptance, LengthTest, PointAcceptance, Rule};
use calibench_model::TestLength;
use schemars::JsonSchema;
use serde::Serialize;

use super::Answer;

/// Whether a measuring system keeps what is specified.
#[derive(Serialize, JsonSchema)]
pub struct AcceptanceAnswer {
    /// `pass`, `fail` or `cannot tell`.
    decision: &'static str,
    /// The unit of lengths and coordinates, as it was named; null where it was not.
    unit: Option<String>,
    /// The test by lengths; null of one by check points.
    lengths: Option<Lengths>,
    /// The test by check points; null of one by lengths.
    check_points: Option<CheckPoints>,
    /// Why it cannot be passed, whatever the errors.
    unmet: Vec<Said>,
    /// What is taken for granted, left out, or to be known besides.
    notes: Vec<Said>,
    /// The rules that were followed.
    basis: Vec<Source>,
}

#[derive(Serialize, JsonSchema)]
struct Said {
    /// A word for what it is about: of lengths `lines`, `longest`, `not-measured`, `exact`, `scale-untold`, `gave-scale` or `volume-untold`; of check points `too-few`,
    /// `survey-untold`, `not-measured`, `bias` or `close`.
    subject: &'static str,
    /// In words.
    words: String,
}

#[derive(Serialize, JsonSchema)]
struct Source {
    /// The standard.
    standard: &'static str,
    /// What it says.
    rule: &'static str,
    /// Who else says so.
    by: &'static str,
    /// Whether it was checked against the text of the standard itself.
    checked: bool,
}

#[derive(Serialize, JsonSchema)]
#[expect(clippy::struct_field_names, reason = "they are the keys of the document")]
struct Lengths {
    /// The limit of an error: A + K L, at most B.
    limit: LimitPart,
    /// Least probability at which an error is taken as within its limit, or beyond it, 0.5 to 1; null with a guard band.
    probability: Option<f64>,
    /// Standard uncertainties by which it must be; null with a probability.
    guard_band: Option<f64>,
    /// Diagonal of the measuring volume, in the unit; null where it was not told.
    diagonal: Option<f64>,
    /// Tested lengths.
    tested: usize,
    /// Root mean square of their errors, in the unit; null where none was tested.
    rms: Option<f64>,
    /// The error that is the largest by size, in the unit; null likewise.
    largest: Option<f64>,
    /// The best change of scale, a number: measured lengths are too long by so much; null likewise.
    scale: Option<f64>,
    /// Its standard deviation, from the scatter of the errors.
    scale_sigma: Option<f64>,
    /// Probability that all tested errors are within their limits, if the reference's errors are independent; null likewise.
    all_within: Option<f64>,
    /// Each length, in the order of the file.
    lengths: Vec<Length>,
}

#[derive(Serialize, JsonSchema)]
struct LimitPart {
    /// A, in the unit.
    a: f64,
    /// K, a number.
    k: f64,
    /// B, in the unit; null where there is none.
    b: Option<f64>,
}

#[derive(Serialize, JsonSchema)]
struct Length {
    /// The measurement line.
    line: String,
    /// The target at one end.
    from: String,
    /// The target at the other.
    to: String,
    /// Calibrated length, in the unit.
    calibrated: f64,
    /// Its standard uncertainty, in the unit; 0 where it is taken as exact.
    sigma: f64,
    /// Measured length, in the unit; null where there is none.
    measured: Option<f64>,
    /// Measured less calibrated, in the unit; null likewise.
    error: Option<f64>,
    /// The limit of its size, in the unit.
    limit: f64,
    /// Probability that the error is within the limit; null where it was not tested.
    probability: Option<f64>,
    /// `pass`, `fail`, `cannot tell`, `gave the scale` or `not measured`.
    outcome: &'static str,
}

#[derive(Serialize, JsonSchema)]
struct CheckPoints {
    /// Measured check points.
    measured: usize,
    /// Names of those that were not measured.
    missing: Vec<String>,
    /// Horizontal, vertical and 3D.
    accuracies: Vec<AccuracyPart>,
    /// Of X, Y and Z.
    axes: Vec<Axis>,
    /// Each measured check point, in the order of the survey.
    points: Vec<Point>,
}

#[derive(Serialize, JsonSchema)]
struct AccuracyPart {
    /// `horizontal`, `vertical` or `3D`.
    what: &'static str,
    /// Root mean square error at the check points, in the unit.
    of_points: f64,
    /// That of the survey, in the unit.
    of_survey: f64,
    /// Both, added in squares.
    total: f64,
    /// Its 95 % interval from here, for normal errors without a mean.
    from: f64,
    /// To here.
    to: f64,
    /// The class, in the unit; null where none was asked for.
    class: Option<f64>,
    /// `pass`, `fail` or `cannot tell`; null likewise.
    decision: Option<&'static str>,
}

#[derive(Serialize, JsonSchema)]
#[expect(clippy::struct_field_names, reason = "they are the keys of the document")]
struct Axis {
    /// X, Y or Z.
    axis: &'static str,
    /// Mean error, measured less surveyed, in the unit.
    mean: f64,
    /// Standard deviation about it; null of a single point.
    deviation: Option<f64>,
    /// Root mean square error.
    rmse: f64,
}

#[derive(Serialize, JsonSchema)]
struct Point {
    /// The target.
    target: String,
    /// Measured less surveyed X, Y, Z, in the unit.
    error: [f64; 3],
}

impl Answer for AcceptanceAnswer {
    const COMMAND: &'static str = "accept";
    const SCHEMA: u32 = 1;
}

impl AcceptanceAnswer {
    /// Of a test by lengths.
    pub fn of_lengths(test: &LengthTest<'_>, found: &LengthAcceptance, unit: Option<&str>) -> Self {
        let said = |subject, words: String| Said { subject, words };
        Self {
            decision: found.decision.words(),
            unit: unit.map(str::to_owned),
            lengths: Some(lengths(test, found)),
            check_points: None,
            unmet: found.unmet.iter().map(|one| said(one.subject(), one.to_string())).collect(),
            notes: found.assumed.iter().map(|one| said(one.subject(), one.to_string())).collect(),
            basis: sources(&OF_LENGTHS),
        }
    }

    /// Of a test by check points.
    pub fn of_points(found: &PointAcceptance, unit: Option<&str>) -> Self {
        let accuracy = |one: &Accuracy| AccuracyPart {
            what: one.what,
            of_points: one.of_points,
            of_survey: one.of_survey,
            total: one.total,
            from: one.interval[0],
            to: one.interval[1],
            class: one.class,
            decision: one.decision.map(Decision::words),
        };
        let axes = found.axes.iter().zip(AXES);
        let point = |point: &PointResult| Point { target: point.target.clone(), error: point.error };
        let check_points = CheckPoints {
            measured: found.results.len(),
            missing: found.missing.clone(),
            accuracies: found.accuracies.iter().map(accuracy).collect(),
            axes: axes.map(|(one, axis)| Axis { axis, mean: one.mean, deviation: one.deviation, rmse: one.rmse }).collect(),
            points: found.results.iter().map(point).collect(),
        };
        Self {
            decision: found.decision.words(),
            unit: unit.map(str::to_owned),
            lengths: None,
            check_points: Some(check_points),
            unmet: found.too_few.iter().map(|one| Said { subject: "too-few", words: one.to_string() }).collect(),
            notes: found.remarks.iter().map(|one| Said { subject: one.subject(), words: one.to_string() }).collect(),
            basis: sources(&OF_POINTS),
        }
    }
}

fn sources(basis: &[Basis]) -> Vec<Source> {
    basis.iter().map(|&Basis { standard, rule, by }| Source { standard, rule, by, checked: false }).collect()
}

fn lengths(test: &LengthTest<'_>, found: &LengthAcceptance) -> Lengths {
    let (probability, guard_band) = match test.rule {
        Rule::Probability(least) => (Some(least), None),
        Rule::GuardBand(factor) => (None, Some(factor)),
    };
    let length = |(length, result): (&TestLength, &LengthResult)| Length {
        line: length.line.clone(),
        from: length.targets[0].clone(),
        to: length.targets[1].clone(),
        calibrated: length.calibrated,
        sigma: length.sigma,
        measured: length.measured,
        error: result.error,
        limit: result.limit,
        probability: result.probability,
        outcome: result.outcome.words(),
    };
    let together = found.together.as_ref();
    let limit = test.limit;
    Lengths {
        limit: LimitPart { a: limit.constant, k: limit.rate, b: Some(limit.most).filter(|most| most.is_finite()) },
        probability,
        guard_band,
        diagonal: test.diagonal,
        tested: together.map_or(0, |together| together.count),
        rms: together.map(|together| together.rms),
        largest: together.map(|together| together.largest.0),
        scale: together.and_then(|together| together.scale).map(|scale| scale.0),
        scale_sigma: together.and_then(|together| together.scale).map(|scale| scale.1),
        all_within: together.map(|together| together.probability),
        lengths: test.lengths.iter().zip(&found.results).map(length).collect(),
    }
}
