//! Gross errors of image points.

use std::collections::BTreeSet;

use calibench_adjust::{Options, ROUGH, Reliability, adjust, scale_of};
use statrs::distribution::{Binomial, DiscreteCDF};

use super::{ALPHA, Cameras};
use crate::neighbours::are_own;
use crate::resampled::NEAR;
use crate::{Calibration, Finding, GrossErrors, Verdict};

/// Residuals (as vectors, by their own covariances) beyond so many of their standard deviations are counted: of normal ones `exp(-8)`.
const BEYOND: f64 = 4.0;
/// Standard deviations below which residuals are rounding.
const ROUNDING: f64 = 1e-5;
/// Huber's bound of the adjustment that shows what they do, in the same.
const BOUND: f64 = 2.0;
/// Image points in gross error, as a share, beyond which no estimate is to be trusted.
const MOST: f64 = 0.2;

/// Share of the image points that may be left out.
pub(crate) const LEFT_OUT: f64 = 0.4;

/// Image points whose residuals are too long.
struct Found {
    /// Their standard deviation from the median: gross errors do not change it.
    scale: f64,
    beyond: u64,
    of: u64,
    /// Probability of as many by chance.
    p: f64,
}

/// Of the lengths of residuals; `None` of none, or where all are nothing.
fn found(lengths: &[f64]) -> Option<Found> {
    let scale = scale_of(lengths.iter().map(|length| [*length, 0.0])).filter(|scale| *scale > 0.0)?;
    let (beyond, of) = (lengths.iter().filter(|length| **length > BEYOND * scale).count() as u64, lengths.len() as u64);
    let chance = Binomial::new((-0.5 * BEYOND * BEYOND).exp(), of).ok()?;
    Some(Found { scale, beyond, of, p: if beyond == 0 { 1.0 } else { chance.sf(beyond - 1) } })
}

/// Whether residuals of these lengths are not those of normal errors: more are long than chance makes, or one is longer.
pub(crate) fn hold_gross(lengths: &[f64]) -> bool {
    found(lengths).is_some_and(|found| {
        let longest = lengths.iter().copied().fold(0.0, f64::max);
        found.p < ALPHA || found.of as f64 * (-0.5 * (longest / found.scale).powi(2)).exp() < ALPHA
    })
}

/// The lengths of residuals by their own standard deviations: of points in few images some are checked less than others, and of all together more are long than of normal numbers.
pub(crate) fn normalised(reliability: &Reliability) -> Vec<f64> {
    reliability.points.iter().filter_map(|point| point.length).collect()
}

/// Whether of white residuals no more are long than chance makes.
pub(super) fn is_clean(white: &[[f64; 2]]) -> bool {
    let lengths: Vec<f64> = white.iter().map(|[x, y]| x.hypot(*y)).collect();
    is_rounding(scale_of(white.iter().copied())) || found(&lengths).is_none_or(|found| found.p > ALPHA)
}

/// Whether residuals are no more than rounding, by their scale in a-priori standard deviations.
pub(crate) fn is_rounding(scale: Option<f64>) -> bool {
    scale.is_none_or(|scale| scale <= ROUNDING)
}

/// More image points were left out than an estimate can bear, or such as are not wrong for themselves.
fn wrongly_left_out(calibration: &Calibration<'_>) -> Option<Verdict> {
    let left_out = calibration.found.iter().filter(|found| found.left_out).count();
    let all = calibration.prepared.network.observations.len();
    let why = if left_out as f64 > LEFT_OUT * all as f64 {
        "what is left need not be the right part"
    } else if calibration.leaves_out_single_points() {
        return None;
    } else {
        "they are off together with their neighbours: lens, board, names or a motion are to be asked"
    };
    let cause = format!("gross errors: {left_out} of {all} image points were left out, and {why}");
    Some(Verdict::Doubt(Finding { p: 0.0, moves: None, explains: 0.0 }, cause))
}

impl Calibration<'_> {
    /// Whether residuals are not those of normal errors: more are long than chance makes, or one is longer.
    pub(crate) fn has_gross_errors(&self) -> bool {
        !is_rounding(self.solution.scale()) && self.reliability.as_ref().is_some_and(|reliability| hold_gross(&normalised(reliability)))
    }

    /// Whether any image point was left out.
    pub(crate) fn leaves_out_any(&self) -> bool {
        self.found.iter().any(|found| found.left_out)
    }

    /// Whether the image points that were left out are wrong for themselves, and not off together with their neighbours.
    pub(crate) fn leaves_out_single_points(&self) -> bool {
        let left_out: BTreeSet<usize> = self.found.iter().filter(|found| found.left_out).map(|found| found.observation).collect();
        are_own(&self.solution, &left_out)
    }
}

/// More residuals are long than chance makes, and the camera is another where they have less weight.
pub(super) fn check(calibration: &Calibration<'_>) -> Verdict {
    if let Some(verdict) = wrongly_left_out(calibration) {
        return verdict;
    }
    let lengths = calibration.reliability.as_ref().map(normalised).unwrap_or_default();
    let scale = calibration.solution.scale().filter(|scale| !is_rounding(Some(*scale)));
    let (Some(scale), Some(Found { beyond, of, p, .. })) = (scale, found(&lengths)) else {
        return Verdict::Untested("the residuals are no more than rounding".into());
    };
    let network = calibration.ended();
    let options = Options { huber: Some(BOUND * scale), most_iterations: NEAR, worth: ROUGH, ..calibration.options() };
    let moves = adjust(&network, &options).ok().and_then(|robust| calibration.moves(&Cameras::Others(robust.cameras().to_vec()), scale));
    let finding = Finding { p, moves, explains: 0.0 };
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
    let off = length(worst.v);
    // Of accurate points a tenth of a pixel says nothing.
    let digits = if off < 1.0 { 3 } else { 1 };
    let advice = match calibration.prepared.settings.gross {
        GrossErrors::Sought => "; they are not wrong for themselves, so that none was left out: --snoop does that",
        GrossErrors::Kept => "; without --plain those are left out that are wrong for themselves",
        GrossErrors::Rejected(_) | GrossErrors::Weighted(_) => "",
    };
    format!("the worst, {target} in {image}, is {off:.digits$} px off{advice}")
}
