//! What stands beside a target does not count.

use calibench_model::{Image, Rejection};

use super::chosen::{Chosen, Known, choose};
use super::fit::{Fitted, Limits, Parameters, Work};
use super::mask::Mask;
use super::start::inside;
use super::vague;

/// Fits over chosen pixels, at most: after the last, nothing more is changed.
const ROUNDS: usize = 6;
/// The window follows what is further than this from its middle pixel, px.
const BEYOND: f64 = 0.6;
/// How far a fit may be from its start to be believed where something stands beside the target: px, and a factor of its area.
const FAR: (f64, f64) = (2.0, 2.5);
/// The blur may be less than its start by this factor: a fit beside something else may make it too small.
const SHARPER: f64 = 0.8;
/// The least share of the outline that must be seen where the whole window led nowhere: something may stand before the target.
const OUTLINE: f32 = 0.8;
/// A blur, px, under which a target is where it is within the errors of a start.
const ASTRAY: f64 = 1.2;

/// A window in an image.
pub(super) struct Laid<'a> {
    /// The image.
    pub(super) image: &'a Image<'a>,
    /// The window's middle pixel.
    pub(super) centre: (i64, i64),
    /// Half its width, px.
    pub(super) half: i64,
}

impl Laid<'_> {
    /// Lays the window around the pose, where that is not in its middle; whether it did.
    fn follow(&mut self, work: &mut Work, at: &mut Parameters) -> bool {
        let off = at.pose.at.map(|p| p - self.half as f64);
        if off.iter().all(|d| d.abs() < BEYOND) {
            return false;
        }
        let (x, y) = self.centre;
        let Some(next) = inside(self.image, (x + off[0].round() as i64, y + off[1].round() as i64), self.half) else { return false };
        if next == self.centre {
            return false;
        }
        if work.observe(self.image, next, self.half).is_err() {
            // Not all of the next window is numbers: the old one again, in which they were.
            return work.observe(self.image, self.centre, self.half).is_err();
        }
        self.centre = next;
        at.pose.at = [at.pose.at[0] - (next.0 - x) as f64, at.pose.at[1] - (next.1 - y) as f64];
        true
    }
}

/// The least-squares fit from `begin` on. Where more than noise is left in the window of a target that is whole in itself, and something else is seen there, the
/// window is laid around what is found, and the fit goes on over the pixels that belong to the target; not where the residuals at its outline are a `misfit`.
///
/// # Errors
/// Those of [`Work::fit`]; [`Rejection::Misfit`].
pub(super) fn fit(
    work: &mut Work,
    mask: &Mask,
    begin: Parameters,
    (limits, misfit): (Limits, f64),
    laid: &mut Laid<'_>,
) -> Result<Fitted, Rejection> {
    let whole = work.fit(mask, begin, limits);
    if mask.is_open() {
        return whole;
    }
    if let Ok(fitted) = whole {
        if vague(&fitted).is_some() || work.planes.structure_of_all().is_white() {
            return whole;
        }
        // What hides a part of the target is not beside it.
        if work.planes.structure(0.5 * fitted.parameters.contrast).is_no_noise(misfit) {
            return Err(Rejection::Misfit);
        }
    }
    let known = Known { blur: SHARPER * begin.sigma, noise: None, sought: limits.blur };
    let mut course = Course { mask, begin, limits, known, counted: None, astray: false };
    let Some(mut found) = course.first(work, laid, whole.ok()) else {
        work.count(None);
        return work.fit(mask, begin, limits);
    };
    for _ in 1..ROUNDS {
        match course.next(work, laid, found?) {
            Some(next) => found = next,
            None => break,
        }
    }
    // What hides a part of the outline is not beside it.
    if course.astray && course.counted.is_some_and(|chosen| chosen.outline < OUTLINE) {
        return Err(Rejection::Misfit);
    }
    found
}

/// Fits over pixels that are chosen anew after each.
struct Course<'a> {
    mask: &'a Mask,
    begin: Parameters,
    limits: Limits,
    known: Known,
    /// The pixels of the last fit, if these are not all.
    counted: Option<Chosen>,
    /// The fit of the whole window led nowhere.
    astray: bool,
}

impl Course<'_> {
    /// The first fit without what stands beside the target; `None` if nothing does. Where much does, the fit of the `whole` window may have gone anywhere.
    fn first(&mut self, work: &mut Work, laid: &mut Laid<'_>, whole: Option<Fitted>) -> Option<Result<Fitted, Rejection>> {
        let Some(mut at) = whole.map(|fitted| fitted.parameters).filter(|at| at.is_near(&self.begin)) else {
            self.astray = true;
            let astray = Parameters { sigma: ASTRAY.max(self.begin.sigma), ..self.begin };
            self.counted = Some(choose(work, self.mask, &astray, &self.known)?);
            return Some(self.again(work, self.begin, Work::fit));
        };
        at.sigma = if self.limits.blur { at.sigma.max(self.known.blur) } else { self.begin.sigma };
        self.counted = Some(choose(work, self.mask, &at, &self.known)?);
        if laid.follow(work, &mut at) {
            self.counted = choose(work, self.mask, &at, &self.known);
        }
        Some(self.again(work, at, Work::fit_again))
    }

    /// The next fit; `None` if it would be the same.
    fn next(&mut self, work: &mut Work, laid: &mut Laid<'_>, found: Fitted) -> Option<Result<Fitted, Rejection>> {
        let mut at = found.parameters;
        // A fit over pixels that do not all belong to the target leaves more than noise.
        self.known.noise = Some(self.known.noise.map_or(found.noise, |least| least.min(found.noise)));
        let followed = laid.follow(work, &mut at);
        let pixels = choose(work, self.mask, &at, &self.known);
        if !followed && pixels.map(|chosen| chosen.pixels) == self.counted.map(|chosen| chosen.pixels) {
            return None;
        }
        self.counted = pixels;
        Some(self.again(work, at, Work::fit_again))
    }

    /// A fit over the pixels that count: where these do not tell the blur, it stays as it is.
    fn again(&self, work: &mut Work, begin: Parameters, fit: Fit) -> Result<Fitted, Rejection> {
        work.count(self.counted.as_ref().map(|chosen| &chosen.pixels));
        match fit(work, self.mask, begin, self.limits) {
            Err(_) if self.limits.blur => fit(work, self.mask, begin, Limits { blur: false, ..self.limits }),
            found => found,
        }
    }
}

type Fit = fn(&mut Work, &Mask, Parameters, Limits) -> Result<Fitted, Rejection>;

impl Parameters {
    /// Whether these are within the errors of a start.
    fn is_near(&self, start: &Self) -> bool {
        let [dx, dy] = [0, 1].map(|i| self.pose.at[i] - start.pose.at[i]);
        let determinant = |of: &Self| of.pose.affine.axx * of.pose.affine.ayy - of.pose.affine.axy * of.pose.affine.ayx;
        dx.hypot(dy) < FAR.0 && (determinant(self) / determinant(start)).ln().abs() < FAR.1.ln()
    }
}
