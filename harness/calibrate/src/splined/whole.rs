//! From prepared splines to a calibrated camera.

use calibench_adjust::{Found, Options, SplinedSolution, Use, Variance, adjust_splined};

use super::calibration::{GRID, SplinedCalibration};
use super::doubts::doubts;
use super::prepared::SplinedPrepared;
use crate::{CalibrationError, GrossErrors};

/// Iterations at most.
const ITERATIONS: usize = 200;
/// How many good image points are left out by chance, over all.
const BY_CHANCE: f64 = 1e-3;
/// Rounds of leaving out at most.
const ROUNDS: usize = 8;
/// Share of the image points that is left out at most: more are no errors of single points.
const MOST_LEFT_OUT: f64 = 0.1;
/// Standard deviations below which residuals are rounding.
const ROUNDING: f64 = 1e-5;

/// Adjusts splines, leaves out image points in gross error where these are sought, and says how well the camera is known over its frame, and what is doubtful.
///
/// # Errors
/// An adjustment that does not converge, or an image whose pose is not determined, by name.
pub fn calibrate_splined(prepared: &SplinedPrepared) -> Result<SplinedCalibration<'_>, CalibrationError> {
    let options = Options { most_iterations: ITERATIONS, ..Options::default() };
    let all = adjust_splined(&prepared.splines, &options)?;
    let (solution, found) = match prepared.asked.settings.gross {
        GrossErrors::Kept => (all, Vec::new()),
        _ => without_gross_errors(all),
    };
    let variance = if solution.counts().redundancy() > 0 { Variance::Estimated } else { Variance::Apriori };
    let quality = solution.quality(variance)?;
    let over_frame = quality.over_frame(GRID);
    let mut calibration = SplinedCalibration { prepared, solution, found, quality, over_frame, doubts: Vec::new() };
    calibration.doubts = doubts(&calibration);
    Ok(calibration)
}

/// Leaves out what no normal error would be, adjusts again, until there is nothing more; all are kept where these are too many.
fn without_gross_errors(all: SplinedSolution<'_>) -> (SplinedSolution<'_>, Vec<Found>) {
    let points = all.network().network.observations.len();
    let critical = (2.0 * (points as f64 / BY_CHANCE).ln()).sqrt();
    let (mut solution, mut found): (SplinedSolution<'_>, Vec<Found>) = (all.clone(), Vec::new());
    for _ in 0..ROUNDS {
        let Some(scale) = solution.scale().filter(|scale| *scale > ROUNDING) else { break };
        let given = &solution.network().network.observations;
        let beyond = |r: &calibench_adjust::Residual| {
            let [x, y] = given[r.observation].precision.whitened(r.v?);
            let w = x.hypot(y) / scale;
            (r.used != Use::LeftOut && w > critical).then_some(Found { observation: r.observation, w, critical, left_out: true })
        };
        let more: Vec<Found> = solution.residuals().iter().filter_map(beyond).collect();
        if more.is_empty() {
            break;
        }
        found.extend(more);
        if found.len() as f64 > MOST_LEFT_OUT * points as f64 {
            return (all, Vec::new());
        }
        let left_out: Vec<usize> = found.iter().map(|found| found.observation).collect();
        match solution.without(&left_out) {
            Ok(better) => solution = better,
            Err(_) => return (all, Vec::new()),
        }
    }
    (solution, found)
}
