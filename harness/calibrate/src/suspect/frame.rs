//! Images of another size than is stated: the principal point tells, and no residual.

use calibench_model::camera::{CameraModel, Ray};

use super::Suspected;
use crate::Calibration;

/// Times that images may be reduced or enlarged.
const TIMES: [f64; 6] = [0.25, 1.0 / 3.0, 0.5, 2.0, 3.0, 4.0];
/// Share of its place by which a principal point may be off the middle of the frame.
const OFF: f64 = 0.1;

/// The principal point of each camera, where it is known, as an image that was reduced or enlarged has it.
pub(super) fn suspected(calibration: &Calibration<'_>) -> Vec<Suspected> {
    (0..calibration.cameras()).filter_map(|camera| size(calibration, camera)).collect()
}

fn size(calibration: &Calibration<'_>, index: usize) -> Option<Suspected> {
    let camera = calibration.camera(index);
    let size = camera.size();
    let at = camera.project(Ray::from_tangent(0.0, 0.0)).ok()?.to_corner();
    let shares = [2.0 * at.x / f64::from(size.width), 2.0 * at.y / f64::from(size.height)];
    let times = TIMES.into_iter().find(|times| shares.iter().all(|share| (share / times - 1.0).abs() < OFF))?;
    let [width, height] = [size.width, size.height].map(|length| (f64::from(length) * times).round());
    Some(Suspected {
        kind: "size",
        what: format!(
            "the image points{} are of images of {width} x {height} px, and {} x {} px is stated: the principal point lies at {:.0}, {:.0}",
            calibration.of(index),
            size.width,
            size.height,
            at.x,
            at.y
        ),
        rms_px: None,
    })
}
