//! From prepared splines to a calibrated camera.

use calibench_adjust::{Options, Variance, adjust_splined};

use super::calibration::{GRID, SplinedCalibration};
use super::doubts::doubts;
use super::gross::Search;
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
    let search = match prepared.asked.settings.gross {
        GrossErrors::Kept => Search::keeping(all),
        _ => Search::leaving_out(all),
    };
    let Search { solution, left_out, kept } = search?;
    // Without redundancy the a-priori variance is all there is.
    let quality = solution.quality(Variance::Estimated).or_else(|_| solution.quality(Variance::Apriori))?;
    let over_frame = quality.over_frame(GRID);
    let mut calibration = SplinedCalibration { prepared, solution, found: left_out, kept, quality, over_frame, doubts: Vec::new() };
    calibration.doubts = doubts(&calibration);
    Ok(calibration)
}
