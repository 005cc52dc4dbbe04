//! `parametric_corner`: a chess corner's grey values, fitted.

mod area;
mod fields;
mod levels;
mod lists;
mod model;
mod places;
mod residuals;
mod saddle;
mod start;
mod sums;
mod window;

use calibench_model::{Image, Measurement, PixelPoint, Rejection, Start, Unknowns, Warp};
use nalgebra::SVector;

use crate::following::{Fitted, Rest, follow, in_smaller_windows};
use crate::gradient::{ADDED, EACH, EVEN, LIGHT, estimated};
use crate::marquardt::covariance;
use crate::operator::{Operator, finite_around, window_centre};
use crate::parameter::{Parameter, Settings};
use crate::registry::{Build, Method};

use model::BASE;
use window::{Setting, Window};

/// The place of half the contrast among the unknowns, the last of the [`BASE`].
const HALF: usize = BASE - 1;
/// Blur at the start, px^2: between sharp and soft.
const VARIANCE: f64 = 0.5;
/// Sides of the smaller windows, px, that are tried where the residuals of the wanted one are no noise: a neighbour may stand in it.
const SMALLER: [usize; 4] = [13, 11, 9, 7];
/// Smaller windows than this, px, must leave nothing but noise to be believed: they follow anything.
const BELIEVED: usize = 9;
/// A smaller window holds half its side so many times the blur, or else it may be any texture.
const TOO_SOFT: f64 = 3.0;
/// Residuals beyond this part of half the contrast are those of a window of noise.
const DROWNED: f64 = 0.8;
/// Half the contrast, of edges where they are, is so many of its standard deviations, more where these cross at a small angle, or it is that of noise or texture, in which the
/// best place, directions and blur were sought.
const SEEN: f64 = 12.0;
/// Half the contrast in steps of the grey values: less is what a JPEG file makes of a block of nothing, a saddle as smooth as a blurred corner.
const LEVELS: f64 = 2.0;
/// Windows with more contrast, of full scale, have it from no step.
const FAINT: f64 = 0.03;
/// The root of the covariance of neighbouring residuals, in units of half the contrast, beyond which the window holds something else. On photographs of
/// OpenCV's samples, of lenses and prints as they are, it is 0.05 to 0.07 in the median and 0.13 at most but for one corner of 2101; on boards whose squares are
/// 6 px wide, 0.6 or more.
const MISFIT: f64 = 0.2;
/// As much of it makes smaller windows worth a try: a neighbour at the border of the window leaves no more.
const DOUBT: f64 = 0.05;
/// Edges that leave their tangents by less than this within the window, px, are taken for straight.
const STRAIGHT: f64 = 1e-3;
/// Parametric chess corner: the position at which a model of the grey values agrees best, in the least-squares sense, with those of the window.
///
/// The model is two straight edges that cross, dark and light areas in turn, blurred by a Gaussian and averaged over the photosite's area (a square, as wide as the
/// pixel unless `photosite` says otherwise). Unknowns are the position, the directions of both edges, the blur, and the two grey values; on demand a linear change
/// over the window, and the curvature of each edge (a lens bends the edges of large windows; to second order, for radii far beyond the window). Where the start tells how the lens warps
/// what is pictured, as the points around it on a board do, edges are as curved as that says, without an unknown: estimated curvatures cost precision.
/// For white noise of equal variance this is the maximum-likelihood estimate.
///
/// What changes linearly: `gradient` 1, something that is added to the grey values, as stray light (two unknowns); 2, the light, which multiplies them (two; grey
/// values must be zero without light: take a black level away first); 3, the dark and the light grey value each for itself, which covers the two before and a black
/// level, and widens the bound most (four).
///
/// The window of odd side, px, follows the corner until this lies in its middle pixel. The start comes from the image: the strongest saddle
/// of the smoothed grey values within `search` px of the given one, along each axis, and the edges from the grey values around it. Where these
/// are less like those opposite than unlike, there is no crossing; nor where half the contrast does not stand out of the residuals, or is less
/// than two steps of the grey values. Where residuals are no noise, since something else is in the window, smaller windows are tried, down to
/// 9 px, and then the point is rejected. Covariance (px^2):
/// `sigma0^2 N^-1`, with `sigma0^2` from the residuals.
///
/// Source: two blurred edges with unknown gain and offset fitted by least squares as in Wöhler 2013 (3D Computer Vision, Eq. 1.89 to 1.92) and Yang et al. 2018;
/// the photosite's integral as a mixture of Gaussians, and the crossing's expectation as a bivariate normal integral (over the correlation, with Gauss-Legendre
/// nodes, as in Drezner & Wesolowsky 1990), are our own choice.
pub struct ParametricCorner {
    window: usize,
    search: usize,
    gradient: u8,
    curvature: bool,
    photosite: f64,
}

