//! What a camera makes of the light behind its photosites' apertures: irradiance to the image that is read.
//!
//! The stages, each optional, in the order in which light and signal pass them: vignetting and the illumination's gradient, exposure, veil, colour filter,
//! [`Noise`] (for electrons: response non-uniformity, photon noise and dark signal, the full well, dark signal non-uniformity, read noise, row
//! noise), converter, demosaic, processing, gamma, output levels, JPEG. Grey values are fractions of full scale; light of 1 is what a target of reflectance 1
//! sends before exposure. The terms and units of the noise are those of EMVA 1288.
//!
//! A pixel's noise depends on the [`Key`] and its place alone, so that rows may be exposed in any order and on any number of threads. The patterns
//! of the camera (PRNU, DSNU) depend on seed, scenario and place: they are the same in all views and trials.

mod convert;
mod demosaic;
mod electrons;
mod error;
mod filter;
mod gamma;
mod jitter;
mod jpeg;
mod normal;
mod poisson;
mod processing;
mod quantised;
mod rows;
mod shading;
mod statistics;
#[cfg(test)]
mod tests;

use std::iter::Sum;
use std::ops::Add;

use calibench_model::{Image, PixelPoint};
use rayon::prelude::*;

pub use demosaic::{Demosaic, DemosaicTo};
pub use electrons::Electrons;
pub use error::SensorError;
use error::{check, check_bits, check_tables};
pub use filter::{ColourFilter, Pattern};
pub use gamma::Gamma;
pub use jitter::row_shifts;
pub use jpeg::through_jpeg;
pub use processing::Processing;
pub use quantised::through_tables;
pub use shading::{FallOff, Gradient, Per, Vignetting};

use calibench_random::Key;

/// Rows that a thread takes at a time.
const BLOCK: usize = 64;

/// What a sensor is made of, before it is checked. The default passes light on as it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    /// The lens's fall-off.
    pub vignetting: Option<Vignetting>,
    /// The illumination's gradient.
    pub gradient: Option<Gradient>,
    /// Grey value (fraction of full scale) of reflectance 1, before the filter.
    pub exposure: f64,
    /// Stray light that is everywhere alike, grey value (fraction of full scale) before the filter; negative for what a camera takes away as black.
    pub veil: f64,
    /// The colour filter.
    pub filter: Option<ColourFilter>,
    /// The noise.
    pub noise: Noise,
    /// Bits of the analogue-digital converter: 8, 10, 12, 14 or 16; `None` does not quantise nor clip.
    pub converter: Option<u32>,
    /// The mosaic of the filter to grey. Needs the filter.
    pub demosaic: Option<Demosaic>,
    /// What is done to the developed image before the curve.
    pub processing: Option<Processing>,
    /// The curve from light to grey.
    pub gamma: Option<Gamma>,
    /// Bits of the image that is handed out: 8, 12 or 16; `None` leaves it as it is (8 with JPEG).
    pub output: Option<u32>,
    /// JPEG of this quality, 1 to 100.
    pub jpeg: Option<u8>,
    /// JPEG with this quantisation table, row by row, 1 to 255 each. Not beside `jpeg`.
    pub tables: Option<[u8; 64]>,
}

/// How the noise is described: exactly one way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Noise {
    /// There is none.
    None,
    /// White Gaussian noise, added after exposure and filter.
    White {
        /// Its standard deviation, fraction of full scale.
        sigma: f64,
        /// Photo response non-uniformity PRNU1288: standard deviation of the response, as a fraction; on the light before the noise.
        prnu: f64,
    },
    /// What electrons do.
    Electrons(Electrons),
}

impl Noise {
    /// Whether pixels differ in response or offset, the same in every image of the camera.
    pub const fn has_pattern(&self) -> bool {
        match self {
            Self::None => false,
            Self::White { prnu, .. } => *prnu > 0.0,
            Self::Electrons(electrons) => electrons.prnu > 0.0 || electrons.dsnu > 0.0,
        }
    }

    /// White noise `decibel` dB below `signal`, a grey value: the difference of light and dark targets for a signal-to-noise ratio of contrast, the
    /// mean grey value for one of the mean. `decibel` is 20 lg(signal / sigma), `prnu` the response's standard deviation as a fraction.
    pub fn white_below(signal: f64, decibel: f64, prnu: f64) -> Self {
        Noise::White { sigma: signal * 10_f64.powf(-decibel / 20.0), prnu }
    }
}

impl Default for Design {
    fn default() -> Self {
        Self {
            vignetting: None,
            gradient: None,
            exposure: 1.0,
            veil: 0.0,
            filter: None,
            noise: Noise::None,
            converter: None,
            demosaic: None,
            processing: None,
            gamma: None,
            output: None,
            jpeg: None,
            tables: None,
        }
    }
}

/// A sensor that can be.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensor {
    design: Design,
}

/// The size of the whole image, px.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frame {
    /// Columns, px.
    pub width: usize,
    /// Rows, px.
    pub height: usize,
}

impl Frame {
    fn centre(self) -> PixelPoint {
        let middle = |length: usize| (length as f64 - 1.0) / 2.0;
        PixelPoint::new(middle(self.width), middle(self.height))
    }
}

/// Pixels whose grey value was outside what well, converter or output levels hold.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Clipped {
    /// Below.
    pub low: u64,
    /// Above.
    pub high: u64,
}

impl Add for Clipped {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { low: self.low + other.low, high: self.high + other.high }
    }
}

impl Sum for Clipped {
    fn sum<I: Iterator<Item = Self>>(parts: I) -> Self {
        parts.fold(Self::default(), Add::add)
    }
}

