use calibench_model::camera::Camera;
use nalgebra::DMatrix;

use super::*;
use crate::approximate::tests::{Chance, lens, pinhole, see};
use crate::approximate::{Search, Tolerance, orient_relatively};
use crate::network::{Exterior, ImageObservation, Interior, Network, ObjectPoint, Status};
use crate::solution::{Options, adjust};
use crate::{AdjustError, Variance};

const SEARCH: Search = Search { seed: 1, tolerance: Tolerance::Pixels(5.0) };

fn pairs(chance: &mut Chance, cameras: [&Camera; 2], count: usize, sigma: f64) -> (Vec<[PixelPoint; 2]>, [Pose; 2], Vec<Point3<f64>>) {
    let poses = [chance.pose(), chance.pose()];
    let objects = chance.points(count);
    let pair = |point: &Point3<f64>| [0, 1].map(|i| chance.noisy(see(cameras[i], &poses[i], point), sigma));
    (objects.iter().map(pair).collect(), poses, objects)
}

/// The pair as a bundle whose scale a fixed coordinate of the first point holds.
fn bundle(cameras: [&Camera; 2], points: &[[PixelPoint; 2]], found: &RelativeOrientation) -> Network {
    let identity = Pose { rotation: Matrix3::identity(), centre: Point3::origin() };
    let images = vec![Exterior::fixed("left", 0, identity), Exterior::free("right", 1, found.pose)];
    let object = |pair: &[PixelPoint; 2]| ObjectPoint::free("", found.model_point(cameras, *pair, 1e-6).unwrap().position);
    let mut objects: Vec<ObjectPoint> = points.iter().map(object).collect();
    objects[0].coordinates[2] = Status::Fixed;
    let observation = |i: usize, image: usize| ImageObservation::new(image, i, points[i][image], 1.0);
    Network {
        cameras: vec![Interior::fixed("left", *cameras[0]), Interior::fixed("right", *cameras[1])],
        images,
        points: objects,
        observations: (0..points.len()).flat_map(|i| [observation(i, 0), observation(i, 1)]).collect(),
        ..Network::default()
    }
}

/// A second method: the bundle of all unknowns, its scale taken off afterwards.
#[test]
fn orientation_and_points_are_those_of_a_bundle() -> Result<(), AdjustError> {
    let mut chance = Chance::new(201);
    let (first, second) = (lens(), pinhole());
    let cameras = [&first, &second];
    let (points, ..) = pairs(&mut chance, cameras, 15, 0.4);
    let found = orient_relatively(cameras, &points, &SEARCH).unwrap();
    assert!(found.rejected.is_empty());
    let network = bundle(cameras, &points, &found);
    let solution = adjust(&network, &Options::default())?;
    assert_eq!(solution.counts().redundancy(), found.redundancy as i64);
    assert!((solution.sigma0().unwrap() / found.sigma0 - 1.0).abs() < 1e-8, "{} {}", solution.sigma0().unwrap(), found.sigma0);
    let full = solution.full_covariance(Variance::Apriori)?;
    let base = solution.poses()[1].centre.coords;
    let length = base.norm();
    assert!((base / length - found.pose.centre.coords).norm() < 1e-7);
    // d(X / b) = dX / b - X (B . dB) / b^3; the unknowns of the second image start at row 6, those of the points at row 12.
    let divided = |at: Vector3<f64>, row: usize| {
        let mut by = DMatrix::zeros(3, full.nrows());
        for i in 0..3 {
            by[(i, row + i)] += 1.0 / length;
            (0..3).for_each(|j| by[(i, 6 + j)] -= at[i] * base[j] / length.powi(3));
        }
        &by * &full * by.transpose()
    };
    let same = |a: &DMatrix<f64>, b: &DMatrix<f64>| (a - b).norm() <= 1e-5 * b.norm();
    for (i, pair) in points.iter().enumerate() {
        let point = found.model_point(cameras, *pair, 1e-6).unwrap();
        let at = solution.points()[i].coords;
        assert!((at / length - point.position.coords).norm() < 1e-6, "{i}");
        let cofactor = DMatrix::from_fn(3, 3, |r, c| point.cofactor[(r, c)]);
        assert!(same(&cofactor, &divided(at, 12 + 3 * i)), "{i}: {cofactor} {}", divided(at, 12 + 3 * i));
    }
    let pose = found.pose_cofactor();
    assert!(same(&DMatrix::from_fn(3, 3, |r, c| pose[(r, c)]), &divided(base, 6)));
    assert!(same(&DMatrix::from_fn(3, 3, |r, c| pose[(3 + r, 3 + c)]), &full.view((9, 9), (3, 3)).into_owned()));
    Ok(())
}

/// Analytic truth: without noise the model is the object in the first camera's axes, divided by the base.
#[test]
fn exact_pairs_give_the_exact_model() {
    let mut chance = Chance::new(202);
    let camera = lens();
    let (points, [a, b], objects) = pairs(&mut chance, [&camera, &camera], 20, 0.0);
    let found = orient_relatively([&camera, &camera], &points, &SEARCH).unwrap();
    let base = (b.centre - a.centre).norm();
    for (pair, object) in points.iter().zip(&objects) {
        let point = found.model_point([&camera, &camera], *pair, 1e-6).unwrap();
        assert!((point.position.coords - a.rotation * (object - a.centre) / base).norm() < 1e-8);
    }
}

/// A property: over many trials the errors of a point follow its covariance, d^2 has three degrees of freedom.
#[test]
fn the_points_cofactors_are_honest() {
    let mut chance = Chance::new(203);
    let camera = lens();
    let (exact, [a, b], objects) = pairs(&mut chance, [&camera, &camera], 20, 0.0);
    let base = (b.centre - a.centre).norm();
    let (trials, sigma) = (400, 0.3);
    let mut mean = 0.0;
    for _ in 0..trials {
        let points: Vec<_> = exact.iter().map(|pair| pair.map(|pixel| chance.noisy(pixel, sigma))).collect();
        let found = orient_relatively([&camera, &camera], &points, &SEARCH).unwrap();
        let point = found.model_point([&camera, &camera], points[7], 1e-6).unwrap();
        let error = point.position.coords - a.rotation * (objects[7] - a.centre) / base;
        mean += (error.transpose() * point.cofactor.try_inverse().unwrap() * error).x / (sigma * sigma) / f64::from(trials);
    }
    assert!((mean - 3.0).abs() < 4.0 * (6.0 / f64::from(trials)).sqrt(), "{mean}");
}

#[test]
fn a_point_at_infinity_is_named() {
    let (mut chance, camera) = (Chance::new(204), pinhole());
    let at = |x: f64| Pose { rotation: Matrix3::identity(), centre: Point3::new(x, 0.0, 6.0) };
    let (a, b, objects) = (at(0.0), at(1.0), chance.points(20));
    let points: Vec<_> = objects.iter().map(|point| [see(&camera, &a, point), see(&camera, &b, point)]).collect();
    let found = orient_relatively([&camera, &camera], &points, &SEARCH).unwrap();
    // Two parallel cameras picture what is infinitely far away in one place.
    let far = PixelPoint::new(2000.0, 1300.0);
    let answer = found.model_point([&camera, &camera], [far, far], 1e-4);
    assert!(matches!(answer, Err(ApproximateError::Parallel { .. })), "{answer:?}");
}
