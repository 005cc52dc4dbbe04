use calibench_model::PixelPoint;
use nalgebra::Point3;

use nalgebra::Vector3;

use super::*;
use crate::approximate::fit_pose;
use crate::approximate::tests::{Chance, apart, board, lens, pinhole};

proptest::proptest! {
    #[test]
    fn exact_points_give_the_exact_pose(seed in 0_u64..1_000_000, count in 5_usize..40) {
        let mut chance = Chance::new(seed);
        let (pose, points) = (chance.pose(), chance.points(count));
        let control = chance.control(&lens(), &pose, &points, 0.0);
        let found = resect(&lens(), &control, None).unwrap();
        proptest::prop_assert!(apart(&found.pose, &pose) < 1e-9, "{:e}", apart(&found.pose, &pose));
        proptest::prop_assert!(found.rejected.is_empty() && found.redundancy == 2 * count - 6);
    }

    #[test]
    fn gross_errors_are_found(seed in 0_u64..1_000_000, unknown in proptest::bool::ANY) {
        let mut chance = Chance::new(seed);
        let (pose, points) = (chance.pose(), chance.points(30));
        let mut control = chance.control(&lens(), &pose, &points, 0.2);
        let wrong: Vec<usize> = (0..30).step_by(4).collect();
        wrong.iter().for_each(|&i| control[i].image = PixelPoint::new(control[i].image.x + chance.between(15.0, 900.0), 700.0));
        let tolerance = if unknown { Tolerance::Unknown } else { Tolerance::Pixels(1.2) };
        let found = resect(&lens(), &control, Some(&Search { seed, tolerance })).unwrap();
        proptest::prop_assert!(wrong.iter().all(|i| found.rejected.contains(i)), "{:?}", found.rejected);
        proptest::prop_assert!(found.rejected.len() <= wrong.len() + 2, "{:?}", found.rejected);
        proptest::prop_assert!(apart(&found.pose, &pose) < 5e-3, "{:e}", apart(&found.pose, &pose));
        proptest::prop_assert!(found.sigma0 > 0.1 && found.sigma0 < 0.35, "{}", found.sigma0);
    }
}

/// The other way: the direct linear transformation of exact pictures, of a camera without distortion.
#[test]
fn the_direct_linear_transformation_agrees() {
    let mut chance = Chance::new(61);
    for _ in 0..30 {
        let (pose, points) = (chance.pose(), chance.points(15));
        let control = chance.control(&pinhole(), &pose, &points, 0.0);
        let found = resect(&pinhole(), &control, None).unwrap();
        let other = crate::approximate::direct_linear(&control, crate::approximate::tests::SIZE, 5.0, None).unwrap();
        assert!(apart(&found.pose, &other.pose) < 1e-8);
    }
}

#[test]
fn a_board_gets_its_best_pose_and_the_other() {
    let mut chance = Chance::new(62);
    let small: Vec<_> = board().iter().map(|p| p * 0.1).collect();
    for _ in 0..20 {
        let pose = Pose::looking_at(Point3::new(4.0, 2.0, 8.0), Point3::origin(), Vector3::y(), 0.3).unwrap();
        let control = chance.control(&pinhole(), &pose, &small, 0.3);
        let found = resect(&pinhole(), &control, None).unwrap();
        let rival = found.rival.unwrap();
        let squares = found.sigma0.powi(2) * found.redundancy as f64;
        assert!(squares <= rival.squares);
        let planar = crate::approximate::planar_poses(&pinhole(), &control).unwrap();
        assert!((planar[0].squares - squares).abs() < 1e-9 * squares);
    }
}

#[test]
fn the_same_seed_gives_the_same_bytes() {
    let mut chance = Chance::new(63);
    let (pose, points) = (chance.pose(), chance.points(20));
    let control = chance.control(&lens(), &pose, &points, 0.5);
    let search = Search { seed: 9, tolerance: Tolerance::Unknown };
    assert_eq!(resect(&lens(), &control, Some(&search)), resect(&lens(), &control, Some(&search)));
}

#[test]
fn what_cannot_be_resected_is_named() {
    let mut chance = Chance::new(64);
    let (pose, points) = (chance.pose(), chance.points(10));
    let control = chance.control(&pinhole(), &pose, &points, 0.0);
    assert!(matches!(resect(&pinhole(), &control[..3], None), Err(ApproximateError::TooFew { needed: 4, found: 3, .. })));
    let line: Vec<_> = (0..6).map(|i| Point3::new(0.1 * f64::from(i), 0.2, 0.0)).collect();
    let on_line = chance.control(&pinhole(), &pose, &line, 0.0);
    assert_eq!(resect(&pinhole(), &on_line, None), Err(ApproximateError::Collinear));
    let mut broken = control.clone();
    broken[2].object.y = f64::INFINITY;
    assert_eq!(resect(&pinhole(), &broken, None), Err(ApproximateError::NotFinite { index: 2 }));
    // Pictures of other points altogether.
    let search = Search { seed: 1, tolerance: Tolerance::Pixels(0.5) };
    let scattered: Vec<_> = control.iter().map(|c| Control { object: chance.point(), ..*c }).collect();
    assert!(matches!(resect(&pinhole(), &scattered, Some(&search)), Err(ApproximateError::NoConsensus { .. })));
    let same: Vec<_> = control.iter().map(|c| Control { image: control[0].image, ..*c }).collect();
    assert!(resect(&pinhole(), &same, None).is_err());
}

/// Three points of which one is measured twice: all their poses fit, and that is said.
#[test]
fn three_points_and_a_repeated_one_have_a_rival() {
    let mut chance = Chance::new(65);
    let mut rivals = 0;
    for _ in 0..50 {
        let (pose, mut points) = (chance.pose(), chance.points(3));
        points.push(points[0]);
        let control = chance.control(&pinhole(), &pose, &points, 0.0);
        let poses = crate::approximate::poses_of_three(&pinhole(), &[control[0], control[1], control[2]]).unwrap();
        let Ok(found) = resect(&pinhole(), &control, None) else { continue };
        assert!(found.sigma0 < 1e-6);
        assert_eq!(found.rival.is_some(), poses.len() > 1, "{}", poses.len());
        rivals += usize::from(found.rival.is_some());
    }
    assert!(rivals > 40, "{rivals}");
}

/// On the cylinder over the circle of three points the pose can move a little while the points stay: no cofactor, or one that says so.
#[test]
fn the_danger_cylinder_is_seen() {
    let corners = [[1.0, 0.0], [-0.5, 0.75_f64.sqrt()], [-0.5, -(0.75_f64.sqrt())], [1.0, 0.0]].map(|[x, y]| Point3::new(x, y, 0.0));
    let mut chance = Chance::new(66);
    let mut seen_from = |x: f64, y: f64| {
        let pose = Pose::looking_at(Point3::new(x, y, 6.0), Point3::origin(), Vector3::y(), 0.0).unwrap();
        let control = chance.control(&pinhole(), &pose, &corners, 0.0);
        fit_pose(&pinhole(), &pose, &control).unwrap().cofactor.map(|cofactor| cofactor.fixed_view::<3, 3>(3, 3).trace().sqrt())
    };
    let beside = seen_from(1.2, 1.6).unwrap();
    assert!(seen_from(0.6, 0.8).is_none_or(|on_cylinder| on_cylinder > 1e4 * beside));
}
