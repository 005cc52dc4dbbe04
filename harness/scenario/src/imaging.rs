//! From outlines in the image to the image that is read.

use calibench_model::Image;
use calibench_random::Key;
use calibench_synth::optics::{Optics, OpticsError};
use calibench_synth::raster::{Picture, Renderer};
use calibench_synth::sensor::{Clipped, Design, Exposure, Frame, Sensor, SensorError, row_shifts};
use calibench_synth::stations::Own;
use thiserror::Error;

use crate::sensor::SensorSetup;

/// Lens and sensor of a scenario.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Imaging {
    /// How light is spread.
    pub optics: Optics,
    /// How it is processed; `None` leaves it as it is.
    pub sensor: Option<SensorSetup>,
}

/// Lens or sensor that cannot be.
#[derive(Debug, Error)]
pub enum ImagingError {
    /// The lens.
    #[error(transparent)]
    Optics(#[from] OpticsError),
    /// The sensor.
    #[error(transparent)]
    Sensor(#[from] SensorError),
}

impl Imaging {
    /// As a station pictures that has something of its `own`. Light of its own needs a sensor, which passes on the rest where there is none.
    ///
    /// # Errors
    /// Blur, motion or exposure beyond what lens and sensor can be.
    pub fn with(&self, own: &Own) -> Result<Self, ImagingError> {
        let optics = own.optics(&self.optics);
        optics.check()?;
        let sensor = match &self.sensor {
            Some(setup) => Some(SensorSetup { sensor: Sensor::new(own.design(setup.sensor.design()))?, ..*setup }),
            None if own.has_light() => Some(SensorSetup { sensor: Sensor::new(own.design(&Design::default()))?, row_jitter: 0.0 }),
            None => None,
        };
        Ok(Self { optics, sensor })
    }

    /// Renders images of `width` x `height` px.
    ///
    /// # Errors
    /// Optics that are out of range.
    pub fn renderer(&self, width: usize, height: usize) -> Result<Renderer, OpticsError> {
        Renderer::new(&self.optics, width, height)
    }

    /// The image of `picture` under `key`.
    ///
    /// # Errors
    /// An image that its own file format cannot hold.
    pub fn expose(&self, renderer: &Renderer, picture: &Picture, key: Key<'_>) -> Result<Exposure, SensorError> {
        let frame = Frame { width: picture.width, height: picture.height };
        let Some(SensorSetup { sensor, row_jitter }) = &self.sensor else {
            return Ok(Exposure { image: renderer.render(picture, &[]), clipped: Clipped::default() });
        };
        let jitter = if *row_jitter > 0.0 { row_shifts(*row_jitter, frame.height, key) } else { Vec::new() };
        if !sensor.works_by_rows() {
            return sensor.expose(renderer.render(picture, &jitter), key);
        }
        // Strip by strip, while the rows are at hand.
        let clipped = std::sync::Mutex::new(Clipped::default());
        let image = renderer.render_with(picture, &jitter, |first, rows| {
            let strip = sensor.expose_rows(rows, first, frame, key);
            if let Ok(mut sum) = clipped.lock() {
                *sum = *sum + strip;
            }
        });
        Ok(Exposure { image, clipped: clipped.into_inner().unwrap_or_default() })
    }

    /// As [`Self::expose`], of the `light` that [`Renderer::render`] made of the picture before: where it is the same in many images.
    ///
    /// # Errors
    /// As [`Self::expose`].
    pub fn expose_light(&self, light: &Image<'static>, key: Key<'_>) -> Result<Exposure, SensorError> {
        match &self.sensor {
            Some(setup) => setup.sensor.expose(light.clone(), key),
            None => Ok(Exposure { image: light.clone(), clipped: Clipped::default() }),
        }
    }

    /// Whether the light of an image is the same whenever the picture is: rows do not move by themselves.
    pub fn has_steady_light(&self) -> bool {
        self.sensor.as_ref().is_none_or(|setup| setup.row_jitter == 0.0)
    }

    /// Whether the image has more than 8 bits.
    pub fn is_deep(&self) -> bool {
        self.sensor.as_ref().is_none_or(|setup| setup.sensor.bits().is_none_or(|bits| bits > 8))
    }

    /// Whether it has levels, more than 8 bits of them.
    pub fn has_deep_levels(&self) -> bool {
        self.sensor.as_ref().and_then(|setup| setup.sensor.bits()).is_some_and(|bits| bits > 8)
    }

    /// Whether its pixels differ, the same in every image.
    pub fn has_pattern(&self) -> bool {
        self.sensor.as_ref().is_some_and(|setup| setup.sensor.design().noise.has_pattern())
    }

    /// Whether a sensor's noise, or anything else in it, is random.
    pub fn is_random(&self) -> bool {
        self.sensor.as_ref().is_some_and(|setup| setup.row_jitter > 0.0 || !setup.sensor.is_deterministic())
    }
}
