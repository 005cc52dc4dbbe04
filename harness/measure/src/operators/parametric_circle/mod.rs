//! `parametric_circle`: a disc's grey values, fitted.

use calibench_model::{Image, Measurement, PixelPoint, Rejection, Start};
use multiversion::multiversion;
use nalgebra::SVector;

use crate::blurred_ellipse::{self, MARGIN, Planes, SHARPEST, is_pictured};
use crate::ellipse::{Ellipse, Guess, seek};
use crate::lanes::LANES;
use crate::marquardt::{Normal, Problem, Sums, covariance, minimise};
use crate::operator::Operator;
use crate::parameter::{Domain, Parameter};
use crate::registry::{Build, Method};

/// Centre, three of the shape, variance of the blur, grey value outside, contrast.
const UNKNOWNS: usize = 8;
/// Blur at the start, px^2.
const VARIANCE: f64 = 0.5;
/// The iteration ends with a step of so many standard deviations.
const NEARLY: f64 = 1e-2;

/// Parametric circle: the ellipse whose blurred picture agrees best, in the least-squares sense, with the grey values of the window.
///
/// The model is an ellipse of one grey value on a ground of another, dark on light or light on dark, blurred by a Gaussian and averaged over the
/// pixel's area (fill factor 1). Unknowns are the centre, the semi-axes and their direction (as a symmetric matrix), the blur, and both grey values.
/// For white noise of equal variance this is the maximum-likelihood estimate. The result is the centre of the *ellipse*; that of the disc
/// lies elsewhere in perspective ([`calibench_model::eccentricity`]).
///
/// The window of odd side, px, is centred on the ellipse; 0 makes it as large as the ellipse needs, with 5 px around it. The start is the area
/// nearest to the given position that stands out from its ground; where the start has an affinity, its window is made large enough for it.
/// Covariance (px^2): `sigma0^2 N^-1`, with `sigma0^2` from the residuals.
///
/// Source: our own; Green's theorem turns the average over a pixel into a sum along the outline.
pub struct ParametricCircle {
    window: usize,
}

const PARAMETERS: &[Parameter] = &[Parameter {
    name: "window",
    about: "side of the window, an odd number of px (an even one is made odd); 0: as the ellipse needs",
    domain: Domain::Whole { min: 0, max: 151 },
    default: 0.0,
    always_shown: false,
}];

/// The method's entry.
pub fn method() -> Method {
    Method {
        name: "parametric_circle",
        about: "least-squares fit of a disc's grey values: ellipse, blur, two grey values",
        source: "calibench",
        version: "1".into(),
        parameters: PARAMETERS,
        build: Build::With(|settings| Box::new(ParametricCircle { window: settings.whole("window") })),
    }
}

impl Operator for ParametricCircle {
    /// # Errors
    /// [`Rejection::Border`], [`Rejection::NotFinite`], [`Rejection::NoCorner`] when nothing stands out near the start,
    /// [`Rejection::LeftWindow`], [`Rejection::NotConverged`], [`Rejection::ErrorEllipse`] when the standard deviation is above a pixel.
    fn measure(&self, image: &Image, start: &Start) -> Result<Measurement, Rejection> {
        let Guess { ellipse, inside, outside } = seek(image, start)?;
        let half = if self.window == 0 { (ellipse.extent() + MARGIN).ceil() as i64 } else { self.window as i64 / 2 };
        let centre = ellipse.position.map(|c| c.round() as i64);
        let mut disc = Disc::new(image, centre, half)?;
        let (at, [a, b, c]) = (disc.in_window(ellipse.position), ellipse.shape);
        let start = SVector::from([at[0], at[1], a, b, c, VARIANCE, outside, inside - outside]);
        let found = minimise(&mut disc, start, NEARLY)?;
        let side = disc.planes.side as f64 - 1.0;
        if !(0.0..=side).contains(&found.x[0]) || !(0.0..=side).contains(&found.x[1]) {
            return Err(Rejection::LeftWindow);
        }
        let covariance = covariance(&found.normal, disc.redundancy()).ok_or(Rejection::ErrorEllipse)?;
        let position = PixelPoint::new(found.x[0] + disc.first[0], found.x[1] + disc.first[1]);
        Ok(Measurement { position, covariance: Some(covariance) })
    }

    fn unknowns(&self) -> calibench_model::Unknowns {
        calibench_model::Unknowns { shape: true, levels: true, blur: true, ..Default::default() }
    }
}

/// A disc in a window, as a least-squares problem.
struct Disc {
    grey: Vec<f64>,
    /// The window's first pixel.
    first: [f64; 2],
    planes: Planes,
}

impl Disc {
    fn new(image: &Image, [x, y]: [i64; 2], half: i64) -> Result<Self, Rejection> {
        let rows = image.rows_around(x, y, half).ok_or(Rejection::Border)?;
        let grey: Vec<f64> = rows.flatten().map(|grey| f64::from(*grey)).collect();
        if !grey.iter().all(|grey| grey.is_finite()) {
            return Err(Rejection::NotFinite);
        }
        let first = [x - half, y - half].map(|c| c as f64);
        Ok(Self { grey, first, planes: Planes::new((2 * half + 1) as usize) })
    }

    fn in_window(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [x - self.first[0], y - self.first[1]]
    }
}

impl Problem<UNKNOWNS> for Disc {
    fn normal(&mut self, x: &SVector<f64, UNKNOWNS>) -> Option<Normal<UNKNOWNS>> {
        let ellipse = Ellipse { position: [x[0], x[1]], shape: [x[2], x[3], x[4]] };
        if !x.iter().all(|value| value.is_finite()) || !is_pictured(&ellipse, x[5], self.planes.side) {
            return None;
        }
        self.planes.fill(&ellipse, x[5]);
        Some(products(&self.grey, &self.planes, x[6], x[7]).normal())
    }

    fn lowest(&self, unknown: usize) -> f64 {
        if unknown == 5 { SHARPEST } else { f64::NEG_INFINITY }
    }

    fn redundancy(&self) -> f64 {
        (self.grey.len() - UNKNOWNS) as f64
    }
}

/// The normal equations' sums over all pixels.
#[multiversion(targets("x86_64+avx2", "x86_64+avx512f+avx512vl"))]
fn products(grey: &[f64], planes: &Planes, ground: f64, contrast: f64) -> Sums<UNKNOWNS> {
    let [x, y] = blurred_ellipse::CENTRE;
    let [a, b, c] = blurred_ellipse::SHAPE;
    let mut sums = Sums::new();
    for (row, grey) in grey.chunks_exact(planes.side).enumerate() {
        for (chunk, grey) in grey.chunks(LANES).enumerate() {
            let at = row * planes.stride + chunk * LANES;
            let covered = planes.lanes(blurred_ellipse::COVERED, at);
            let (mut j, mut r) = ([[0.0; LANES]; UNKNOWNS], [0.0; LANES]);
            for (j, plane) in j.iter_mut().zip([x, y, a, b, c, blurred_ellipse::VARIANCE]) {
                *j = planes.lanes(plane, at);
                j.iter_mut().for_each(|by| *by *= contrast);
            }
            (j[6], j[7]) = ([1.0; LANES], covered);
            for (i, grey) in grey.iter().enumerate() {
                r[i] = grey - ground - contrast * covered[i];
            }
            // What lies past the window's side counts for nothing.
            j.iter_mut().for_each(|j| j[grey.len()..].fill(0.0));
            sums.add(&j, &r);
        }
    }
    sums
}

#[cfg(test)]
pub(crate) mod tests;
