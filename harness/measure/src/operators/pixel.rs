//! `pixel`: the start itself.

use calibench_model::{Image, Measurement, Rejection, Start};

use crate::operator::{Operator, window_centre};
use crate::registry::{Build, Method};

/// Pointing: returns its start unchanged, with the covariance that came with it. What it is worth is what the start is worth; how starts come about is the scenario's to say.
pub struct Pixel;

/// The method's entry.
pub fn method() -> Method {
    Method {
        name: "pixel",
        about: "the approximate position itself, as pointed at: the reference that every operator must beat",
        source: "Galo et al. 2011, Sect. 5.2 (manual measurement with pixel accuracy)",
        version: "1".into(),
        parameters: &[],
        build: Build::With(|_| Box::new(Pixel)),
    }
}

impl Operator for Pixel {
    /// # Errors
    /// [`Rejection::NotFinite`] and [`Rejection::Border`] for a start that is no place in the image.
    fn measure(&self, image: &Image, start: &Start) -> Result<Measurement, Rejection> {
        window_centre(image, start, 0)?;
        Ok(Measurement { position: start.position, covariance: start.covariance })
    }

    fn reads_grey_values(&self) -> bool {
        false
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn conforms() {
        crate::conformance::check(&super::Pixel, 1e-12);
    }
}
