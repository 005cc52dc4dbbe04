//! What a sensor's grey values are on average and how far they scatter: for bounds and for tests.

use super::electrons::top;
use super::{Noise, Sensor};

impl Sensor {
    /// The mean grey value (fraction of full scale) of a pixel to which shading leaves `light` (reflectance 1 is 1), where nothing is clipped:
    /// exposure, veil, dark signal and black level. `None` of a chain whose grey values are not linear in light or differ from photosite to photosite:
    /// colour filter, processing or gamma.
    pub fn mean(&self, light: f64) -> Option<f64> {
        let design = &self.design;
        if design.gamma.is_some() || design.filter.is_some() || self.processing().is_some() {
            return None;
        }
        let exposed = light * design.exposure + design.veil;
        Some(match &design.noise {
            Noise::Electrons(electrons) => {
                let (black, per_electron) = electrons.scale(design.converter);
                black + per_electron * (exposed * electrons.at_white + electrons.dark)
            }
            Noise::None | Noise::White { .. } => exposed,
        })
    }

    /// Variance of the grey value of a pixel whose mean, as [`Sensor::mean`] gives it, is `grey`: photon and dark shot noise, read noise, the camera's
    /// patterns as one image shows them, and quantisation as 1/12 of a squared step, its mean over grey values. Fractions of full scale, squared.
    ///
    /// Holds where nothing is clipped. `None` of a chain in which neighbours are not independent or the variance depends on more than the grey value:
    /// row noise, demosaic, processing, gamma, JPEG.
    pub fn variance(&self, grey: f64) -> Option<f64> {
        self.scatter(grey, true)
    }

    /// [`Sensor::variance`] with the camera's patterns or without them, from image to image.
    pub(super) fn scatter(&self, grey: f64, patterns: bool) -> Option<f64> {
        let design = &self.design;
        if design.demosaic.is_some()
            || design.gamma.is_some()
            || design.jpeg.is_some()
            || design.tables.is_some()
            || self.processing().is_some()
        {
            return None;
        }
        let noise = match &design.noise {
            Noise::None => 0.0,
            Noise::White { sigma, prnu } => sigma * sigma + if patterns { (prnu * grey.max(0.0)).powi(2) } else { 0.0 },
            Noise::Electrons(electrons) if electrons.row > 0.0 => return None,
            Noise::Electrons(electrons) => {
                let (black, per_electron) = electrons.scale(design.converter);
                let all = ((grey - black) / per_electron).max(0.0);
                let light = (all - electrons.dark).max(0.0);
                let fixed = (electrons.prnu * light).powi(2) + electrons.dsnu.powi(2);
                per_electron * per_electron * (all + electrons.read.powi(2) + if patterns { fixed } else { 0.0 })
            }
        };
        let step = |bits: u32| top(bits).recip();
        let rounded = |bits: Option<u32>| bits.map_or(0.0, |bits| step(bits).powi(2) / 12.0);
        let again = if design.output == design.converter { None } else { design.output };
        Some(noise + rounded(design.converter) + rounded(again))
    }
}
