//! From prepared splines to a calibrated camera.

use calibench_adjust::{Options, Variance, adjust_splined};

use super::calibration::{GRID, SplinedCalibration};
use super::doubts::doubts;
use super::gross::without_gross_errors;
use super::prepared::SplinedPrepared;
use crate::{CalibrationError, GrossErrors};

/// Iterations at most.
const ITERATIONS: usize = 200;
/// Adjusts splines, leaves out image points in gross error where these are sought, and says how well the camera is known over its frame, and what is doubtful.
///
/// # Errors
/// An adjustment that does not converge, or an image whose pose is not determined, by name.
pub fn calibrate_splined(prepared: &SplinedPrepared) -> Result<SplinedCalibration<'_>, CalibrationError> {
    let options = Options { most_iterations: ITERATIONS, ..Options::default() };
    let all = adjust_splined(&prepared.splines, &options)?;
    let (solution, found) = match prepared.asked.settings.gross {
        GrossErrors::Kept => (all, Vec::new()),
        _ => without_gross_errors(all)?,
    };
    // Without redundancy the a-priori variance is all there is.
    let quality = solution.quality(Variance::Estimated).or_else(|_| solution.quality(Variance::Apriori))?;
    let over_frame = quality.over_frame(GRID);
    let mut calibration = SplinedCalibration { prepared, solution, found, quality, over_frame, doubts: Vec::new() };
    calibration.doubts = doubts(&calibration);
    Ok(calibration)
}
