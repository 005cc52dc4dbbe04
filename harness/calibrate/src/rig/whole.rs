//! From a prepared rig to a calibrated one, with what is in doubt.

use calibench_adjust::{AdjustError, Found, Options, RigSolution, Test, Variance, adjust_rig, snoop_rig};

use super::calibration::RigCalibration;
use super::doubts::doubts;
use super::held::Held;
use super::leave_out::BySets;
use super::one_rig::OneRig;
use super::prepared::RigPrepared;
use crate::doubt::gross::{hold_gross, is_rounding, normalised};
use crate::ended::ITERATIONS;
use crate::{CalibrationError, GrossErrors, Risk};

/// Share of the image points that is left out of itself, at most: more are no errors of single points.
const MOST_LEFT_OUT: f64 = 0.1;

/// Adjusts a rig, leaves out image points in gross error where these are sought, and asks whether it is one rig, how far its mounts are known, and what is doubtful.
///
/// # Errors
/// An adjustment that does not converge or whose unknowns are not determined, by name.
pub fn calibrate_rig(prepared: &RigPrepared) -> Result<RigCalibration<'_>, CalibrationError> {
    let (solution, found) = adjusted(prepared).map_err(|error| match error {
        CalibrationError::Adjust(why @ AdjustError::NotConverged { .. }) => CalibrationError::Rig(format!(
            "no rig that images of one moment see at once: {why}; are the pairs of images of one moment (--sync, --times), and did no camera move?"
        )),
        other => other,
    })?;
    let left_out: Vec<usize> = found.iter().filter(|found| found.left_out).map(|found| found.observation).collect();
    let variance = if solution.counts().redundancy() > 0 { Variance::Estimated } else { Variance::Apriori };
    let covariances = solution.covariances(variance)?;
    let one_rig = OneRig::of(&solution, &left_out);
    let by_sets = BySets::of(&solution, &left_out);
    let held = Held::of(prepared, &solution, &left_out);
    let mut calibration =
        RigCalibration { prepared, solution, found, covariances, one_rig, by_sets, over_frame: Vec::new(), held, doubts: Vec::new() };
    calibration.over_frame = (0..prepared.rig.mounts.len()).map(|camera| calibration.over_frame(camera)).collect();
    calibration.doubts = doubts(&calibration);
    Ok(calibration)
}

fn adjusted(prepared: &RigPrepared) -> Result<(RigSolution<'_>, Vec<Found>), CalibrationError> {
    let (rig, settings) = (&prepared.rig, &prepared.asked.settings);
    let options = Options { most_iterations: ITERATIONS, ..Options::default() };
    let points = rig.network.observations.len();
    match settings.gross {
        GrossErrors::Rejected(risk) => Ok(snoop_rig(rig, &options, risk.snooping(points, settings.tested()))?),
        GrossErrors::Kept | GrossErrors::Weighted(_) => Ok((adjust_rig(rig, &options)?, Vec::new())),
        GrossErrors::Sought => {
            let all = adjust_rig(rig, &options);
            if all.as_ref().is_ok_and(|all| !has_gross_errors(all)) {
                return Ok((all?, Vec::new()));
            }
            match snoop_rig(rig, &options, Risk::WholeSet.snooping(points, settings.tested())) {
                Ok((rest, found)) if found.iter().filter(|found| found.left_out).count() as f64 <= MOST_LEFT_OUT * points as f64 => {
                    Ok((rest, found))
                }
                _ => Ok((all?, Vec::new())),
            }
        }
    }
}

/// Whether residuals are not those of normal errors: more are long than chance makes, or one is longer.
fn has_gross_errors(solution: &RigSolution<'_>) -> bool {
    !is_rounding(solution.scale()) && solution.reliability(Test::default()).is_ok_and(|reliability| hold_gross(&normalised(&reliability)))
}
