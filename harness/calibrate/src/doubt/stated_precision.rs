//! Whether residuals are as large as was stated.

use statrs::distribution::{ChiSquared, ContinuousCDF};

use super::ALPHA;
use crate::{Calibration, Finding, Verdict};

/// Times that residuals may exceed a standard deviation that a user stated.
const STATED: f64 = 1.5;
/// Times that they may exceed the covariances of an operator, which knows nothing but the noise of grey values.
const OPERATOR: f64 = 10.0;

/// Chi squared of the sum of squares, where a standard deviation or covariances were stated.
pub(super) fn check(calibration: &Calibration<'_>) -> Verdict {
    let settings = &calibration.prepared.settings;
    if settings.sigma_px.is_none() && !settings.covariances {
        return Verdict::Untested("none was stated (--sigma, --covariances)".into());
    }
    let redundancy = calibration.solution.counts().redundancy() as f64;
    let Ok(chi) = ChiSquared::new(redundancy) else {
        return Verdict::Untested("there is no redundancy".into());
    };
    // Gross errors that Huber's weights hold back say nothing of the others.
    let robust = settings.huber.and_then(|_| calibration.solution.scale());
    let sigma0 = robust.or(calibration.solution.sigma0()).unwrap_or(1.0);
    let finding = Finding { p: chi.sf(redundancy * sigma0 * sigma0), moves: None, explains: 0.0 };
    if finding.p >= ALPHA || sigma0 < STATED {
        return Verdict::Sound(finding);
    }
    let cause = format!("image points are {sigma0:.1} times as imprecise as stated: the statement, the points or the model are wrong");
    let bound = if settings.covariances { OPERATOR } else { STATED };
    if sigma0 > bound { Verdict::Doubt(finding, cause) } else { Verdict::Slight(finding, cause) }
}
