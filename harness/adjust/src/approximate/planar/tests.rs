use nalgebra::Point3;

use super::*;
use crate::approximate::tests::{Chance, apart, board, lens, pinhole};

fn tilted_board(chance: &mut Chance) -> (Vec<Point3<f64>>, Vector3<f64>) {
    let rotation = nalgebra::Rotation3::new(chance.vector());
    let shift = chance.vector() * 0.3;
    (board().iter().map(|p| rotation * p + shift).collect(), rotation * Vector3::z())
}

#[test]
fn exact_boards_in_space_give_the_exact_pose() {
    let mut chance = Chance::new(21);
    for trial in 0..300 {
        let (points, normal) = tilted_board(&mut chance);
        let pose = chance.pose_from(&normal, 0.3);
        let control = chance.control(&lens(), &pose, &points, 0.0);
        let poses = planar_poses(&lens(), &control).unwrap();
        assert!(apart(&poses[0].pose, &pose) < 1e-10, "{trial}: {:e}", apart(&poses[0].pose, &pose));
        assert!(poses.len() <= 2 && poses[0].squares < 1e-16);
        let start = planar_starts(&lens(), &control).unwrap()[0];
        assert!(apart(&start, &pose) < 1e-9, "{trial}: {:e}", apart(&start, &pose));
        assert!((start.rotation.determinant() - 1.0).abs() < 1e-12);
    }
}

/// Far away the picture is affine: a plane tilted one way looks like one tilted the other way.
#[test]
fn a_distant_plane_has_two_poses_and_both_are_given() {
    let mut chance = Chance::new(22);
    let points: Vec<_> = board().iter().map(|p| p * 0.1).collect();
    let mut truths = 0;
    for _ in 0..40 {
        let pose = Pose::looking_at(Point3::new(5.0, 1.0, 9.0), Point3::origin(), Vector3::y(), chance.between(-3.0, 3.0)).unwrap();
        let control = chance.control(&pinhole(), &pose, &points, 0.3);
        let poses = planar_poses(&pinhole(), &control).unwrap();
        assert_eq!(poses.len(), 2);
        assert!(poses[1].squares < 1.5 * poses[0].squares);
        truths += usize::from(poses.iter().any(|found| apart(&found.pose, &pose) < 0.3));
    }
    assert_eq!(truths, 40);
}

/// The other way: three corners at a time, and the best of all.
#[test]
fn three_point_poses_agree() {
    let mut chance = Chance::new(23);
    for _ in 0..30 {
        let (points, normal) = tilted_board(&mut chance);
        let pose = chance.pose_from(&normal, 0.4);
        let control = chance.control(&lens(), &pose, &points, 0.2);
        let planar = &planar_poses(&lens(), &control).unwrap()[0];
        let corners = [control[0], control[8], control[49]];
        let fits = crate::approximate::poses_of_three(&lens(), &corners).unwrap();
        let fits = fits.iter().filter_map(|start| fit_pose(&lens(), start, &control).ok());
        let best = fits.min_by(|a, b| a.squares.total_cmp(&b.squares)).unwrap();
        assert!(apart(&best.pose, &planar.pose) < 1e-7, "{:e}", apart(&best.pose, &planar.pose));
    }
}

#[test]
fn straight_on_there_is_one_pose() {
    let pose = Pose { rotation: Matrix3::identity(), centre: Point3::new(0.0, 0.0, 8.0) };
    let control = Chance::new(24).control(&pinhole(), &pose, &board(), 0.0);
    let poses = planar_poses(&pinhole(), &control).unwrap();
    assert!(apart(&poses[0].pose, &pose) < 1e-7);
    assert!(poses.iter().all(|found| found.pose.rotation.iter().all(|value| value.is_finite())));
}

#[test]
fn what_is_no_plane_is_named() {
    let mut chance = Chance::new(25);
    let pose = chance.pose();
    let points = chance.points(9);
    let control = chance.control(&pinhole(), &pose, &points, 0.0);
    assert_eq!(planar_poses(&pinhole(), &control), Err(ApproximateError::NotCoplanar));
    let line: Vec<_> = (0..5).map(|i| Point3::new(f64::from(i) * 0.1, 0.0, 0.0)).collect();
    let control = chance.control(&pinhole(), &pose, &line, 0.0);
    assert_eq!(planar_poses(&pinhole(), &control), Err(ApproximateError::Collinear));
    assert!(matches!(planar_poses(&pinhole(), &control[..3]), Err(ApproximateError::TooFew { .. })));
}
