use nalgebra::{Matrix4, RowVector4};

use super::*;
use crate::approximate::consensus::Tolerance;
use crate::approximate::shape::ascending;
use crate::approximate::tests::{Chance, lens, pinhole, see};

fn sights<'a>(chance: &mut Chance, camera: &'a Camera, poses: &'a [Pose], point: &Point3<f64>, sigma: f64) -> Vec<Sight<'a>> {
    poses.iter().map(|pose| Sight { camera, pose, image: chance.noisy(see(camera, pose, point), sigma) }).collect()
}

proptest::proptest! {
    #[test]
    fn exact_rays_meet_in_the_point(seed in 0_u64..1_000_000, count in 2_usize..8) {
        let mut chance = Chance::new(seed);
        let (camera, point) = (lens(), chance.point());
        let poses: Vec<_> = (0..count).map(|_| chance.pose()).collect();
        let found = intersect(&sights(&mut chance, &camera, &poses, &point, 0.0), 0.01, None);
        let largest = largest_angle(&poses.iter().map(|pose| (point - pose.centre).normalize()).collect::<Vec<_>>());
        proptest::prop_assume!(largest > 0.02);
        let found = found.unwrap();
        proptest::prop_assert!((found.point - point).norm() < 1e-9);
        proptest::prop_assert!((found.angle - largest).abs() < 1e-9);
        proptest::prop_assert!(found.redundancy == 2 * count - 3 && found.sigma0 < 1e-8);
    }

    #[test]
    fn one_wrong_sight_is_found(seed in 0_u64..1_000_000, wrong in 0_usize..6) {
        let mut chance = Chance::new(seed);
        let (camera, point) = (lens(), chance.point());
        let poses: Vec<_> = (0..6).map(|_| chance.pose()).collect();
        let mut sights = sights(&mut chance, &camera, &poses, &point, 0.2);
        sights[wrong].image.y += 80.0;
        sights[wrong].image.x -= 80.0;
        let search = Search { seed, tolerance: Tolerance::Pixels(1.5) };
        let found = intersect(&sights, 0.0, Some(&search)).unwrap();
        proptest::prop_assert_eq!(&found.rejected, &[wrong]);
        proptest::prop_assert!((found.point - point).norm() < 0.02);
    }
}

/// The linear intersection in homogeneous coordinates.
fn linear(sights: &[Sight<'_>]) -> Point3<f64> {
    let mut normal = Matrix4::zeros();
    for sight in sights {
        let (x, y) = sight.camera.unproject(sight.image).unwrap().tangent().unwrap();
        let m = &sight.pose.rotation;
        let t = -(m * sight.pose.centre.coords);
        let row = |i: usize| RowVector4::new(m[(i, 0)], m[(i, 1)], m[(i, 2)], t[i]);
        for row in [row(0) + row(2) * x, row(1) + row(2) * y] {
            normal += row.transpose() * row;
        }
    }
    let p = ascending(normal).1.column(0).into_owned();
    Point3::new(p[0] / p[3], p[1] / p[3], p[2] / p[3])
}

#[test]
fn the_homogeneous_solution_agrees() {
    let mut chance = Chance::new(71);
    let camera = pinhole();
    for _ in 0..50 {
        let (point, poses) = (chance.point(), [chance.pose(), chance.pose(), chance.pose(), chance.pose()]);
        let exact = sights(&mut chance, &camera, &poses, &point, 0.0);
        assert!((linear(&exact) - intersect(&exact, 0.0, None).unwrap().point).norm() < 1e-9);
        let noisy = sights(&mut chance, &camera, &poses, &point, 0.3);
        let found = intersect(&noisy, 0.0, None).unwrap();
        let sigma = found.cofactor.trace().sqrt() * 0.3;
        assert!((linear(&noisy) - found.point).norm() < 2.0 * sigma);
    }
}

#[test]
fn the_cofactors_are_honest() {
    let mut chance = Chance::new(72);
    let (camera, point, poses) = (lens(), chance.point(), [chance.pose(), chance.pose(), chance.pose()]);
    let (trials, sigma) = (4000, 0.4);
    let (mut distance, mut squares) = (0.0, 0.0);
    for _ in 0..trials {
        let found = intersect(&sights(&mut chance, &camera, &poses, &point, sigma), 0.0, None).unwrap();
        let error = found.point - point;
        distance += error.dot(&(found.cofactor.try_inverse().unwrap() * error)) / (sigma * sigma) / f64::from(trials);
        squares += 3.0 * found.sigma0.powi(2) / (sigma * sigma) / f64::from(trials);
    }
    let bound = 4.0 * (6.0 / f64::from(trials)).sqrt();
    assert!((distance - 3.0).abs() < bound && (squares - 3.0).abs() < bound, "{distance} {squares}");
}

#[test]
fn rays_that_do_not_meet_are_named() {
    let mut chance = Chance::new(73);
    let (camera, point) = (pinhole(), Point3::new(0.2, 0.1, 0.0));
    let pose = Pose::looking_at(Point3::new(0.0, 0.0, 8.0), Point3::origin(), Vector3::y(), 0.0).unwrap();
    let turned = Pose { rotation: nalgebra::Rotation3::new(Vector3::new(0.01, 0.0, 0.2)) * pose.rotation, ..pose };
    // One place: whatever the noise, the rays tell nothing of the distance.
    for sigma in [0.0, 0.5] {
        let poses = [pose, turned];
        let found = intersect(&sights(&mut chance, &camera, &poses, &point, sigma), 0.0, None);
        assert!(matches!(found, Err(ApproximateError::Parallel { .. })), "{found:?}");
    }
    let beside = [pose, Pose { centre: pose.centre + Vector3::new(0.02, 0.0, 0.0), ..pose }];
    let near = sights(&mut chance, &camera, &beside, &point, 0.0);
    assert!(intersect(&near, 0.0, None).is_ok());
    let angle = 0.5_f64.to_radians();
    assert!(matches!(intersect(&near, angle, None), Err(ApproximateError::Parallel { angle_deg }) if angle_deg > 0.1 && angle_deg < 0.2));
    // Crossed pictures: the rays part before the cameras and meet behind.
    let parting =
        [Sight { image: near[1].image, ..near[0] }, Sight { image: PixelPoint::new(near[0].image.x + 40.0, near[0].image.y), ..near[1] }];
    assert!(matches!(intersect(&parting, 0.0, None), Err(ApproximateError::Behind { .. })));
    assert!(matches!(intersect(&near[..1], 0.0, None), Err(ApproximateError::TooFew { needed: 2, found: 1, .. })));
    let broken = [near[0], Sight { image: PixelPoint::new(f64::NAN, 0.0), ..near[1] }];
    assert_eq!(intersect(&broken, 0.0, None), Err(ApproximateError::NotFinite { index: 1 }));
}
