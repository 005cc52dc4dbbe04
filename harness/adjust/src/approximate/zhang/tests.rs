use calibench_model::Pose;
use calibench_model::camera::CameraModel;
use nalgebra::{Matrix3, Point3, Vector3};

use super::*;
use crate::approximate::tests::{Chance, SIZE, board, lens, pinhole};

fn values(camera: &Camera) -> Vec<f64> {
    camera.parameters().iter().take(4).map(|p| p.value).collect()
}

fn views(chance: &mut Chance, camera: &Camera, count: usize, sigma: f64) -> Vec<Vec<Control>> {
    let poses: Vec<_> = (0..count).map(|_| chance.pose_from(&Vector3::z(), 0.6)).collect();
    poses.iter().map(|pose| chance.control(camera, pose, &board(), sigma)).collect()
}

fn interior(views: &[Vec<Control>]) -> Result<PlaneInterior, ApproximateError> {
    interior_from_planes(&views.iter().map(Vec::as_slice).collect::<Vec<_>>(), SIZE)
}

fn relative(found: &Camera, truth: &Camera) -> f64 {
    values(found).iter().zip(values(truth)).map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max)
}

#[test]
fn exact_boards_give_the_exact_camera() {
    let mut chance = Chance::new(31);
    for _ in 0..50 {
        let found = interior(&views(&mut chance, &pinhole(), 6, 0.0)).unwrap();
        assert_eq!(found.assumed, Assumed::Nothing);
        assert!(relative(&found.camera, &pinhole()) < 1e-9, "{:?}", found.camera);
        assert_eq!(found.used.len(), 6);
    }
}

#[test]
fn noise_costs_little_and_distortion_not_too_much() {
    let mut chance = Chance::new(32);
    for _ in 0..20 {
        let found = interior(&views(&mut chance, &pinhole(), 15, 0.2)).unwrap();
        assert!(relative(&found.camera, &pinhole()) < 0.03, "{:?}", found.camera);
        let found = interior(&views(&mut chance, &lens(), 15, 0.2)).unwrap();
        let [fx, fy] = [values(&found.camera)[0], values(&found.camera)[1]];
        let truth = 19.2 / 5.15e-3;
        assert!((fx / truth - 1.0).abs() < 0.1 && (fy / truth - 1.0).abs() < 0.1, "{fx} {fy} {truth}");
    }
}

fn central() -> Camera {
    pinhole().with_parameters(&[[3700.0, 3700.0, 2135.5, 1423.5].as_slice(), &[0.0; 5]].concat())
}

#[test]
fn fewer_views_take_assumptions() {
    let mut chance = Chance::new(33);
    let one = interior(&views(&mut chance, &central(), 1, 0.0)).unwrap();
    assert_eq!(one.assumed, Assumed::CentreAndSquare);
    assert!(relative(&one.camera, &central()) < 1e-8, "{one:?}");
    let two = interior(&views(&mut chance, &central(), 2, 0.0)).unwrap();
    assert_eq!(two.assumed, Assumed::Centre);
    assert!(relative(&two.camera, &central()) < 1e-9, "{two:?}");
    // All views parallel to one another, tilted about one axis: no more is known than from one.
    let poses = [0.0, 0.4, -0.3].map(|x| {
        let pose = Pose::looking_at(Point3::new(0.0, -5.0, 8.0), Point3::origin(), Vector3::y(), 0.0).unwrap();
        Pose { centre: pose.centre + Vector3::new(x, x, 0.5 * x), ..pose }
    });
    let parallel: Vec<_> = poses.iter().map(|pose| chance.control(&central(), pose, &board(), 0.0)).collect();
    let found = interior(&parallel).unwrap();
    assert_ne!(found.assumed, Assumed::Nothing);
    assert!(relative(&found.camera, &central()) < 1e-8, "{found:?}");
}

#[test]
fn frontal_views_tell_nothing_and_say_so() {
    let mut chance = Chance::new(34);
    let frontal = |z: f64| Pose { rotation: Matrix3::identity(), centre: Point3::new(0.1, 0.2, z) };
    for sigma in [0.0, 0.2] {
        let views: Vec<_> = [6.0, 7.0, 8.0, 10.0].map(|z| chance.control(&pinhole(), &frontal(z), &board(), sigma)).into();
        assert_eq!(interior(&views), Err(ApproximateError::NoPerspective), "sigma {sigma}");
    }
    // A tilted view among them is enough.
    let mut mixed: Vec<_> = [6.0, 7.0].map(|z| chance.control(&central(), &frontal(z), &board(), 0.0)).into();
    mixed.push(views(&mut chance, &central(), 1, 0.0).remove(0));
    let found = interior(&mixed).unwrap();
    assert_eq!(found.used, [2]);
    assert!(relative(&found.camera, &central()) < 1e-7);
}

#[test]
fn bad_views_are_left_out_or_named() {
    let mut chance = Chance::new(35);
    let mut views = views(&mut chance, &pinhole(), 5, 0.0);
    views[1].truncate(9);
    views[3].truncate(3);
    let found = interior(&views).unwrap();
    assert_eq!(found.used, [0, 2, 4]);
    assert!(relative(&found.camera, &pinhole()) < 1e-8);
    assert!(matches!(interior(&views[3..4]), Err(ApproximateError::TooFew { .. })));
    assert_eq!(interior(&views[1..2]), Err(ApproximateError::Collinear));
    assert!(matches!(interior(&[]), Err(ApproximateError::TooFew { .. })));
}

/// The other way: Newton's iteration on the absolute conic's two conditions of each view is replaced by a search over c alone.
#[test]
fn a_search_over_the_focal_length_agrees() {
    let mut chance = Chance::new(36);
    let view = views(&mut chance, &central(), 1, 0.0).remove(0);
    let cost = |f: f64| {
        let camera = central().with_parameters(&[[f, f, 2135.5, 1423.5].as_slice(), &[0.0; 5]].concat());
        crate::approximate::planar_poses(&camera, &view).unwrap()[0].squares
    };
    let best = (0..=60).map(|i| 3400.0 + 10.0 * f64::from(i)).min_by(|a, b| cost(*a).total_cmp(&cost(*b))).unwrap();
    let found = values(&interior(&[view]).unwrap().camera)[0];
    assert!((found - best).abs() <= 5.0, "{found} {best}");
}
