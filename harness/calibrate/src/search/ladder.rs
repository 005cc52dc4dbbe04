//! Nested models, each from the minimum of the one before: none ends above one that it holds.

use super::sample::{Arrived, Sample};
use calibench_model::Pose;
use calibench_model::camera::Camera;

/// Of OpenCV's model with five coefficients.
pub(super) const BROWN: [&[&str]; 5] = [
    &["fx", "fy"],
    &["fx", "fy", "k1"],
    &["fx", "fy", "cx", "cy", "k1", "k2"],
    &["fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2"],
    &["fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3"],
];
/// Of the equidistant one.
pub(super) const EQUIDISTANT: [&[&str]; 4] =
    [&["fx", "fy"], &["fx", "fy", "k1"], &["fx", "fy", "cx", "cy", "k1", "k2"], &["fx", "fy", "cx", "cy", "k1", "k2", "k3", "k4"]];

/// Adjusts with more and more parameters; a rung that does not hold is left out. `None` if none of them holds.
pub(super) fn climbed(sample: &Sample, camera: &Camera, poses: Vec<Pose>, rungs: &[&[&str]], origin: &str) -> Option<Arrived> {
    let (mut camera, mut poses, mut reached) = (*camera, poses, None);
    for names in rungs {
        if let Some(arrived) = sample.with(&camera, &poses, names, origin) {
            (camera, poses) = (arrived.camera, arrived.poses.clone());
            reached = Some(arrived);
        }
    }
    reached
}
