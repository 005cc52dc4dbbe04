//! From the lens to the photosite: blur and aperture.

mod kernel;
mod levels;
mod profile;
mod spread;

pub(crate) use kernel::{Kernel, Part};
pub(crate) use levels::{Levels, Place};
pub(crate) use spread::Spread;

use thiserror::Error;

/// The smallest Gaussian blur, px, besides none at all.
pub const SMALLEST_BLUR: f64 = 0.02;
/// The smallest Gaussian blur beside a defocus or a motion, px: no lens is without diffraction.
pub const SMALLEST_BLUR_BESIDE: f64 = 0.1;

/// How light is spread over the image before it is sampled, px.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Optics {
    /// Standard deviation of the Gaussian blur, px: everywhere, or in the middle of the frame.
    pub blur: f64,
    /// Standard deviation of the Gaussian blur in the frame's corners, px. Its square grows with the square of the distance from the middle.
    pub corner_blur: Option<f64>,
    /// Radius of the defocus disc, px; 0 for none.
    pub defocus: f64,
    /// A straight motion during the exposure.
    pub motion: Option<Motion>,
    /// What part of the light is spread wider.
    pub tail: Option<Tail>,
    /// Width of the square photosite, px, at most 1: the linear fill factor.
    pub aperture: f64,
}

/// A part of the light that is spread wider, as by haze, a filter before the lens, or processing: the point spread is a sum of two Gaussians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tail {
    /// Its share of the light, below 1.
    pub share: f64,
    /// Standard deviation of its Gaussian, px: everywhere in the frame.
    pub blur: f64,
}

/// A straight motion of the picture, at constant speed, centred on the exposure's middle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// Length, px.
    pub length: f64,
    /// Direction in the image, from x towards y (clockwise as displayed), radians.
    pub direction: f64,
}

/// Optics that cannot be pictured.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum OpticsError {
    /// A value out of range.
    #[error("{what} is {value}: expected {expected}")]
    OutOfRange {
        /// Of what.
        what: &'static str,
        /// The value.
        value: f64,
        /// The range.
        expected: &'static str,
    },
    /// A disc or a line without any diffraction.
    #[error("a {0} needs a Gaussian blur of at least {SMALLEST_BLUR_BESIDE} px beside it: no lens is without diffraction")]
    NeedsBlur(&'static str),
}

impl Default for Optics {
    /// No blur, photosites that fill their pixels.
    fn default() -> Self {
        Self { blur: 0.0, corner_blur: None, defocus: 0.0, motion: None, tail: None, aperture: 1.0 }
    }
}

impl Optics {
    /// Checks every value.
    ///
    /// # Errors
    /// The first that is out of range.
    pub fn check(&self) -> Result<(), OpticsError> {
        let range = |what, value: f64, good: bool, expected| {
            if good && value.is_finite() { Ok(()) } else { Err(OpticsError::OutOfRange { what, value, expected }) }
        };
        let blur = |sigma: f64| sigma == 0.0 || (SMALLEST_BLUR..=100.0).contains(&sigma);
        range("the blur", self.blur, blur(self.blur), "0 or 0.02 to 100 px")?;
        range("the defocus disc's radius", self.defocus, (0.0..=100.0).contains(&self.defocus), "0 to 100 px")?;
        range("the photosite's width", self.aperture, (0.05..=1.0).contains(&self.aperture), "0.05 to 1 px")?;
        if let Some(corner) = self.corner_blur {
            let good = self.blur > 0.0 && corner >= self.blur && corner <= 100.0 && corner <= 20.0 * self.blur;
            range("the blur in the corners", corner, good, "at least the blur in the middle, which is not 0, and at most 20 times that")?;
        }
        if let Some(tail) = self.tail {
            range("the tail's share", tail.share, (0.0..=0.5).contains(&tail.share), "0 to 0.5")?;
            let wider = self.blur > 0.0 && tail.blur >= self.corner_blur.unwrap_or(self.blur) && tail.blur <= 100.0;
            range("the tail's blur", tail.blur, wider, "at least that of the rest of the light, which is not 0, and at most 100 px")?;
        }
        let motion = self.motion.map_or(0.0, |motion| motion.length);
        range("the motion's length", motion, (0.0..=200.0).contains(&motion), "0 to 200 px")?;
        let needy = [("defocus disc", self.defocus), ("motion", motion)].into_iter().find(|(_, size)| *size > 0.0);
        match needy {
            Some((what, _)) if self.blur < SMALLEST_BLUR_BESIDE => Err(OpticsError::NeedsBlur(what)),
            _ => Ok(()),
        }
    }

    /// How far from a point its light falls, px.
    pub fn reach(&self) -> f64 {
        let sigma = self.corner_blur.unwrap_or(self.blur).max(self.tail.map_or(0.0, |tail| tail.blur));
        6.0 * sigma + self.aperture / 2.0 + self.defocus + self.motion.map_or(0.0, |motion| motion.length / 2.0) + 1.0
    }
}
