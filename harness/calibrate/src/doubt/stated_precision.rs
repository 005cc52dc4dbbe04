//! Whether residuals are as large as was stated.

use calibench_adjust::{Precision, Residual, scale_of};
use statrs::distribution::{ChiSquared, ContinuousCDF};

use super::ALPHA;
use crate::{Calibration, Finding, Verdict};

/// Times that residuals may exceed a standard deviation that a user stated.
const STATED: f64 = 1.5;
/// Times that they may exceed the covariances of an operator, which knows nothing but the noise of grey values.
const OPERATOR: f64 = 10.0;

/// Chi squared of the sum of squares, where a standard deviation was stated: by the user, or by the operator of its own points.
pub(super) fn check(calibration: &Calibration<'_>) -> Verdict {
    let settings = &calibration.prepared.settings;
    if settings.sigma_px.is_none() && !settings.covariances {
        return of_operator(calibration);
    }
    let redundancy = calibration.solution.counts().redundancy() as f64;
    let Ok(chi) = ChiSquared::new(redundancy) else {
        return Verdict::Untested("there is no redundancy".into());
    };
    // Gross errors that Huber's weights hold back say nothing of the others.
    let robust = settings.gross.huber().and_then(|_| calibration.solution.scale());
    let sigma0 = robust.or(calibration.solution.sigma0()).unwrap_or(1.0);
    let finding = Finding { p: chi.sf(redundancy * sigma0 * sigma0), moves: None, explains: 0.0 };
    if finding.p >= ALPHA || sigma0 < STATED {
        return Verdict::Sound(finding);
    }
    let cause = format!("image points are {sigma0:.1} times as imprecise as stated: the statement, the points or the model are wrong");
    let bound = if settings.covariances { OPERATOR } else { STATED };
    if sigma0 > bound { Verdict::Doubt(finding, cause) } else { Verdict::Slight(finding, cause) }
}

/// Residuals against the covariances of their points, which had no part in the adjustment. Half of them count, so that gross errors do not.
fn of_operator(calibration: &Calibration<'_>) -> Verdict {
    let prepared = calibration.prepared;
    let white = |residual: Residual| {
        let covariance = prepared.survey.sight(prepared.sights[residual.observation] as usize).covariance?;
        Some(Precision::Covariance(covariance).whitened(residual.v?))
    };
    let all: Vec<[f64; 2]> = calibration.solution.each_residual().filter_map(white).collect();
    let (Some(scale), Ok(chi)) = (scale_of(all.iter().copied()), ChiSquared::new(2.0 * all.len() as f64)) else {
        return Verdict::Untested("none was stated (--sigma, or covariances of the points)".into());
    };
    let finding = Finding { p: chi.sf(2.0 * all.len() as f64 * scale * scale), moves: None, explains: 0.0 };
    if finding.p >= ALPHA || scale < OPERATOR {
        return Verdict::Sound(finding);
    }
    Verdict::Doubt(
        finding,
        format!(
            "image points are {scale:.0} times as imprecise as their operator states: what it measured, their names or the model are wrong, or the camera moved"
        ),
    )
}
