//! What is asked of discs, and what was taken from the centres of their pictures.

use std::str::FromStr;

use thiserror::Error;

/// Which targets are discs, and how large.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Discs {
    /// Those whose radius the control file states.
    Control,
    /// Those too whose radius it does not state: all have this one, object units.
    Radius(f64),
}

/// Text that says nothing of discs.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error(
    "`{0}` is no radius of discs: expected a positive number in object units, or `control` for the columns radius and nX,nY,nZ of the control file"
)]
pub struct NoDiscs(String);

impl FromStr for Discs {
    type Err = NoDiscs;

    fn from_str(text: &str) -> Result<Self, NoDiscs> {
        if text == "control" {
            return Ok(Self::Control);
        }
        let radius = text.parse().ok().filter(|radius: &f64| *radius > 0.0 && radius.is_finite());
        radius.map(Self::Radius).ok_or_else(|| NoDiscs(text.into()))
    }
}

/// What was taken from the centres of discs' pictures.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Eccentricity {
    /// Of each observation, px (x right, y down): centre of the picture minus picture of the centre. Zero for what is no disc.
    pub offsets: Vec<[f64; 2]>,
    /// How many image points are of discs.
    pub image_points: usize,
    /// How many targets are discs.
    pub discs: usize,
    /// Image points of discs that do not lie before the camera as a whole: nothing was taken from them.
    pub unpictured: usize,
    /// Image points that were measured as discs and whose radius nobody states: nothing was taken from them.
    pub unstated: usize,
}

impl Eccentricity {
    /// The largest, px.
    pub fn largest(&self) -> f64 {
        self.offsets.iter().map(|[x, y]| x.hypot(*y)).fold(0.0, f64::max)
    }

    /// The root mean square over the image points of discs, px: of `sqrt(x^2 + y^2)`.
    pub fn rms(&self) -> f64 {
        (self.offsets.iter().map(|[x, y]| x * x + y * y).sum::<f64>() / self.image_points.max(1) as f64).sqrt()
    }
}
