//! Frames within frames.

use calibench_model::Pose;
use nalgebra::{Matrix3, Matrix6, Point3};

/// The pose of a camera that sits at `mount` on a rig at `station`: `N = M_m (M_s (X - X_s) - X_m)`.
pub fn mounted(mount: &Pose, station: &Pose) -> Pose {
    Pose { rotation: mount.rotation * station.rotation, centre: station.centre + station.rotation.tr_mul(&mount.centre.coords) }
}

/// `second` as `first` sees it, both in one frame: the pose that makes of coordinates in the first camera's axes those in the second's.
pub fn relative(first: &Pose, second: &Pose) -> Pose {
    Pose { rotation: second.rotation * first.rotation.transpose(), centre: Point3::from(first.rotation * (second.centre - first.centre)) }
}

/// What a small motion of the frame before `pose` is after it: six numbers (rotation about the axes, shift along them) to six. Where `N' = M (N - X0)` and N
/// changes by `d x N + s`, N' changes by `M d x N' + M (s - X0 x d)`.
pub fn adjoint(pose: &Pose) -> Matrix6<f64> {
    let m = &pose.rotation;
    let across = -(m * pose.centre.coords.cross_matrix());
    let block = |from: &Matrix3<f64>, i: usize, j: usize| from[(i, j)];
    Matrix6::from_fn(|i, j| match (i / 3, j / 3) {
        (0, 1) => 0.0,
        (1, 0) => block(&across, i - 3, j),
        _ => block(m, i % 3, j % 3),
    })
}
