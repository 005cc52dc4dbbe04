//! Gross errors of image points.

use calibench_adjust::{Options, Solution, adjust};
use statrs::distribution::{Binomial, DiscreteCDF};

use super::ALPHA;
use crate::resampled::NEAR;
use crate::shape::scale;
use crate::{Calibration, Finding, Verdict};

/// Residuals (as vectors) beyond so many of their standard deviations are counted: of normal ones `exp(-8)`.
const BEYOND: f64 = 4.0;
/// Huber's bound of the adjustment that shows what they do, in the same.
const BOUND: f64 = 2.0;
/// Image points in gross error, as a share, beyond which no estimate is to be trusted.
const MOST: f64 = 0.2;

/// Image points whose residuals are too long.
pub(super) struct Found {
    /// The standard deviation of an image coordinate against the a-priori one from the median residual: gross errors do not change it.
    scale: f64,
    beyond: u64,
    of: usize,
    /// Probability of as many by chance.
    pub(super) p: f64,
}

/// `None` where residuals are rounding, or there are none.
pub(super) fn found(solution: &Solution<'_>) -> Option<Found> {
    let scale = scale(solution).filter(|scale| *scale > 1e-5)?;
    let lengths: Vec<f64> = solution.each_white_residual().map(|[x, y]| x.hypot(y) / scale).collect();
    let beyond = lengths.iter().filter(|length| **length > BEYOND).count() as u64;
    let chance = Binomial::new((-0.5 * BEYOND * BEYOND).exp(), lengths.len() as u64).ok()?;
    Some(Found { scale, beyond, of: lengths.len(), p: if beyond == 0 { 1.0 } else { chance.sf(beyond - 1) } })
}

/// More residuals are long than chance makes, and the camera is another where they have less weight.
pub(super) fn check(calibration: &Calibration<'_>) -> Verdict {
    let Some(Found { scale, beyond, of, p }) = found(&calibration.solution) else {
        return Verdict::Untested("the residuals are no more than rounding".into());
    };
    let network = calibration.ended();
    let options = Options { huber: Some(BOUND * scale), most_iterations: NEAR, ..calibration.options() };
    let moves = adjust(&network, &options).ok().and_then(|robust| calibration.moves(robust.cameras(), scale));
    let finding = Finding { p, moves };
    if p >= ALPHA {
        return Verdict::Sound(finding);
    }
    let cause = format!("gross errors: {beyond} of {of} image points do not fit; {}", worst(calibration));
    if beyond as f64 > MOST * of as f64 { Verdict::Doubt(finding, cause) } else { finding.weighed(cause) }
}

/// The image point with the longest residual.
fn worst(calibration: &Calibration<'_>) -> String {
    let residuals = calibration.solution.each_residual();
    let length = |v: Option<[f64; 2]>| v.map_or(0.0, |[x, y]| x.hypot(y));
    let used = residuals.filter(|residual| residual.used != calibench_adjust::Use::LeftOut);
    let Some(worst) = used.max_by(|a, b| length(a.v).total_cmp(&length(b.v))) else { return String::new() };
    let sight = calibration.prepared.survey.sight(calibration.prepared.sights[worst.observation] as usize);
    let (image, target) = (&calibration.prepared.survey.images[sight.image], calibration.prepared.survey.target(sight.target));
    format!("the worst, {target} in {image}, is {:.1} px off; try --snoop", length(worst.v))
}
