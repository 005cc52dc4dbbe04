//! Covariances of omega, phi, kappa from those of a small rotation about the camera's axes.

use calibench_model::Pose;
use nalgebra::{Matrix3, Vector3};

/// Step of the differences, radians.
const STEP: f64 = 1e-6;
/// The cosine of phi below which omega and kappa turn about one axis: what differences of [`STEP`] leave of its digits.
const ONE_AXIS: f64 = 1e-9;

/// Standard deviations of omega, phi and kappa, radians, from the covariance of a small rotation about the camera's axes (`M` becomes `(1 + [d]x) M`).
/// `None` where they are not determined.
pub fn sigmas(pose: &Pose, covariance: &Matrix3<f64>) -> Option<[f64; 3]> {
    let angles = pose.angles();
    let column = |k: usize| {
        let moved = |sign: f64| {
            let mut angles = angles;
            angles[k] += sign * STEP;
            Pose::from_angles(pose.centre, angles).rotation
        };
        small(&(moved(1.0) * moved(-1.0).transpose())) / (2.0 * STEP)
    };
    let by_angles = Matrix3::from_columns(&[column(0), column(1), column(2)]);
    // The determinant is the cosine of phi.
    let back = Some(by_angles).filter(|matrix| matrix.determinant().abs() > ONE_AXIS)?.try_inverse()?;
    let turned = back * covariance * back.transpose();
    Some([0, 1, 2].map(|i| turned[(i, i)].max(0.0).sqrt()))
}

/// The vector of a small rotation `1 + [d]x`.
fn small(m: &Matrix3<f64>) -> Vector3<f64> {
    Vector3::new(m[(2, 1)] - m[(1, 2)], m[(0, 2)] - m[(2, 0)], m[(1, 0)] - m[(0, 1)]) * 0.5
}

/// The difference of two angles, radians, from minus pi to pi.
pub fn difference(a: f64, b: f64) -> f64 {
    let turn = std::f64::consts::TAU;
    let d = (a - b).rem_euclid(turn);
    if d > 0.5 * turn { d - turn } else { d }
}
