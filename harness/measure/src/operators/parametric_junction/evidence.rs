//! Whether what was fitted is a junction: by the significance of what makes it one, and by what it leaves.

use calibench_model::Rejection;

use super::unknowns::Unknowns;
use super::window::Window;
use crate::following::Rest;
use crate::residuals::Residuals;

/// A bend, or a step of the grey value across an arm, has so many standard deviations at least. The best of many places in pure noise reaches about five.
const SIGNIFICANT: f64 = 7.0;
/// Half the window is at least so many times the blur, or else it may be any texture; but for so many standard deviations of the blur.
const TOO_SOFT: f64 = 3.0;
const DOUBT: f64 = 2.0;
/// The root of the covariance of neighbouring residuals, in units of half the contrast, beyond which the window holds something else. Fitted to noise under a
/// Gaussian of 1.5 to 3 px it is below that in 0.03 to 1.3 % of windows; at 0.2, as for chess corners, in 4 to 30 %.
pub(super) const MISFIT: f64 = 0.1;
/// Grey values of sectors differ by at most so many times what the window's grey values do: blur hides a part of a narrow sector's.
const BEYOND: f64 = 4.0;
/// Residuals beyond this part of half the contrast are those of a window of noise.
const DROWNED: f64 = 0.5;

/// By what a fit is judged.
pub(super) struct Limits {
    /// Side of its window, px.
    pub(super) side: usize,
    /// Side of the window that was asked for, px.
    pub(super) wanted: usize,
    /// As [`MISFIT`].
    pub(super) misfit: f64,
}

/// The residuals of a fit, if it is that of a junction. In a window that is smaller than wanted a spot may look like the end of a sector: there they are to be
/// white.
///
/// # Errors
/// [`Rejection::NoCorner`] for an edge or noise, [`Rejection::Misfit`] where something else is in the window.
pub(super) fn weigh<const P: usize>(
    window: &mut Window<'_, P>,
    unknowns: Unknowns,
    rest: &Rest<P>,
    limits: &Limits,
) -> Result<Residuals, Rejection> {
    let (x, side) = (&rest.x, limits.side);
    let pixels = (side * side) as f64;
    let arms = unknowns.arms;
    let grey = |k: usize| x[unknowns.grey(k % arms)];
    let fitted = (0..arms).map(|k| (grey(k + 1) - grey(k)).abs()).fold(0.0, f64::max);
    // A spot is fitted well by the tip of a sector that would be far darker than anything in the window.
    let seen = window.range();
    if fitted > BEYOND * seen {
        return Err(Rejection::Misfit);
    }
    let contrast = fitted.min(seen);
    let noise = (rest.normal.omega / (pixels - P as f64)).sqrt();
    if noise > DROWNED * 0.5 * contrast {
        return Err(Rejection::NoCorner);
    }
    let cofactors = rest.normal.cofactors::<P>().ok_or(Rejection::ErrorEllipse)?;
    let variance = unknowns.variance();
    if x[variance] - DOUBT * noise * cofactors[variance][variance].sqrt() > (0.5 * side as f64 / TOO_SOFT).powi(2) {
        return Err(Rejection::NoCorner);
    }
    let difference = |i: usize, j: usize| (cofactors[i][i] + cofactors[j][j] - 2.0 * cofactors[i][j]).sqrt();
    let is_step = |k: usize| {
        let (here, next) = (unknowns.grey(k), unknowns.grey((k + 1) % arms));
        (x[here] - x[next]).abs() > SIGNIFICANT * noise * difference(here, next)
    };
    // Of one narrow sector the grey value hangs together with the blur: here all else stays as it is. Of more sectors that would take a soft edge for two.
    let steps = || {
        let (n, i, j) = (&rest.normal.n, unknowns.grey(0), unknowns.grey(1));
        let (a, b, c) = (n[(i, i)], n[(i, j)], n[(j, j)]);
        (x[i] - x[j]).abs() > SIGNIFICANT * noise * ((a + c + 2.0 * b) / (a * c - b * b)).sqrt()
    };
    let bends = || (x[3] - x[2] - std::f64::consts::PI).abs() > SIGNIFICANT * noise * difference(2, 3);
    let is_junction = match arms {
        2 => steps() && bends(),
        3 => (0..3).all(is_step),
        // One of the two arms of a line may be invisible, as of a T.
        _ => (0..2).all(|k| is_step(k) || is_step(k + 2)),
    };
    if !is_junction {
        return Err(Rejection::NoCorner);
    }
    let residuals = window.residuals(x, contrast).ok_or(Rejection::Misfit)?;
    // More arms follow the more.
    let fits = if side < limits.wanted { residuals.are_white() } else { !residuals.are_no_noise(limits.misfit * 2.0 / arms as f64) };
    if fits { Ok(residuals) } else { Err(Rejection::Misfit) }
}
