//! `accept_lengths`, `accept_points`: whether measuring keeps what is specified.

use calibench_accept::points::{Classes, Survey};
use calibench_accept::{LengthTest, Limit, PointTest, Rule};
use calibench_model::{ControlRow, TestLength};
use calibench_report::json::AcceptanceAnswer;
use pyo3::prelude::*;

use crate::answered::as_dict;
use crate::arrays::rows;
use crate::error::input;

/// Lengths against the limit A + K L, at most B: as `calibench accept --lengths` does.
#[pyfunction]
#[pyo3(signature = (lengths, limit, lines, *, probability = 0.95, guard_band = None, diagonal = None, unit = None))]
#[expect(clippy::too_many_arguments, reason = "those of Python's function")]
pub fn accept_lengths<'py>(
    py: Python<'py>,
    lengths: &Bound<'py, PyAny>,
    limit: Vec<f64>,
    lines: Vec<String>,
    probability: f64,
    guard_band: Option<f64>,
    diagonal: Option<f64>,
    unit: Option<String>,
) -> PyResult<Bound<'py, PyAny>> {
    let numbers = rows::<3>(lengths, "lengths")?;
    if lines.len() != numbers.len() {
        return Err(input(format!("lines: found {} names; expected one for each of {} lengths", lines.len(), numbers.len())));
    }
    let limit: Limit = limit.iter().map(f64::to_string).collect::<Vec<_>>().join(",").parse().map_err(|e| input(format!("limit: {e}")))?;
    let rule = match guard_band {
        Some(factor) if factor.is_finite() && factor >= 0.0 => Rule::GuardBand(factor),
        Some(factor) => return Err(input(format!("guard_band: found {factor}; expected a number of at least 0"))),
        None if (0.5..1.0).contains(&probability) => Rule::Probability(probability),
        None => return Err(input(format!("probability: found {probability}; expected 0.5 to below 1"))),
    };
    let mut all = Vec::with_capacity(numbers.len());
    for (place, ([calibrated, sigma, measured], line)) in numbers.into_iter().zip(lines).enumerate() {
        let is_right = calibrated.is_finite() && calibrated > 0.0 && sigma.is_finite() && sigma >= 0.0;
        if !is_right || measured.is_infinite() || measured <= 0.0 {
            let expected = "expected a calibrated length above 0, its standard uncertainty of at least 0, and a measured length or NaN";
            return Err(input(format!("lengths: row {place}: {expected}")));
        }
        let targets = ["from", "to"].map(|end| format!("{place} {end}"));
        all.push(TestLength { line, targets, calibrated, sigma, measured: Some(measured).filter(|length| !length.is_nan()) });
    }
    let test = LengthTest { lengths: &all, limit, rule, diagonal, scale: None };
    as_dict(py, &AcceptanceAnswer::of_lengths(&test, &test.run(), unit.as_deref()))
}

/// Check points against classes of accuracy: as `calibench accept --check-points` does.
#[pyfunction]
#[pyo3(signature = (surveyed, measured, *, horizontal = None, vertical = None, spatial = None, survey = None, unit = None))]
#[expect(clippy::too_many_arguments, reason = "those of Python's function")]
pub fn accept_points<'py>(
    py: Python<'py>,
    surveyed: &Bound<'py, PyAny>,
    measured: &Bound<'py, PyAny>,
    horizontal: Option<f64>,
    vertical: Option<f64>,
    spatial: Option<f64>,
    survey: Option<[f64; 2]>,
    unit: Option<String>,
) -> PyResult<Bound<'py, PyAny>> {
    let (surveyed, measured) = (rows::<3>(surveyed, "surveyed")?, rows::<3>(measured, "measured")?);
    if surveyed.len() != measured.len() {
        return Err(input(format!("measured: found {} points; expected one for each of {} surveyed", measured.len(), surveyed.len())));
    }
    if surveyed.iter().flatten().any(|number| !number.is_finite()) {
        return Err(input("surveyed: expected finite coordinates"));
    }
    for (name, value) in [("horizontal", horizontal), ("vertical", vertical), ("spatial", spatial)] {
        if let Some(value) = value.filter(|value| !(value.is_finite() && *value > 0.0)) {
            return Err(input(format!("{name}: found {value}; expected a positive number")));
        }
    }
    if survey.is_some_and(|survey| survey.iter().any(|value| !(value.is_finite() && *value >= 0.0))) {
        return Err(input("survey: expected two numbers of at least 0: horizontal, vertical"));
    }
    let named = |points: Vec<[f64; 3]>| points.into_iter().enumerate().map(|(place, at)| ControlRow::new(place.to_string(), at));
    let surveyed: Vec<ControlRow> = named(surveyed).collect();
    let measured: Vec<ControlRow> = named(measured).filter(|point| point.position.iter().all(|number| number.is_finite())).collect();
    let classes = Classes { horizontal, vertical, spatial };
    let survey = survey.map(|[horizontal, vertical]| Survey { horizontal, vertical });
    let found = PointTest { surveyed: &surveyed, measured: &measured, classes, survey }.run().map_err(input)?;
    as_dict(py, &AcceptanceAnswer::of_points(&found, unit.as_deref()))
}