/// An image that was taken.
#[derive(Clone, Debug, PartialEq)]
pub struct Exposure {
    /// Grey values, fractions of full scale.
    pub image: Image<'static>,
    /// What was clipped: at the well or the converter each pixel once, and in addition where white balance or gamma left the output's levels.
    pub clipped: Clipped,
}

impl Sensor {
    /// Checks `design`.
    ///
    /// # Errors
    /// [`SensorError`] names the first number outside its bounds, or the stage that lacks another.
    pub fn new(design: Design) -> Result<Self, SensorError> {
        design.vignetting.as_ref().map_or(Ok(()), Vignetting::check)?;
        design.gradient.as_ref().map_or(Ok(()), Gradient::check)?;
        check("the exposure", design.exposure, 1e-6, 1e6)?;
        check("the veil", design.veil, -0.5, 1.0)?;
        design.filter.as_ref().map_or(Ok(()), ColourFilter::check)?;
        check_bits("a converter", design.converter, &[8, 10, 12, 14, 16], "8, 10, 12, 14 or 16")?;
        check_bits("an image", design.output, &[8, 12, 16], "8, 12 or 16")?;
        match &design.noise {
            Noise::None => {}
            Noise::White { sigma, prnu } => {
                check("the noise", *sigma, 0.0, 10.0)?;
                check("PRNU", *prnu, 0.0, 1.0)?;
            }
            Noise::Electrons(electrons) => electrons.check(design.converter)?,
        }
        if let Some(demosaic) = &design.demosaic {
            demosaic.check()?;
            design.filter.ok_or(SensorError::NoFilter)?;
        }
        design.processing.as_ref().map_or(Ok(()), Processing::check)?;
        design.gamma.map_or(Ok(()), Gamma::check)?;
        check_tables(&design)?;
        match (design.jpeg, design.output) {
            (Some(_), Some(bits)) if bits != 8 => return Err(SensorError::JpegBits(bits)),
            (Some(quality), _) => check("the quality of JPEG", f64::from(quality), 1.0, 100.0)?,
            _ => {}
        }
        Ok(Self { design })
    }

    /// Bits of the image that it hands out; `None` if nothing quantises it.
    pub fn bits(&self) -> Option<u32> {
        self.design.jpeg.map(|_| 8).or(self.design.tables.map(|_| 8)).or(self.design.output).or(self.design.converter)
    }

    /// What it is made of.
    pub fn design(&self) -> &Design {
        &self.design
    }

    /// Whether nothing random is in what it does; row jitter is the renderer's.
    pub fn is_deterministic(&self) -> bool {
        matches!(self.design.noise, Noise::None | Noise::White { sigma: 0.0, .. })
    }

    /// The image that the sensor takes of `irradiance`, in its place; `key` is the image's.
    ///
    /// Demosaicing and JPEG take up to another 4 bytes per pixel. Blocks of rows are spread over the current rayon pool.
    ///
    /// # Errors
    /// [`SensorError::JpegSize`] or [`SensorError::Jpeg`] of an image that JPEG cannot hold.
    pub fn expose(&self, mut irradiance: Image<'static>, key: Key<'_>) -> Result<Exposure, SensorError> {
        let frame = Frame { width: irradiance.width(), height: irradiance.height() };
        let rows = (BLOCK * frame.width).max(1);
        let blocks = irradiance.grey_mut().par_chunks_mut(rows).enumerate();
        let clipped = blocks.map(|(block, rows)| self.expose_rows(rows, block * BLOCK, frame, key));
        let exposed = clipped.reduce(Clipped::default, Add::add);
        let (image, developed) = self.develop(irradiance)?;
        Ok(Exposure { image, clipped: exposed + developed })
    }

    /// Whether [`Sensor::develop`] leaves exposed rows as they are: they are then final, and the image may be written strip by strip.
    pub fn works_by_rows(&self) -> bool {
        !self.is_finished_whole() && self.design.jpeg.is_none() && self.design.tables.is_none()
    }

    /// Whether rows are finished together, once the whole image is there.
    fn is_finished_whole(&self) -> bool {
        self.design.demosaic.is_some() || self.processing().is_some()
    }

    /// What is done to the developed image, if anything is.
    fn processing(&self) -> Option<&Processing> {
        self.design.processing.as_ref().filter(|processing| !processing.is_nothing())
    }

    /// The stages that need the whole image: demosaic, processing, with what follows them, and JPEG. `exposed` are all rows from [`Sensor::expose_rows`].
    ///
    /// # Errors
    /// As [`Sensor::expose`].
    pub fn develop(&self, mut exposed: Image<'static>) -> Result<(Image<'static>, Clipped), SensorError> {
        let mut clipped = Clipped::default();
        if let (Some(demosaic), Some(filter)) = (&self.design.demosaic, &self.design.filter) {
            let width = exposed.width().max(1);
            let raw = exposed.grey_mut().par_chunks_mut(width).enumerate();
            raw.for_each(|(y, row)| self.balance_row(demosaic, filter, row, y));
            exposed = demosaic.interpolate(&exposed, filter);
        }
        if let Some(processing) = self.processing() {
            exposed = processing.apply(exposed);
        }
        if self.is_finished_whole() {
            let width = exposed.width().max(1);
            let rows = exposed.grey_mut().par_chunks_mut(width);
            clipped = rows.map(|row| self.finish_row(row)).reduce(Clipped::default, Add::add);
        }
        let image = match (self.design.jpeg, &self.design.tables) {
            (Some(quality), _) => through_jpeg(exposed, quality)?,
            (None, Some(table)) => through_tables(exposed, table),
            (None, None) => exposed,
        };
        Ok((image, clipped))
    }
}
