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

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_3, PI};

    use nalgebra::Point3;

    use super::*;

    fn close(found: f64, expected: f64) {
        assert!((found - expected).abs() < 1e-7 * expected.abs().max(1e-9), "{found} is not {expected}");
    }

    fn of(angles: [f64; 3], covariance: &Matrix3<f64>) -> Option<[f64; 3]> {
        sigmas(&Pose::from_angles(Point3::new(1.0, 2.0, 3.0), angles), covariance)
    }

    /// About the camera's axes 2, 3 and 5 parts in 100000, x and z depending on each other.
    fn covariance() -> Matrix3<f64> {
        Matrix3::new(4.0, 0.0, 1.0, 0.0, 9.0, 0.0, 1.0, 0.0, 25.0) * 1e-10
    }

    /// With phi of 60 degrees a turn about x is half one of omega, and one of kappa by tan phi times as much: 25 + 3 * 4 - 2 tan phi.
    #[test]
    fn omega_and_kappa_grow_with_phi() {
        for omega in [0.0, 0.7, -2.0] {
            let [o, p, k] = of([omega, FRAC_PI_3, 0.0], &covariance()).unwrap();
            close(o, 4e-5);
            close(p, 3e-5);
            close(k, (37.0 - 2.0 * 3.0_f64.sqrt()).sqrt() * 1e-5);
        }
        let level = of([0.3, 0.0, 0.0], &covariance()).unwrap();
        level.into_iter().zip([2e-5, 3e-5, 5e-5]).for_each(|(found, expected)| close(found, expected));
    }

    /// A quarter of a turn of kappa: phi turns about x, omega about y.
    #[test]
    fn kappa_exchanges_the_axes() {
        let [o, p, k] = of([0.2, FRAC_PI_3, FRAC_PI_2], &covariance()).unwrap();
        close(o, 6e-5);
        close(p, 2e-5);
        close(k, (25.0 + 3.0 * 9.0_f64).sqrt() * 1e-5);
    }

    #[test]
    fn angles_about_one_axis_are_not_determined() {
        assert_eq!(of([0.2, FRAC_PI_2, 0.0], &covariance()), None);
        assert!(of([0.2, FRAC_PI_2 - 1e-3, 0.0], &covariance()).is_some());
    }

    #[test]
    fn a_small_rotation_is_its_vector() {
        let found = small(&Matrix3::new(1.0, -0.003, -0.002, 0.003, 1.0, -0.001, 0.002, 0.001, 1.0));
        assert!((found - Vector3::new(0.001, -0.002, 0.003)).norm() < 1e-15, "{found}");
    }

    #[test]
    fn angles_differ_by_at_most_half_a_turn() {
        for (a, b, expected) in [(0.3, 0.1, 0.2), (0.1, 0.3, -0.2), (PI - 0.1, 0.1 - PI, -0.2), (0.1 - PI, PI - 0.1, 0.2), (7.0, 7.0, 0.0)]
        {
            assert!((difference(a, b) - expected).abs() < 1e-12, "{a} {b}");
        }
        assert_eq!(difference(PI, 0.0), PI);
        assert!((difference(0.5 + 6.0 * PI, 0.25) - 0.25).abs() < 1e-12);
    }
}
