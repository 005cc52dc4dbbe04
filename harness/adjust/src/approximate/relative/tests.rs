use nalgebra::{Rotation3, SVector};

use super::*;
use crate::approximate::consensus::Tolerance;
use crate::approximate::tests::{Chance, lens, pinhole, see};

const SEARCH: Search = Search { seed: 1, tolerance: Tolerance::Pixels(2.0) };

/// The pose of `b` in the axes of `a`, with a base of length one.
fn relative(a: &Pose, b: &Pose) -> Pose {
    Pose { rotation: b.rotation * a.rotation.transpose(), centre: Point3::from((a.rotation * (b.centre - a.centre)).normalize()) }
}

fn difference(a: &Pose, b: &Pose) -> f64 {
    (a.rotation - b.rotation).norm() + (a.centre - b.centre).norm()
}

fn pairs(chance: &mut Chance, cameras: [&Camera; 2], poses: [&Pose; 2], points: &[Point3<f64>], sigma: f64) -> Vec<[PixelPoint; 2]> {
    points.iter().map(|point| [0, 1].map(|i| chance.noisy(see(cameras[i], poses[i], point), sigma))).collect()
}

proptest::proptest! {
    #![proptest_config(proptest::prelude::ProptestConfig::with_cases(60))]
    #[test]
    fn exact_points_give_the_exact_orientation(seed in 0_u64..1_000_000, count in 12_usize..60) {
        let mut chance = Chance::new(seed);
        let (first, second, a, b) = (lens(), pinhole(), chance.pose(), chance.pose());
        let objects = chance.points(count);
        let points = pairs(&mut chance, [&first, &second], [&a, &b], &objects, 0.0);
        let found = orient_relatively([&first, &second], &points, &SEARCH).unwrap();
        proptest::prop_assert!(difference(&found.pose, &relative(&a, &b)) < 1e-9, "{:e}", difference(&found.pose, &relative(&a, &b)));
        proptest::prop_assert!(found.sigma0 < 1e-8 && found.redundancy == count - 5 && found.rejected.is_empty());
    }

    #[test]
    fn gross_errors_are_found(seed in 0_u64..1_000_000, unknown in proptest::bool::ANY) {
        let mut chance = Chance::new(seed);
        let (camera, a, b) = (lens(), chance.pose(), chance.pose());
        let objects = chance.points(60);
        let mut points = pairs(&mut chance, [&camera, &camera], [&a, &b], &objects, 0.2);
        for i in (0..60).step_by(5) {
            points[i][1] = PixelPoint::new(chance.between(1000.0, 3000.0), chance.between(500.0, 2500.0));
        }
        let search = Search { seed, tolerance: if unknown { Tolerance::Unknown } else { Tolerance::Pixels(1.0) } };
        let found = orient_relatively([&camera, &camera], &points, &search).unwrap();
        proptest::prop_assert!(difference(&found.pose, &relative(&a, &b)) < 0.1, "{}", difference(&found.pose, &relative(&a, &b)));
        proptest::prop_assert!(found.rejected.iter().filter(|i| *i % 5 != 0).count() <= 2, "{:?}", found.rejected);
        proptest::prop_assert!(found.sigma0 < 0.4 && found.sigma0 > 0.1, "{}", found.sigma0);
    }
}

/// Errors over their covariance follow chi-square with five degrees of freedom.
#[test]
fn the_cofactors_and_sigma0_are_honest() {
    let mut chance = Chance::new(101);
    let (camera, a, b) = (lens(), chance.pose(), chance.pose());
    let (truth, objects) = (relative(&a, &b), chance.points(25));
    let (trials, sigma) = (500, 0.3);
    let (mut distance, mut squares) = (0.0, 0.0);
    for _ in 0..trials {
        let points = pairs(&mut chance, [&camera, &camera], [&a, &b], &objects, sigma);
        let found = orient_relatively([&camera, &camera], &points, &SEARCH).unwrap();
        let turn = Rotation3::from_matrix_unchecked(truth.rotation * found.pose.rotation.transpose()).scaled_axis();
        let shift = found.base_axes.map(|axis| axis.dot(&(truth.centre - found.pose.centre)));
        let error = SVector::from([turn.x, turn.y, turn.z, shift[0], shift[1]]);
        distance += (error.transpose() * found.cofactor.try_inverse().unwrap() * error).x / (sigma * sigma) / f64::from(trials);
        squares += found.sigma0.powi(2) * found.redundancy as f64 / (sigma * sigma) / f64::from(trials);
    }
    assert!((distance - 5.0).abs() < 4.0 * (10.0 / f64::from(trials)).sqrt(), "{distance}");
    assert!((squares - 20.0).abs() < 4.0 * (40.0 / f64::from(trials)).sqrt(), "{squares}");
}

