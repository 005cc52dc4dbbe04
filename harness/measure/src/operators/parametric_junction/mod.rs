//! `parametric_junction`: the grey values of sectors that meet in a point, fitted.

mod apex;
mod arms;
mod evidence;
mod gram;
mod lists;
mod rows;
mod sectors;
mod unknowns;
mod window;

use calibench_model::{Image, Measurement, PixelPoint, Rejection, Start};
use nalgebra::SVector;

use crate::following::{self, Rest, follow, in_smaller_windows};
use crate::gradient::estimated;
use crate::marquardt::covariance;
use crate::operator::{Operator, finite_around, window_centre};
use crate::parameter::{Parameter, Settings};
use crate::registry::{Build, Method};
use evidence::Limits;
use sectors::{Guess, sectors};
use unknowns::Unknowns;
use window::Window;

/// Blur at the start, px^2: between sharp and soft.
const VARIANCE: f64 = 0.5;
/// Sides of the smaller windows, px, that are tried where the residuals of the wanted one are no noise: a neighbour may stand in it.
const SMALLER: [usize; 2] = [13, 11];
/// The starts are that of the gradient and those so many px beside it.
const BESIDE: f64 = 2.0;

/// Parametric junction: the position at which a model of the grey values agrees best, in the least-squares sense, with those of the window.
///
/// The model is `arms` straight edges that leave one point, and as many sectors between them, each of its own grey value, blurred by a Gaussian and averaged over
/// the photosite's area (a square, as wide as the pixel unless `photosite` says otherwise). Two arms are the corner of one area, of any angle; three a Y or a T; four
/// are two straight edges that cross, with four grey values. Unknowns are the position, the directions, the blur and the grey values; on demand a linear change over
/// the window. For white noise of equal variance this is the maximum-likelihood estimate.
///
/// `arms` 0 lets the data choose: two, unless their residuals are no noise and those of three or four arms are.
///
/// What changes linearly: `gradient` 1, something that is added to the grey values (two unknowns); 2, the light, which multiplies them (two; grey
/// values must be zero without light: take a black level away first); 3, the grey value of each sector for itself (two a sector).
///
/// The window of odd side, px, follows the point until this lies in its middle pixel. The start comes from the image: the point to which the edges lead within
/// `search` px of the given one, along each axis, and the directions from the grey values around it. A straight edge, noise and what is neither are told from a
/// junction by the significance of what makes it one, and by residuals. Where these are no noise, since something else is in the window, smaller windows are tried,
/// down to 11 px, and then the point is rejected. Covariance (px^2): `sigma0^2 N^-1`, with `sigma0^2` from the residuals.
///
/// Source: our own. The mass of a Gaussian in a sector by Owen's T function (Owen 1956), the photosite's integral as a mixture of Gaussians, the start after
/// Förstner & Gülch 1987; cf. the parametric corner models of Deriche & Giraudon 1993 and Rohr 1992.
pub struct ParametricJunction {
    window: usize,
    search: usize,
    arms: usize,
    gradient: u8,
    photosite: f64,
    misfit: f64,
}

const PARAMETERS: &[Parameter] = &[
    Parameter::odd("window", "side of the window, px", [9, 41], 15.0).always_shown(),
    Parameter::choice("arms", "edges that leave the point; 4: two straight ones that cross; 0: chosen by the data", &[0, 2, 3, 4], 0.0),
    Parameter::whole("search", "the point is sought within so many px of the start, along each axis", [0, 12], 5.0),
    Parameter::named(
        "gradient",
        "a linear change over the window is estimated: none, added to the grey values, of the light, which multiplies them, or of each sector's grey value, each \
         its own",
        &["none", "added", "light", "sectors"],
        0,
    ),
    Parameter::real("photosite", "side of the square that is sensitive to light in each pixel, px; 1: the whole pixel", [0.1, 1.0], 1.0),
    Parameter::real(
        "misfit",
        "two arms are rejected where the covariance of neighbouring residuals is beyond its square, in units of half the contrast, and no noise; more arms earlier. \
                Prints and lenses of photographs may leave more",
        [0.0, 1.0],
        evidence::MISFIT,
    ),
];

/// The method's entry.
pub fn method() -> Method {
    Method {
        name: "parametric_junction",
        about: "least-squares fit of the grey values of two, three or four sectors that meet: position, directions, blur, grey values",
        source: "calibench; cf. Rohr 1992, Deriche & Giraudon 1993",
        version: "2".into(),
        parameters: PARAMETERS,
        build: Build::With(|settings| Box::new(ParametricJunction::new(settings))),
    }
}

/// A fit, and by what it is compared with one of other arms.
struct Fitted {
    measurement: Measurement,
    /// `n ln(r^T r) + p ln n` (Schwarz 1978).
    criterion: f64,
    /// Whether its residuals are white noise as far as can be told.
    is_white: bool,
}

impl ParametricJunction {
    /// The operator with these settings of [`method`]'s parameters.
    pub fn new(settings: &Settings) -> Self {
        Self {
            window: settings.whole("window"),
            search: settings.whole("search"),
            arms: settings.whole("arms"),
            gradient: settings.whole("gradient") as u8,
            photosite: settings.get("photosite"),
            misfit: settings.get("misfit"),
        }
    }

