//! Photographs that judge a calibration: what can be known of operators and camera models without truth.
//!
//! Every operator with every model is calibrated from all views, from all but those left out, and from halves of them. What comes of it are [`Row`]s:
//! measure, place, value and what is predicted for it. [`Summary`](calibench_records::judgement::Summary) makes figures and a verdict of them, and nothing else does.

mod bend;
mod board;
mod calibrated;
mod camera_difference;
mod corner_files;
mod field;
mod frame;
mod halves;
mod holdout;
mod lines;
mod material;
mod operator_and_model;
mod options;
mod point_files;
mod published;
mod remaining;

/// The example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

#[cfg(test)]
mod tests;

use std::sync::Arc;

use calibench_calibrate::choice::{HALF, ModelChoice};
use calibench_records::judgement::{Row, measure};
use rayon::prelude::*;
use thiserror::Error;

pub use board::with_board;
pub use corner_files::{CornerFile, CornerFilesError};
pub use field::{Field, field_of};
pub use halves::halves;
pub use material::{Corners, FEWEST, Material};
pub use options::{BENT, METHODS, MODELS, OF_CAMERA, Options, usual_methods, usual_models};
pub use point_files::Expected;
pub use published::stated_sigma;
pub use remaining::{Remaining, remaining};

/// Why nothing can be judged.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum JudgementError {
    /// Halves would be too small.
    #[error(
        "judging takes at least {needed} photographs that show the board (each half of them is calibrated by itself, from {HALF} or more), found {found}"
    )]
    TooFewViews {
        /// Where the board was found.
        found: usize,
        /// How many are needed.
        needed: usize,
    },
    /// No operator can run.
    #[error("no operator is available: {0}")]
    NoOperator(String),
}

/// Judges every operator with every model; rows by operator, model and measure, the same on any number of threads.
///
/// # Errors
/// [`JudgementError`].
pub fn judge(material: &Material, options: &Options) -> Result<Vec<Row>, JudgementError> {
    let (found, needed) = (material.views.len(), 2 * HALF);
    if found < needed {
        return Err(JudgementError::TooFewViews { found, needed });
    }
    if material.operators.iter().all(|operator| operator.unavailable.is_some()) {
        let first = material.operators.first().and_then(|operator| operator.unavailable.clone());
        return Err(JudgementError::NoOperator(first.unwrap_or_else(|| "none was asked for".into())));
    }
    let (common, tried) = (material.common(), material.tried());
    let mut rows: Vec<Row> = (0..material.operators.len()).flat_map(|operator| corners(material, operator, &common, &tried)).collect();
    let available = (0..material.operators.len()).filter(|&operator| material.operators[operator].unavailable.is_none());
    let jobs: Vec<(usize, &ModelChoice)> =
        available.flat_map(|operator| options.models.iter().map(move |model| (operator, model))).collect();
    let cells: Vec<operator_and_model::Judged> =
        jobs.par_iter().map(|&(operator, model)| operator_and_model::rows_of(material, &common, operator, model, options)).collect();
    let labels: Vec<Arc<str>> = jobs.iter().map(|(_, model)| model.label.as_str().into()).collect();
    for (place, cell) in cells.iter().enumerate() {
        let (operator, model) = (jobs[place].0, &labels[place]);
        let others = (place + 1..jobs.len()).filter(|&other| jobs[other].0 == operator);
        let others = others.filter_map(|other| Some((&labels[other], cells[other].camera.as_ref()?)));
        rows.extend(cell.rows.iter().cloned());
        let beside = cell.camera.iter().flat_map(|camera| camera_difference::rows(camera, others.clone(), &material.positions(operator)));
        rows.extend(beside.map(|row| row.by(&material.operators[operator].method, model)));
    }
    Ok(rows)
}

/// What an operator measured, view by view, and each corner that it rejected.
fn corners(material: &Material, operator: usize, common: &[Vec<bool>], tried: &[usize]) -> Vec<Row> {
    let corners = &material.operators[operator];
    if let Some(why) = &corners.unavailable {
        return vec![Row { method: corners.method.clone(), ..Row::without(measure::CORNERS, "", "unavailable", why) }];
    }
    let view = |(view, name): (usize, &Arc<str>)| {
        let count = corners.at[view].iter().flatten().count();
        let shared = common[view].iter().filter(|common| **common).count();
        Row { unit: "corners".into(), ..Row::plain(measure::CORNERS, name, count as f64) }.beside(shared as f64).of(tried[view])
    };
    let missed = material.missed.iter().map(|(name, why)| Row::without(measure::CORNERS, name, "missed", why));
    let rejected = corners.rejected.iter().map(|(view, corner, why)| {
        Row::without(measure::REJECTED, &format!("{} of {}", material.field.name(*corner), material.views[*view]), "rejected", why)
    });
    let rows = material.views.iter().enumerate().map(view).chain(missed).chain(rejected);
    rows.map(|row| Row { method: corners.method.clone(), ..row }).collect()
}
