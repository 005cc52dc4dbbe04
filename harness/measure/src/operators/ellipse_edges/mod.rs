//! `ellipse_edges`: an ellipse through points of a disc's edge.

mod conic;
mod search;
mod sectors;

use super::parametric_circle::MISFIT;
use calibench_model::{Image, Measurement, PixelPoint, Rejection, Start};

use crate::blurred_ellipse::{FINE, MARGIN, Planes};
use crate::disc_fit::{Grey, Rough, UNKNOWNS, Unknowns, fit, start};
use crate::ellipse::seek;
use crate::marquardt::{Solution, covariance};
use crate::operator::Operator;
use crate::parameter::Parameter;
use crate::registry::{Build, Method};
use crate::residuals::{Structure, misfit};
use search::{search, settle};
use sectors::Window;

const PARAMETERS: &[Parameter] = &[misfit(MISFIT)];

/// The search ends with a step of the position of so many standard deviations: the first one, with the outline parted around the start, and the last.
const ROUGHLY: f64 = 1.0;
const NEARLY: f64 = 1e-2;

/// Ellipse through edge points: the outline is parted into sectors of about a px, each sector's pixels say where the edge is there, the ellipse goes through these points.
///
/// The picture of the last ellipse, blurred by a Gaussian and averaged over the pixel's area (fill factor 1), is compared with the grey values themselves: nothing is
/// interpolated, and the outline's curvature is in the picture. What is left in the pixels of a sector, up to 4 px from the outline, is explained by a shift of the edge across
/// itself; the blur and both grey values are estimated from all pixels together with the shifts. A point's weight is the inverse of its variance.
/// The ellipse is the one that comes nearest to the points across the edge, in the weighted least-squares sense: on sharp edges these are orthogonal distances, on soft ones
/// the outline moves as it is seen through the blur. All is repeated until it stands. The start is the
/// area nearest to the given position that stands out from its ground. The result is the centre of the *ellipse*, as with `parametric_circle`.
///
/// The covariance (px^2) is that of the edge points, with what they have in common through blur and grey values, propagated to the ellipse; the variance of
/// the grey values is that of the residuals.
///
/// Source: our own.
pub struct EllipseEdges {
    misfit: f64,
}

/// The method's entry.
pub fn method() -> Method {
    Method {
        name: "ellipse_edges",
        about: "ellipse through the points where the edge of a disc is in each sector of its outline",
        source: "calibench",
        version: "3".into(),
        parameters: PARAMETERS,
        build: Build::With(|settings| Box::new(EllipseEdges { misfit: settings.get("misfit") })),
    }
}

impl Operator for EllipseEdges {
    /// # Errors
    /// [`Rejection::Border`], [`Rejection::NotFinite`], [`Rejection::NoCorner`] when nothing stands out near the start,
    /// [`Rejection::LeftWindow`], [`Rejection::NotConverged`], [`Rejection::ErrorEllipse`] when the standard deviation is above a pixel,
    /// [`Rejection::Misfit`] where something else stands at the outline or hides a part of it.
    fn measure(&self, image: &Image, from: &Start) -> Result<Measurement, Rejection> {
        let guess = seek(image, from)?;
        let half = (guess.ellipse.extent() + MARGIN).ceil() as i64;
        let grey = Grey::new(image, guess.ellipse.position.map(|c| c.round() as i64), half)?;
        let start = start(&grey, &guess);
        let rough = Rough::new(&grey, &start).ok().filter(|rough| !rough.is_quiet());
        let found = rough.and_then(|rough| near_picture(&grey, rough));
        let (found, structure) = found.map_or_else(|| in_two_steps(&grey, &start), Ok)?;
        // The position may stand before blur and contrast do: what the best picture leaves decides.
        let doubtful = structure.is_no_noise(self.misfit);
        if doubtful && fit(&grey, &start).is_ok_and(|best| best.structure.is_no_noise(self.misfit)) {
            return Err(Rejection::Misfit);
        }
        Ok(found)
    }

    fn unknowns(&self) -> calibench_model::Unknowns {
        calibench_model::Unknowns { shape: true, levels: calibench_model::Levels::Two, blur: true, ..Default::default() }
    }
}

/// With the outline parted around the ellipse of the best picture; `None` where this does not lead there.
fn near_picture(grey: &Grey, rough: Rough<'_>) -> Option<(Measurement, Structure)> {
    let (near, fineness) = (rough.near.x, rough.fineness());
    let (planes, stands) = rough.into_planes();
    let mut window = Window::new(grey, planes, fineness);
    let found = settle(&mut window, near, stands, NEARLY);
    let found = found.map_or_else(|| search(&mut window, near, NEARLY).ok(), Some)?;
    let structure = window.structure(found.x[6], found.x[7]);
    Some((conclude(grey, &found, window.redundancy()).ok()?, structure))
}

/// With the outline parted around a start, and again around what is found.
///
/// # Errors
/// Those of [`search`] and [`conclude`].
fn in_two_steps(grey: &Grey, start: &Unknowns) -> Result<(Measurement, Structure), Rejection> {
    let mut window = Window::<f64>::new(grey, Planes::new(grey.side), FINE);
    let rough = search(&mut window, *start, ROUGHLY)?;
    let found = search(&mut window, rough.x, NEARLY)?;
    let structure = window.structure(found.x[6], found.x[7]);
    Ok((conclude(grey, &found, window.redundancy())?, structure))
}

/// # Errors
/// [`Rejection::LeftWindow`], [`Rejection::ErrorEllipse`].
fn conclude(grey: &Grey, found: &Solution<UNKNOWNS>, redundancy: f64) -> Result<Measurement, Rejection> {
    let ([left, top], last) = (grey.first, grey.side as f64 - 1.0);
    let (x, y) = (found.x[0], found.x[1]);
    if !(0.0..=last).contains(&x) || !(0.0..=last).contains(&y) {
        return Err(Rejection::LeftWindow);
    }
    let covariance = covariance(&found.normal, redundancy).ok_or(Rejection::ErrorEllipse)?;
    Ok(Measurement { position: PixelPoint::new(x + left, y + top), covariance: Some(covariance) })
}

#[cfg(test)]
mod tests;
