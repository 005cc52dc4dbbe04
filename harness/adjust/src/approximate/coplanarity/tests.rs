use super::*;
use crate::approximate::least_squares::minimise;
use crate::approximate::tests::{Chance, lens, pinhole, see};

fn case(chance: &mut Chance, cameras: [&Camera; 2], sigma: f64) -> (Motion, Pair) {
    let (a, b, point) = (chance.pose(), chance.pose(), chance.point());
    let base = (a.rotation * (b.centre - a.centre)).normalize();
    let motion = Motion { rotation: b.rotation * a.rotation.transpose(), base };
    let pixels = [chance.noisy(see(cameras[0], &a, &point), sigma), chance.noisy(see(cameras[1], &b, &point), sigma)];
    (motion, Pair::of(cameras, pixels).unwrap())
}

#[test]
fn the_nearest_rays_are_coplanar_and_nearest() {
    let mut chance = Chance::new(91);
    let (first, second) = (lens(), pinhole());
    let cameras = [&first, &second];
    for _ in 0..100 {
        let (motion, pair) = case(&mut chance, cameras, 2.0);
        let near = nearest(cameras, &motion, &pair).unwrap();
        let [q1, q2] = near.rays;
        assert!(motion.condition(&q1, &q2).0.abs() < 1e-14, "{:e}", motion.condition(&q1, &q2).0);
        // The residual stands across the condition: along it, nothing is nearer.
        for direction in 0..4 {
            let shifted = |h: f64| {
                let step = Vector4::ith(direction, h);
                let at = [
                    PixelPoint::new(pair.pixels[0].x + near.residual.x + step.x, pair.pixels[0].y + near.residual.y + step.y),
                    PixelPoint::new(pair.pixels[1].x + near.residual.z + step.z, pair.pixels[1].y + near.residual.w + step.w),
                ];
                let [a, b] = Pair::of(cameras, at).unwrap().rays();
                motion.condition(&a, &b).0
            };
            // The gradient of the condition by finite differences is parallel to the residual.
            let gradient = (shifted(1e-3) - shifted(-1e-3)) / 2e-3;
            let expected = near.residual[direction] / near.residual.norm() / near.weight;
            assert!((gradient.abs() - expected.abs()).abs() < 1e-6 * near.weight.recip().abs(), "{gradient} {expected}");
        }
        let first_order = sampson(&motion, &pair, &slopes(cameras, &pair).unwrap());
        assert!((first_order.sqrt() / near.residual.norm() - 1.0).abs() < 0.01);
    }
}

#[test]
fn rows_are_differences() {
    let mut chance = Chance::new(92);
    let (first, second) = (lens(), pinhole());
    let cameras = [&first, &second];
    for _ in 0..50 {
        let (motion, pair) = case(&mut chance, cameras, 0.5);
        let signed = |motion: &Motion| nearest(cameras, motion, &pair).map(|near| near.residual.norm() * near.weight.signum()).unwrap();
        let near = nearest(cameras, &motion, &pair).unwrap();
        let row = motion.by_unknowns(&near.rays[0], &near.rays[1]) * -near.weight.abs();
        for k in 0..5 {
            let at = |h: f64| signed(&motion.moved(&SVector::<f64, 5>::ith(k, h)));
            let difference = (at(1e-6) - at(-1e-6)) / 2e-6;
            assert!((row[k] - difference).abs() < 1e-4 * row.norm(), "{k}: {} {difference}", row[k]);
        }
    }
}

/// The other way: the point in space whose pictures are nearest.
#[test]
fn the_best_point_in_space_has_the_same_residuals() {
    let mut chance = Chance::new(93);
    let camera = lens();
    for _ in 0..50 {
        let (motion, pair) = case(&mut chance, [&camera, &camera], 1.0);
        let near = nearest([&camera, &camera], &motion, &pair).unwrap();
        let poses = [
            calibench_model::Pose { rotation: Matrix3::identity(), centre: nalgebra::Point3::origin() },
            calibench_model::Pose { rotation: motion.rotation, centre: motion.base.into() },
        ];
        let sights = [0, 1].map(|i| crate::approximate::Sight { camera: &camera, pose: &poses[i], image: pair.pixels[i] });
        let Ok(found) = crate::approximate::intersect(&sights, 0.0, None) else { continue };
        assert!((found.sigma0 - near.residual.norm()).abs() < 1e-8, "{} {}", found.sigma0, near.residual.norm());
    }
}

#[test]
fn many_exact_pairs_lead_back_to_the_motion() {
    let mut chance = Chance::new(94);
    let camera = lens();
    let cameras = [&camera, &camera];
    let (a, b) = (chance.pose(), chance.pose());
    let truth = Motion { rotation: b.rotation * a.rotation.transpose(), base: (a.rotation * (b.centre - a.centre)).normalize() };
    let pairs: Vec<_> = chance.points(30).iter().map(|p| Pair::of(cameras, [see(&camera, &a, p), see(&camera, &b, p)]).unwrap()).collect();
    let start = truth.moved(&SVector::from([0.02, -0.01, 0.02, 0.03, -0.02]));
    let (found, sums) = minimise(start, |motion| normal(cameras, motion, pairs.iter()), Motion::moved).unwrap();
    assert!((found.rotation - truth.rotation).norm() < 1e-11 && (found.base - truth.base).norm() < 1e-11);
    assert!(sums.squares < 1e-18 && sums.redundancy() == 25);
}