const PARAMETERS: &[Parameter] = &[
    Parameter::odd("window", "side of the window, px", [7, window::WIDEST as u32], 15.0).always_shown(),
    Parameter::whole("search", "the corner is sought within so many px of the start, along each axis", [0, 12], 5.0),
    Parameter::named(
        "gradient",
        "a linear change over the window is estimated: none, added to the grey values, of the light, which multiplies them, or of both the dark and the light grey \
         value, each its own",
        &["none", "added", "light", "both"],
        0,
    ),
    Parameter::flag("curvature", "a curvature of each edge is estimated; else edges are straight"),
    Parameter::real("photosite", "side of the square that is sensitive to light in each pixel, px; 1: the whole pixel", [0.1, 1.0], 1.0),
];

/// The method's entry.
pub fn method() -> Method {
    Method {
        name: "parametric_corner",
        about: "least-squares fit of a chess corner's grey values: position, two edges, blur, two grey values",
        source: "calibench; cf. Wöhler 2013, Eq. 1.89 to 1.92, Yang et al. 2018",
        version: "1".into(),
        parameters: PARAMETERS,
        build: Build::With(|settings| Box::new(ParametricCorner::new(settings))),
    }
}

impl ParametricCorner {
    /// The operator with these settings of [`method`]'s parameters.
    pub fn new(settings: &Settings) -> Self {
        Self {
            window: settings.whole("window"),
            search: settings.whole("search"),
            gradient: settings.whole("gradient") as u8,
            curvature: settings.whole("curvature") == 1,
            photosite: settings.get("photosite"),
        }
    }

    /// The fit over a window of some side, px, from the edges seen around a place, px; `warp` as the start says.
    fn fitted(&self, window: (&Image, usize), position: [f64; 2], warp: Option<Warp>) -> Result<Fitted, Rejection> {
        let half = (window.1 / 2) as f64;
        let guess = start::directions(window.0, position, half as i64).ok_or(Rejection::NoCorner)?;
        let is_curved = warp.is_some_and(|warp| {
            let curvature = |normal: f64| warp.curvature([normal.cos(), normal.sin()]).abs();
            guess.normals.iter().any(|normal| 0.5 * curvature(*normal) * half * half >= STRAIGHT)
        });
        let warp = warp.filter(|_| is_curved);
        match (self.gradient, self.curvature, is_curved) {
            (EVEN, false, false) => self.fit::<7, EVEN, false>(window, &guess, warp),
            (ADDED, false, false) => self.fit::<9, ADDED, false>(window, &guess, warp),
            (LIGHT, false, false) => self.fit::<9, LIGHT, false>(window, &guess, warp),
            (_, false, false) => self.fit::<11, EACH, false>(window, &guess, warp),
            (EVEN, false, true) => self.fit::<7, EVEN, true>(window, &guess, warp),
            (ADDED, false, true) => self.fit::<9, ADDED, true>(window, &guess, warp),
            (LIGHT, false, true) => self.fit::<9, LIGHT, true>(window, &guess, warp),
            (_, false, true) => self.fit::<11, EACH, true>(window, &guess, warp),
            (EVEN, true, _) => self.fit::<9, EVEN, true>(window, &guess, warp),
            (ADDED, true, _) => self.fit::<11, ADDED, true>(window, &guess, warp),
            (LIGHT, true, _) => self.fit::<11, LIGHT, true>(window, &guess, warp),
            (_, true, _) => self.fit::<13, EACH, true>(window, &guess, warp),
        }
    }

