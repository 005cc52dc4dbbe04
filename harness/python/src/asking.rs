//! How a calibration is asked for.

use calibench_calibrate::{GrossErrors, Risk};
use calibench_judge::BENT;
use pyo3::PyResult;

use crate::error::input;

/// A model as `judge` names it: the lens, and whether the board is bent.
pub fn lens_and_board(model: Option<String>) -> (Option<String>, bool) {
    match model.as_deref().and_then(|model| model.strip_suffix(BENT)) {
        Some(lens) => (Some(lens.to_owned()), true),
        None => (model, false),
    }
}

/// What is done about gross errors.
///
/// # Errors
/// Weights for what is left out.
pub fn gross(huber: Option<f64>, snoop: Option<bool>) -> PyResult<GrossErrors> {
    match (huber, snoop) {
        (Some(_), Some(true)) => Err(input("huber and snoop: one or the other")),
        (Some(bound), _) => Ok(GrossErrors::Weighted(bound)),
        (None, Some(true)) => Ok(GrossErrors::Rejected(Risk::EachPoint)),
        (None, Some(false)) => Ok(GrossErrors::Kept),
        (None, None) => Ok(GrossErrors::Sought),
    }
}
