//! Coefficients that lenses keep small, held where the images do not determine them.

use calibench_adjust::Status;
use calibench_model::camera::{Camera, CameraModel};

use crate::{Prepared, Prior};

/// Coefficients of OpenCV's denominator, of its thin prism and of its tilt, and how far from zero lenses have them, in their units.
const WEAK: [(&str, f64); 9] =
    [("k4", 1.0), ("k5", 1.0), ("k6", 1.0), ("s1", 0.1), ("s2", 0.1), ("s3", 0.1), ("s4", 0.1), ("tx", 0.1), ("ty", 0.1)];

impl Prepared {
    /// The same with those coefficients of OpenCV's models that are free observed as zero, so weakly that images that tell anything of them overrule it; `None`
    /// where there are none. They stand among the priors of the settings and are named with the result.
    #[must_use]
    pub fn held_weakly(&self) -> Option<Self> {
        let mut held = self.clone();
        let cameras = held.network.cameras.iter_mut().zip(&mut held.settings.cameras);
        for (interior, optics) in cameras.filter(|(interior, _)| matches!(interior.camera, Camera::OpenCv(_))) {
            let names: Vec<&str> = interior.camera.parameters().iter().map(|parameter| parameter.name).collect();
            for (status, name) in interior.parameters.iter_mut().zip(names).filter(|(status, _)| **status == Status::Free) {
                let Some((_, sigma)) = WEAK.iter().find(|(weak, _)| *weak == name) else { continue };
                *status = Status::Observed { value: 0.0, sigma: *sigma };
                optics.priors.push(Prior { parameter: name.to_owned(), value: 0.0, sigma: *sigma });
                held.held.push(name.to_owned());
            }
        }
        (!held.held.is_empty()).then_some(held)
    }
}
