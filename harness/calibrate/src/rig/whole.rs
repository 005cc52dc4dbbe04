//! From a prepared rig to a calibrated one, with what is in doubt.

use calibench_adjust::{AdjustError, Found, Options, RigSolution, Use, Variance, adjust_rig, scale_of, snoop_rig};
use statrs::distribution::{Binomial, DiscreteCDF};

use super::calibration::RigCalibration;
use super::doubts::doubts;
use super::held::Held;
use super::leave_out::BySets;
use super::one_rig::OneRig;
use super::prepared::RigPrepared;
use crate::ended::ITERATIONS;
use crate::{CalibrationError, GrossErrors, Risk};

/// Residuals (as vectors) beyond so many of their standard deviations are counted.
const BEYOND: f64 = 4.0;
/// Probability of as many by chance, below which gross errors are sought.
const ALPHA: f64 = 1e-4;
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
    let given = &solution.rig().network.observations;
    let white: Vec<[f64; 2]> = solution
        .residuals()
        .iter()
        .filter(|r| r.used != Use::LeftOut)
        .filter_map(|r| Some(given[r.observation].precision.whitened(r.v?)))
        .collect();
    let Some(scale) = scale_of(white.iter().copied()).filter(|scale| *scale > 1e-5) else { return false };
    let of = white.len() as u64;
    let beyond = white.iter().filter(|[x, y]| x.hypot(*y) > BEYOND * scale).count() as u64;
    let Ok(chance) = Binomial::new((-0.5 * BEYOND * BEYOND).exp(), of) else { return false };
    let longest = white.iter().map(|[x, y]| x.hypot(*y)).fold(0.0, f64::max);
    let p = if beyond == 0 { 1.0 } else { chance.sf(beyond - 1) };
    p < ALPHA || of as f64 * (-0.5 * (longest / scale).powi(2)).exp() < ALPHA
}