    fn fit<const P: usize, const GRADIENT: u8, const CURVED: bool>(
        &self,
        (image, side): (&Image, usize),
        guess: &start::Guess,
        warp: Option<Warp>,
    ) -> Result<Fitted, Rejection> {
        let half = side as i64 / 2;
        let setting = Setting { side, photosite: self.photosite, mean: guess.mean, half: guess.half, warp };
        let mut window = Window::<P, GRADIENT, CURVED>::new(image, setting);
        let free = Window::<P, GRADIENT, CURVED>::FREE;
        let mut x = SVector::<f64, P>::zeros();
        x.as_mut_slice()[..7].copy_from_slice(&[0.0, 0.0, guess.normals[0], guess.normals[1], VARIANCE, 0.0, 1.0]);
        let Rest { at, x, normal } = follow(&mut window, (image, half), guess.position, x)?;
        let blurred = side < self.window && x[4] > (half as f64 / TOO_SOFT).powi(2);
        let structure = window.structure(&x).filter(|structure| !blurred && !structure.is_no_noise(MISFIT)).ok_or(Rejection::Misfit)?;
        if side < self.window && side < BELIEVED && !structure.is_white() {
            return Err(Rejection::Misfit);
        }
        let noise = (normal.omega / (side * side) as f64).sqrt();
        if noise > DROWNED * x[HALF].abs() {
            return Err(Rejection::NoCorner);
        }
        let redundancy = (side * side - P) as f64;
        let is_geometry = |unknown: usize| unknown < BASE - 2 || free && unknown >= P - 2;
        let cofactor = normal.cofactor(HALF, is_geometry).ok_or(Rejection::ErrorEllipse)?;
        let crossing = (x[2] - x[3]).sin().abs();
        if x[HALF].powi(2) * crossing < SEEN * SEEN * normal.omega / redundancy * cofactor * structure.spread() {
            return Err(Rejection::NoCorner);
        }
        let contrast = x[HALF].abs() * guess.half;
        if contrast < FAINT && contrast < LEVELS * step(image, at, half) {
            return Err(Rejection::NoCorner);
        }
        let covariance = covariance(&normal, redundancy).ok_or(Rejection::ErrorEllipse)?;
        let found = Measurement { position: PixelPoint::new(at[0], at[1]), covariance: Some(covariance) };
        Ok(Fitted { found, doubtful: structure.is_no_noise(DOUBT) })
    }
}

/// The least difference of grey values in the window around a place, px, of full scale.
fn step(image: &Image, at: [f64; 2], half: i64) -> f64 {
    let [x, y] = at.map(|c| c.round() as i64);
    let rows = (y - half).max(0)..=(y + half).min(image.height() as i64 - 1);
    let columns = (x - half).max(0)..=(x + half).min(image.width() as i64 - 1);
    let mut greys: Vec<f32> = rows.flat_map(|y| columns.clone().map(move |x| image.at(x as usize, y as usize))).collect();
    greys.sort_unstable_by(f32::total_cmp);
    let steps = greys.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| *step > 0.0);
    f64::from(steps.fold(f32::INFINITY, f32::min))
}

impl Operator for ParametricCorner {
    /// # Errors
    /// [`Rejection::Border`] when the window leaves the image, [`Rejection::NotFinite`], [`Rejection::NoCorner`] when there is no saddle near the start,
    /// [`Rejection::LeftWindow`], [`Rejection::NotConverged`], [`Rejection::Misfit`], [`Rejection::ErrorEllipse`] when the standard deviation is above a pixel.
    fn measure(&self, image: &Image, start: &Start) -> Result<Measurement, Rejection> {
        let half = self.window as i64 / 2;
        let centre = window_centre(image, start, half)?;
        finite_around(image, centre, half)?;
        let position = if self.search == 0 {
            [start.position.x, start.position.y]
        } else {
            saddle::saddle(image, centre, self.search, half as usize).ok_or(Rejection::NoCorner)?
        };
        let at = position.map(|c| c.round() as i64);
        if !image.holds(at[0], at[1], half) {
            return Err(Rejection::Border);
        }
        finite_around(image, (at[0], at[1]), half)?;
        // Without a search the start may be too far off for that.
        if self.search > 0 && !start::is_like_its_opposite(image, position, half) {
            return Err(Rejection::NoCorner);
        }
        in_smaller_windows(self.window, &SMALLER, |side| self.fitted((image, side), position, start.warp))
    }

    fn unknowns(&self) -> Unknowns {
        Unknowns { shape: true, levels: calibench_model::Levels::Two, blur: true, gradient: estimated(self.gradient) }
    }
}

#[cfg(test)]
mod tests;
