//! Distances and lengths as JSON.

use calibench_calibrate::{AdjustedLength, Calibration};
use schemars::JsonSchema;
use serde::Serialize;

/// The adjusted length between two targets.
#[derive(Serialize, JsonSchema)]
#[expect(clippy::struct_field_names, reason = "they are the keys of the document")]
pub(super) struct Length {
    /// The targets at its ends.
    targets: [String; 2],
    /// How long it is, object units.
    length: f64,
    /// Its standard deviation, object units.
    sigma: f64,
    /// What was measured, object units; null of a length that was only asked for.
    measured: Option<f64>,
    /// The standard deviation that was given for it, object units.
    sigma_measured: Option<f64>,
    /// Redundancy number, from 0 (nothing checks it: it makes the scale) to 1; null where no test can be made.
    redundancy: Option<f64>,
    /// Normalised residual, a number; null likewise.
    w: Option<f64>,
}

/// Those of a calibration.
///
/// # Errors
/// A standard deviation that cannot be had, in words.
pub(super) fn lengths(calibration: &Calibration<'_>) -> Result<Vec<Length>, String> {
    let of = |AdjustedLength { targets, value, sigma, measured }: AdjustedLength| Length {
        targets,
        length: value,
        sigma,
        measured: measured.map(|measured| measured.value),
        sigma_measured: measured.map(|measured| measured.sigma),
        redundancy: measured.and_then(|measured| measured.redundancy),
        w: measured.and_then(|measured| measured.w),
    };
    Ok(calibration.lengths().map_err(|error| error.to_string())?.into_iter().map(of).collect())
}
