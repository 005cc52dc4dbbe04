//! A window that follows what is fitted in it.

use calibench_model::{Image, Measurement, Rejection};
use nalgebra::SVector;

use crate::marquardt::{Normal, Problem, Solution, minimise};

/// The window is laid anew when the point is further than this beyond its middle pixel, px: more each time, so that it comes to rest also where
/// either of two windows finds the point in the other's middle.
const BEYOND: [f64; 6] = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5];
/// Each iteration ends with a step shorter than so many standard deviations. The first need not end near: the correction that follows moves it anyway.
const ROUGHLY: f64 = 3.0;
const NEARLY: f64 = 0.03;
/// Corrections for the pixel's area, at most.
const CORRECTIONS: usize = 20;
/// The last correction moves the unknowns by less than so many standard deviations, or the position by less than so many px: the next would move them by a
/// tenth of that at most.
const SETTLED: f64 = 0.3;
const STANDS: f64 = 3e-7;
/// After so many corrections it is enough that the position settles: without any blur its variance does so slowly.
const FEW: usize = 3;

/// A window whose quick model leaves out a part of the photosite's area; the first two unknowns are the position from its middle, px.
pub(crate) trait Laid<const P: usize>: Problem<P> {
    /// Lays the window around a pixel.
    fn centre_on(&mut self, pixel: (i64, i64));
    /// Takes from the grey values what the model leaves out of the photosite's area, as it is at `x`. `None` where the model has no meaning.
    ///
    /// It is at most a few hundredths of the contrast and hardly changes with the unknowns: a fit, a correction anew, and so on come to the same
    /// place as a fit of the whole model.
    fn correct(&mut self, x: &SVector<f64, P>) -> Option<()>;
    /// Takes every other pixel only, or again all; `false` for a window that cannot do that.
    fn thin(&mut self, _thin: bool) -> bool {
        false
    }
}

/// What was found in the window's middle pixel.
pub(crate) struct Rest<const P: usize> {
    /// In the image, px.
    pub(crate) at: [f64; 2],
    pub(crate) x: SVector<f64, P>,
    pub(crate) normal: Normal<P>,
}

/// Fits, laying the window of half-width `half` px anew, until what is found lies in its middle pixel; from `at` (px, in the image) on and the other unknowns
/// of `x`.
///
/// # Errors
/// [`Rejection::Border`] when the window leaves the image, [`Rejection::LeftWindow`], [`Rejection::NotConverged`].
pub(crate) fn follow<const P: usize>(
    window: &mut impl Laid<P>,
    (image, half): (&Image, i64),
    mut at: [f64; 2],
    mut x: SVector<f64, P>,
) -> Result<Rest<P>, Rejection> {
    if window.thin(true) {
        if let Some((there, near)) = approach(window, (image, half), at, x) {
            (at, x) = (there, near);
        }
        window.thin(false);
    }
    for beyond in BEYOND {
        let follow = 0.5 + beyond;
        let centre = at.map(|c| c.round() as i64);
        if !image.holds(centre[0], centre[1], half) {
            return Err(Rejection::Border);
        }
        window.centre_on((centre[0], centre[1]));
        (x[0], x[1]) = (at[0] - centre[0] as f64, at[1] - centre[1] as f64);
        x = minimise(window, x, ROUGHLY)?.x;
        let off = |x: &SVector<f64, P>| x[0].abs().max(x[1].abs());
        let mut normal = None;
        if off(&x) <= follow {
            let found = refined(window, x)?;
            (x, normal) = (found.x, Some(found.normal));
        }
        if off(&x) > half as f64 {
            return Err(Rejection::LeftWindow);
        }
        at = [centre[0] as f64 + x[0], centre[1] as f64 + x[1]];
        if let Some(normal) = normal.filter(|_| off(&x) <= follow) {
            return Ok(Rest { at, x, normal });
        }
    }
    Err(Rejection::NotConverged)
}

/// Near to what is found, by every other pixel: where that is (px, in the image) and the other unknowns. `None` where this does not lead there.
fn approach<const P: usize>(
    window: &mut impl Laid<P>,
    (image, half): (&Image, i64),
    at: [f64; 2],
    mut x: SVector<f64, P>,
) -> Option<([f64; 2], SVector<f64, P>)> {
    let centre = at.map(|c| c.round() as i64);
    if !image.holds(centre[0], centre[1], half) {
        return None;
    }
    window.centre_on((centre[0], centre[1]));
    (x[0], x[1]) = (at[0] - centre[0] as f64, at[1] - centre[1] as f64);
    let found = minimise(window, x, ROUGHLY).ok()?.x;
    let near = found[0].abs().max(found[1].abs()) <= half as f64;
    near.then(|| ([centre[0] as f64 + found[0], centre[1] as f64 + found[1]], found))
}

/// The fit of the whole model, from a fit of the quick one on.
fn refined<const P: usize>(window: &mut impl Laid<P>, mut x: SVector<f64, P>) -> Result<Solution<P>, Rejection> {
    let redundancy = window.redundancy();
    for correction in 0..CORRECTIONS {
        window.correct(&x).ok_or(Rejection::NotConverged)?;
        let found = minimise(window, x, NEARLY)?;
        let moved = found.x - x;
        x = found.x;
        let square = moved.dot(&(found.normal.n * moved));
        let short = SETTLED * SETTLED * found.normal.omega / redundancy;
        let rests = || correction >= FEW && found.normal.position_rests(&moved, short);
        if square <= short || moved[0].hypot(moved[1]) < STANDS || rests() {
            return Ok(found);
        }
    }
    Err(Rejection::NotConverged)
}

/// Why a window may hold too much.
const CROWDED: [Rejection; 3] = [Rejection::Misfit, Rejection::NotConverged, Rejection::LeftWindow];

/// What was fitted in a window.
pub(crate) struct Fitted {
    pub(crate) found: Measurement,
    /// Whether it leaves a little more than noise: not enough to reject it.
    pub(crate) doubtful: bool,
}

impl Fitted {
    fn variance(&self) -> f64 {
        self.found.covariance.map_or(f64::INFINITY, |covariance| covariance.sxx + covariance.syy)
    }
}

/// The fit over a window of the `wanted` side, px, or, where something else stands in it, over one of these smaller ones: the first that holds a fit where the
/// wanted one holds none, and where it leaves a doubt the one that is the most precise by its own residuals, up to the first without a doubt.
///
/// # Errors
/// Why there is none in the wanted window.
pub(crate) fn in_smaller_windows(
    wanted: usize,
    smaller: &[usize],
    fit: impl Fn(usize) -> Result<Fitted, Rejection>,
) -> Result<Measurement, Rejection> {
    let mut sides = smaller.iter().filter(|side| **side < wanted);
    let mut best = match fit(wanted) {
        Err(why) if CROWDED.contains(&why) => sides.find_map(|side| fit(*side).ok()).ok_or(why)?,
        first => first?,
    };
    let mut doubtful = best.doubtful;
    while let Some(side) = sides.next().filter(|_| doubtful) {
        let Ok(next) = fit(*side) else { continue };
        doubtful = next.doubtful;
        if next.variance() < best.variance() {
            best = next;
        }
    }
    Ok(best.found)
}
