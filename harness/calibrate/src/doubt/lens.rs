//! Whether the lens does what the model can say.

use calibench_adjust::{Network, Options, Status, adjust};
use calibench_model::camera::{Camera, CameraModel, OpenCv};

use crate::Calibration;
use crate::allowed::Allowed;
use crate::resampled::NEAR;

/// Standard deviation of the coefficients of a denominator about zero: they may take any value that lenses have, and stay where observations do not say.
const WEAK: f64 = 1.0;

/// The same observations with every parameter of the model free, or with OpenCV's rational model where that was so.
pub(super) fn check(calibration: &Calibration<'_>) -> Allowed {
    let mut network = calibration.ended();
    let before: usize = unknowns(&network);
    for interior in &mut network.cameras {
        (interior.camera, interior.parameters) = richer(interior.camera, &interior.parameters);
    }
    let more = unknowns(&network) - before;
    if more == 0 {
        return Allowed::untested("there is no richer model of this kind");
    }
    match adjust(&network, &Options { most_iterations: NEAR, ..calibration.options() }) {
        Ok(solution) => calibration.adjusted(&solution, more, || cause(&network)),
        Err(_) => Allowed::untested("a richer model is not determined"),
    }
}

fn unknowns(network: &Network) -> usize {
    network.cameras.iter().flat_map(|interior| &interior.parameters).filter(|status| status.is_unknown()).count()
}

fn cause(network: &Network) -> String {
    let rational = matches!(network.cameras.first().map(|interior| interior.camera), Some(Camera::OpenCv(_)));
    let example = if rational { "--model opencv8 or opencv-fisheye" } else { "a model with more parameters" };
    format!("the camera model is too poor for the lens; try {example}")
}

/// A camera that can do more, at the same place, and what is known of its parameters; the same where there is none.
fn richer(camera: Camera, statuses: &[Status]) -> (Camera, Vec<Status>) {
    let mut free: Vec<Status> = statuses.iter().map(|status| if *status == Status::Fixed { Status::Free } else { *status }).collect();
    match camera {
        Camera::OpenCv(opencv) if opencv.coefficients < 8 => {
            let richer: Camera = OpenCv { coefficients: 8, ..opencv }.into();
            free.resize(richer.parameters().len(), Status::Free);
            for (status, parameter) in
                free.iter_mut().zip(richer.parameters()).filter(|(_, parameter)| matches!(parameter.name, "k4" | "k5" | "k6"))
            {
                *status = Status::Observed { value: parameter.value, sigma: WEAK };
            }
            (richer, free)
        }
        other => (other, free),
    }
}
