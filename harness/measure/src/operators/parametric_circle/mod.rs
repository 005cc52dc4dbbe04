//! `parametric_circle`: a disc's grey values, fitted.

use calibench_model::{Image, Measurement, PixelPoint, Rejection, Start};

use crate::blurred_ellipse::MARGIN;
use crate::disc_fit::{Fitted, Grey, fit, start};
use crate::ellipse::seek;
use crate::marquardt::covariance;
use crate::operator::Operator;
use crate::parameter::Parameter;
use crate::registry::{Build, Method};
use crate::residuals::misfit;

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
    misfit: f64,
}

/// See [`misfit`]: none of 30,000 discs in view leaves as much, all do of which something hides a seventh of the diameter.
pub(super) const MISFIT: f64 = 0.1;

const PARAMETERS: &[Parameter] = &[
    Parameter::whole("window", "side of the window, an odd number of px (an even one is made odd); 0: as the ellipse needs", [0, 151], 0.0),
    misfit(MISFIT),
];

/// The method's entry.
pub fn method() -> Method {
    Method {
        name: "parametric_circle",
        about: "least-squares fit of a disc's grey values: ellipse, blur, two grey values",
        source: "calibench",
        version: "1".into(),
        parameters: PARAMETERS,
        build: Build::With(|settings| Box::new(ParametricCircle { window: settings.whole("window"), misfit: settings.get("misfit") })),
    }
}

impl Operator for ParametricCircle {
    /// # Errors
    /// [`Rejection::Border`], [`Rejection::NotFinite`], [`Rejection::NoCorner`] when nothing stands out near the start,
    /// [`Rejection::LeftWindow`], [`Rejection::NotConverged`], [`Rejection::ErrorEllipse`] when the standard deviation is above a pixel,
    /// [`Rejection::Misfit`] where something else stands at the outline or hides a part of it.
    fn measure(&self, image: &Image, from: &Start) -> Result<Measurement, Rejection> {
        let guess = seek(image, from)?;
        let half = if self.window == 0 { (guess.ellipse.extent() + MARGIN).ceil() as i64 } else { self.window as i64 / 2 };
        let grey = Grey::new(image, guess.ellipse.position.map(|c| c.round() as i64), half)?;
        let [left, top] = grey.first;
        let Fitted { found, structure } = fit(&grey, &start(&grey, &guess))?;
        let (side, x, y) = (grey.side as f64 - 1.0, found.x[0], found.x[1]);
        if !(0.0..=side).contains(&x) || !(0.0..=side).contains(&y) {
            return Err(Rejection::LeftWindow);
        }
        if structure.is_no_noise(self.misfit) {
            return Err(Rejection::Misfit);
        }
        let covariance = covariance(&found.normal, grey.redundancy()).ok_or(Rejection::ErrorEllipse)?;
        Ok(Measurement { position: PixelPoint::new(x + left, y + top), covariance: Some(covariance) })
    }

    fn unknowns(&self) -> calibench_model::Unknowns {
        calibench_model::Unknowns { shape: true, levels: calibench_model::Levels::Two, blur: true, ..Default::default() }
    }
}

#[cfg(test)]
pub(crate) mod tests;