    /// The fit over a window of some side, px, around a place, px.
    fn fitted(&self, window: (&Image, usize), position: [f64; 2]) -> Result<Measurement, Rejection> {
        if self.arms > 0 {
            return self.of_arms(window, position, self.arms).map(|found| found.measurement);
        }
        let two = self.of_arms(window, position, 2);
        if let Ok(two) = &two
            && two.is_white
        {
            return Ok(two.measurement);
        }
        let more = [3, 4].map(|arms| self.of_arms(window, position, arms));
        let why = two.as_ref().err().copied();
        // More arms follow any texture the better: only where they leave nothing are they believed.
        let more = more.into_iter().flatten().filter(|found| found.is_white);
        let best = two.into_iter().chain(more).min_by(|a, b| a.criterion.total_cmp(&b.criterion));
        best.map(|found| found.measurement).ok_or(why.unwrap_or(Rejection::Misfit))
    }

    /// The fit of so many arms, from the most likely start on; where that fails, from the next.
    fn of_arms(&self, (image, side): (&Image, usize), position: [f64; 2], arms: usize) -> Result<Fitted, Rejection> {
        let half = side as i64 / 2;
        let [x, y] = position.map(|place| place.round() as i64);
        if !image.holds(x, y, half) {
            return Err(Rejection::Border);
        }
        let places = [[0.0, 0.0], [BESIDE, 0.0], [-BESIDE, 0.0], [0.0, BESIDE], [0.0, -BESIDE]];
        let from = places.map(|[dx, dy]| [position[0] + dx, position[1] + dy]);
        let mut guesses: Vec<Guess> = from.into_iter().filter_map(|from| sectors(image, (x, y), half, from, arms)).collect();
        guesses.sort_by(|a, b| a.left.total_cmp(&b.left));
        let mut why = Rejection::NoCorner;
        for (index, guess) in guesses.iter().enumerate().take(2) {
            match self.fit_of_arms((image, side), guess, arms) {
                Ok(found) => return Ok(found),
                Err(rejection) if index == 0 => why = rejection,
                Err(_) => {}
            }
        }
        Err(why)
    }

    fn fit_of_arms(&self, window: (&Image, usize), guess: &Guess, arms: usize) -> Result<Fitted, Rejection> {
        let unknowns = Unknowns { arms, gradient: self.gradient };
        match unknowns.count() {
            7 => self.fit::<7>(window, guess, unknowns),
            9 => self.fit::<9>(window, guess, unknowns),
            11 => self.fit::<11>(window, guess, unknowns),
            15 => self.fit::<15>(window, guess, unknowns),
            _ => self.fit::<17>(window, guess, unknowns),
        }
    }

    fn fit<const P: usize>(&self, (image, side): (&Image, usize), guess: &Guess, unknowns: Unknowns) -> Result<Fitted, Rejection> {
        let half = side as i64 / 2;
        let grey = &guess.grey[..unknowns.arms];
        let [low, high] = [f64::min, f64::max].map(|least: fn(f64, f64) -> f64| grey.iter().copied().reduce(least).unwrap_or(0.0));
        let (middle, scale) = (0.5 * (low + high), 0.5 * (high - low));
        // Grey values have 24 bits.
        if scale.is_nan() || scale <= 1e-6 * middle.abs() {
            return Err(Rejection::NoCorner);
        }
        let mut window = Window::<P>::new(image, side, unknowns, self.photosite, [middle, scale]);
        let mut x = SVector::<f64, P>::zeros();
        for k in 0..unknowns.arms {
            x[unknowns.grey(k)] = (guess.grey[k] - middle) / scale;
        }
        for k in 0..unknowns.directions() {
            x[2 + k] = guess.directions[k];
        }
        x[unknowns.variance()] = VARIANCE;
        let rest = follow(&mut window, (image, half), guess.position, x)?;
        let left = evidence::weigh(&mut window, unknowns, &rest, &Limits { side, wanted: self.window, misfit: self.misfit })?;
        let Rest { at, normal, .. } = rest;
        let pixels = (side * side) as f64;
        let covariance = covariance(&normal, pixels - P as f64).ok_or(Rejection::ErrorEllipse)?;
        Ok(Fitted {
            measurement: Measurement { position: PixelPoint::new(at[0], at[1]), covariance: Some(covariance) },
            criterion: pixels * (normal.omega * scale * scale).ln() + P as f64 * pixels.ln(),
            is_white: left.are_white(),
        })
    }
}

impl Operator for ParametricJunction {
    /// # Errors
    /// [`Rejection::Border`] when the window leaves the image, [`Rejection::NotFinite`], [`Rejection::NoCorner`] when there is no junction near the start,
    /// [`Rejection::LeftWindow`], [`Rejection::NotConverged`], [`Rejection::Misfit`], [`Rejection::ErrorEllipse`] when the standard deviation is above a pixel.
    fn measure(&self, image: &Image, start: &Start) -> Result<Measurement, Rejection> {
        let half = self.window as i64 / 2;
        let centre = window_centre(image, start, half)?;
        finite_around(image, centre, half)?;
        let position = if self.search == 0 {
            [start.position.x, start.position.y]
        } else {
            apex::apex(image, centre, self.search).ok_or(Rejection::NoCorner)?
        };
        let at = position.map(|c| c.round() as i64);
        finite_around(image, (at[0], at[1]), half)?;
        let fit = |side| self.fitted((image, side), position).map(|found| following::Fitted { found, doubtful: false });
        in_smaller_windows(self.window, &SMALLER, fit)
    }

    fn unknowns(&self) -> calibench_model::Unknowns {
        calibench_model::Unknowns { shape: true, levels: calibench_model::Levels::Areas, blur: true, gradient: estimated(self.gradient) }
    }
}

#[cfg(test)]
mod tests;