#[test]
fn the_same_seed_gives_the_same_bytes() {
    let mut chance = Chance::new(102);
    let (camera, a, b) = (lens(), chance.pose(), chance.pose());
    let objects = chance.points(20);
    let points = pairs(&mut chance, [&camera, &camera], [&a, &b], &objects, 0.5);
    let found = orient_relatively([&camera, &camera], &points, &SEARCH).unwrap();
    assert_eq!(orient_relatively([&camera, &camera], &points, &SEARCH).unwrap(), found);
}

#[test]
fn a_rotation_has_no_base() {
    let mut chance = Chance::new(103);
    let (camera, a) = (pinhole(), chance.pose());
    let b = Pose { rotation: Rotation3::new(Vector3::new(0.02, -0.03, 0.4)) * a.rotation, ..a };
    let objects = chance.points(30);
    for sigma in [0.0, 0.3] {
        let points = pairs(&mut chance, [&camera, &camera], [&a, &b], &objects, sigma);
        let found = orient_relatively([&camera, &camera], &points, &SEARCH);
        assert!(matches!(found, Err(ApproximateError::NoBase | ApproximateError::NoSolution)), "sigma {sigma}: {found:?}");
    }
}

#[test]
fn a_plane_is_oriented_and_never_ends_in_a_number_that_is_none() {
    let mut chance = Chance::new(104);
    for trial in 0..20 {
        let (camera, a) = (pinhole(), chance.pose_from(&Vector3::z(), 0.5));
        let b = chance.pose_from(&Vector3::z(), 0.5);
        let objects: Vec<_> = chance.points(30).iter().map(|p| Point3::new(p.x, p.y, 0.0)).collect();
        let points = pairs(&mut chance, [&camera, &camera], [&a, &b], &objects, 0.05);
        let found = orient_relatively([&camera, &camera], &points, &SEARCH).unwrap();
        let truth = relative(&a, &b);
        let nearest = found.rival.iter().chain([&found.pose]).map(|pose| difference(pose, &truth)).fold(f64::INFINITY, f64::min);
        assert!(nearest < 0.2, "{trial}: {nearest} {:?}", found.rival);
        assert!(found.cofactor.iter().all(|value| value.is_finite()));
    }
}

#[test]
fn what_cannot_be_oriented_is_named() {
    let mut chance = Chance::new(105);
    let (camera, a, b) = (lens(), chance.pose(), chance.pose());
    let objects = chance.points(20);
    let points = pairs(&mut chance, [&camera, &camera], [&a, &b], &objects, 0.0);
    let orient = |points: &[[PixelPoint; 2]]| orient_relatively([&camera, &camera], points, &SEARCH);
    assert!(matches!(orient(&points[..5]), Err(ApproximateError::TooFew { needed: 6, found: 5, .. })));
    assert_eq!(orient(&[points[0]; 9]), Err(ApproximateError::NoSolution));
    let mut broken = points.clone();
    broken[7][1].y = f64::NAN;
    assert_eq!(orient(&broken), Err(ApproximateError::NotFinite { index: 7 }));
    let line: Vec<_> = (0..12).map(|i| Point3::new(0.1 * f64::from(i) - 0.5, 0.1, 0.2)).collect();
    let line = pairs(&mut chance, [&camera, &camera], [&a, &b], &line, 0.0);
    assert!(orient(&line).is_err(), "{:?}", orient(&line));
}
