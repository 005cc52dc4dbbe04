use super::*;
use crate::approximate::tests::{Chance, apart, lens, pinhole, see};

#[test]
fn rows_are_differences() {
    let mut chance = Chance::new(1);
    let (camera, pose, point) = (lens(), chance.pose(), chance.point());
    let n = pose.camera_from_world(&point);
    let by_ray = camera.derivatives(pose.ray(&point)).unwrap().by_ray;
    let rows = by_ray.map(|g| pose_row(&pose, &n, g));
    for k in 0..6 {
        let at = |h: f64| see(&camera, &moved_pose(&pose, &(SVector::<f64, 6>::ith(k, h))), &point);
        let (high, low) = (at(1e-5), at(-1e-5));
        for (row, difference) in rows.iter().zip([high.x - low.x, high.y - low.y]) {
            assert!((row[k] - difference / 2e-5).abs() < 1e-5, "{k}: {} {}", row[k], difference / 2e-5);
        }
    }
}

#[test]
fn exact_points_give_the_exact_pose_from_nearby() {
    let mut chance = Chance::new(2);
    for _ in 0..200 {
        let (pose, points) = (chance.pose(), chance.points(12));
        let control = chance.control(&lens(), &pose, &points, 0.0);
        let start = moved_pose(&pose, &SVector::from_fn(|_, _| 0.05 * chance.normal()));
        let fit = fit_pose(&lens(), &start, &control).unwrap();
        assert!(apart(&fit.pose, &pose) < 1e-11, "{}", apart(&fit.pose, &pose));
        assert_eq!(fit.redundancy, 18);
        assert!(fit.sigma0().unwrap() < 1e-9);
    }
}

/// Mahalanobis distances of the estimated pose follow chi-square with six degrees of freedom; so does the sum of squares with the redundancy.
#[test]
fn the_cofactors_are_honest() {
    let mut chance = Chance::new(3);
    let (camera, pose, points) = (pinhole(), chance.pose(), chance.points(20));
    let (trials, sigma) = (2000, 0.3);
    let (mut distance, mut squares) = (0.0, 0.0);
    for _ in 0..trials {
        let control = chance.control(&camera, &pose, &points, sigma);
        let fit = fit_pose(&camera, &pose, &control).unwrap();
        let turn = Rotation3::from_matrix_unchecked(pose.rotation * fit.pose.rotation.transpose()).scaled_axis();
        let shift = pose.centre - fit.pose.centre;
        let error = SVector::from([turn.x, turn.y, turn.z, shift.x, shift.y, shift.z]);
        let weight = fit.cofactor.unwrap().try_inverse().unwrap() / (sigma * sigma);
        distance += (error.transpose() * weight * error).x / f64::from(trials);
        squares += fit.squares / (sigma * sigma) / f64::from(trials);
    }
    // Standard deviations of the means: sqrt(2 k / trials).
    assert!((distance - 6.0).abs() < 4.0 * (12.0 / f64::from(trials)).sqrt(), "{distance}");
    assert!((squares - 34.0).abs() < 4.0 * (68.0 / f64::from(trials)).sqrt(), "{squares}");
}

#[test]
fn a_start_that_looks_away_has_no_solution() {
    let mut chance = Chance::new(4);
    let (pose, points) = (chance.pose(), chance.points(5));
    let control = chance.control(&lens(), &pose, &points, 0.0);
    let away = Pose { centre: pose.centre + (pose.centre - Point3::origin()) * -3.0, ..pose };
    assert_eq!(fit_pose(&lens(), &away, &control), Err(ApproximateError::NoSolution));
}
