//! What differs from image to image.

use calibench_model::camera::CameraModel;

use super::check::{finite, positive, within};
use super::{Exterior, Network, NetworkError};

/// A number of each image's own, by which its camera differs from that of all its images: a principal distance that a lens focused anew, a sensor that
/// sits elsewhere after it was cleaned. Its expectation is zero.
///
/// Source: Ebner 1976, observed additional parameters, here one set for each image.
#[derive(Clone, Debug, PartialEq)]
pub struct PerImage {
    /// Its name in messages.
    pub name: String,
    /// Index of the camera.
    pub camera: usize,
    /// Unknown parameters of the camera, by their index, and by how much the number changes each.
    pub along: Vec<(usize, f64)>,
    /// A-priori standard deviation, in its unit.
    pub sigma: f64,
}

impl Network {
    pub(super) fn check_per_image(&self) -> Result<(), NetworkError> {
        for own in &self.per_image {
            let of = || format!("{} of each image", own.name);
            within(of, "camera", own.camera, self.cameras.len())?;
            positive(of, [own.sigma])?;
            finite(of, own.along.iter().map(|(_, share)| *share))?;
            let interior = &self.cameras[own.camera];
            for &(parameter, _) in &own.along {
                within(of, "parameter", parameter, interior.parameters.len())?;
                if !interior.parameters[parameter].is_unknown() {
                    let name = interior.camera.parameters()[parameter].name;
                    return Err(NetworkError::Held { of: of(), parameter: name.into() });
                }
            }
            if !own.along.iter().any(|(_, share)| *share != 0.0) {
                return Err(NetworkError::NotANumber { of: of(), what: "it changes no parameter" });
            }
        }
        Ok(())
    }

    /// Numbers of their own that the images of a camera have.
    pub(crate) fn of_each_image(&self, camera: usize) -> impl Iterator<Item = &PerImage> {
        self.per_image.iter().filter(move |own| own.camera == camera)
    }

    /// Of each image a zero for each number of its own; nothing where none is asked for.
    pub(crate) fn zero_own(&self) -> Vec<Vec<f64>> {
        let of = |image: &Exterior| vec![0.0; self.of_each_image(image.camera).count()];
        if self.per_image.is_empty() { Vec::new() } else { self.images.iter().map(of).collect() }
    }
}
