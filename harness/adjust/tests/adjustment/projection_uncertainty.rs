//! The uncertainty of projected points, the poses held by what was measured.

use calibench_adjust::{Datum, Distance, Held, Network, Options, Solution, Uncertainty, Variance, adjust, frame_uncertainty};
use calibench_model::camera::{CameraModel, Ray};
use calibench_model::{PixelPoint, Pose};
use nalgebra::{Matrix6, Vector3, Vector6};

use super::networks;

/// A board that is seen in the left half of the frame alone.
fn left_half() -> Network {
    let mut network = networks::board(networks::opencv(), 25, 11);
    network.observations.retain(|o| o.position.x < 640.0);
    network.cameras = network.cameras.into_iter().map(|camera| camera.free(&["fx", "fy", "cx", "cy", "k1", "k2"]).unwrap()).collect();
    network
}

fn solved(network: &Network) -> Solution<'_> {
    adjust(network, &Options::default()).unwrap_or_else(|error| panic!("{error}"))
}

/// Of the noise that is drawn, px: small, for the prediction is linear.
const SIGMA: f64 = 0.1;
const PLACES: [PixelPoint; 3] = [PixelPoint { x: 200.0, y: 300.0 }, PixelPoint { x: 500.0, y: 600.0 }, PixelPoint { x: 1200.0, y: 480.0 }];

/// Where a point that was seen at a place, `depth` away, is pictured after a change of the camera and of all poses. The motion of the camera that stands
/// for theirs keeps the measured points where they are: found here by least squares over the images of `exact`, or as the mean.
fn reprojected(exact: &Solution<'_>, found: &Solution<'_>, depth: f64, held: Held) -> Vec<PixelPoint> {
    let camera = &exact.cameras()[0];
    let (mut normal, mut right) = (Matrix6::zeros(), Vector6::zeros());
    for o in &exact.network().observations {
        let (old, new, point) = (&exact.poses()[o.image], &found.poses()[o.image], &exact.points()[o.point]);
        let (before, after) = (old.ray(point), new.ray(point));
        let change = Vector3::new(after.x - before.x, after.y - before.y, after.z - before.z);
        let n = Vector3::new(before.x, before.y, before.z);
        let by = camera.derivatives(before).unwrap().by_ray;
        let slope = nalgebra::Matrix2x3::from_fn(|i, j| if held == Held::ByPoints { by[i][j] } else { f64::from(u8::from(i == j)) });
        let motion = nalgebra::Matrix3x6::from_fn(|i, j| if j < 3 { -n.cross_matrix()[(i, j)] } else { f64::from(u8::from(i + 3 == j)) });
        let a = slope * motion;
        normal += a.transpose() * a;
        right += a.transpose() * (slope * change);
    }
    let motion = if held == Held::ByPoints { normal.cholesky().unwrap().solve(&right) } else { mean(exact, found) };
    let moved = |at: &PixelPoint| {
        let ray = camera.unproject(*at).unwrap();
        let n = Vector3::new(ray.x, ray.y, ray.z) * (depth / -ray.z);
        let there = n + motion.fixed_rows::<3>(0).cross(&n) + motion.fixed_rows::<3>(3);
        found.cameras()[0].project(Ray { x: there.x, y: there.y, z: there.z }).unwrap()
    };
    PLACES.iter().map(moved).collect()
}

/// The mean over the images of rotation and shift.
fn mean(exact: &Solution<'_>, found: &Solution<'_>) -> Vector6<f64> {
    let of = |(old, new): (&Pose, &Pose)| {
        let turn = new.rotation * old.rotation.transpose();
        let shift = new.rotation * (old.centre - new.centre);
        Vector6::new(turn[(2, 1)], turn[(0, 2)], turn[(1, 0)], shift.x, shift.y, shift.z)
    };
    exact.poses().iter().zip(found.poses()).map(of).sum::<Vector6<f64>>() / exact.poses().len() as f64
}

/// Monte Carlo: what the covariance predicts is how far points are pictured away over 400 draws of noise.
#[test]
fn it_is_the_scatter_of_points_over_draws_of_the_noise() {
    let truth = left_half();
    let exact = solved(&truth);
    let mut random = networks::random(8);
    let draws: Vec<Network> = (0..400)
        .map(|_| {
            let mut noisy = truth.clone();
            networks::shake_pixels(&mut noisy, SIGMA, &mut random);
            noisy
        })
        .collect();
    for held in [Held::ByPoints, Held::ByImages] {
        let predicted = exact.projection_uncertainty(0, Variance::Apriori, &PLACES, (Distance::Near(300.0), held)).unwrap();
        let mut sums = [[0.0; 3]; 3];
        for noisy in &draws {
            for ((sum, at), there) in sums.iter_mut().zip(PLACES).zip(reprojected(&exact, &solved(noisy), 300.0, held)) {
                let (dx, dy) = (there.x - at.x, there.y - at.y);
                *sum = [sum[0] + dx * dx, sum[1] + dx * dy, sum[2] + dy * dy];
            }
        }
        for (sum, found) in sums.iter().zip(&predicted) {
            let [xx, xy, yy] = sum.map(|sum| sum / 400.0 / (SIGMA * SIGMA));
            let c = found.covariance;
            // A variance of 400 draws is known to 7 %: four of these.
            for (scatter, predicted) in [(xx, c.sxx), (yy, c.syy)] {
                assert!((scatter / predicted - 1.0).abs() < 0.28, "{held:?} {:?}: {scatter} for {predicted}", found.at);
            }
            assert!((xy - c.sxy).abs() < 0.28 * (c.sxx * c.syy).sqrt(), "{held:?} {:?}: {xy} for {}", found.at, c.sxy);
        }
    }
}

/// Evenly over the frame, a pose makes up for the camera where nothing holds it, at the cost of where it is held.
#[test]
fn what_was_not_measured_is_uncertain() {
    let network = left_half();
    let solution = solved(&network);
    let mut depths: Vec<f64> = network.observations.iter().map(|o| -solution.poses()[o.image].ray(&solution.points()[o.point]).z).collect();
    depths.sort_by(f64::total_cmp);
    let depth = Distance::Near(depths[depths.len() / 2]);
    let sigma = |found: &Uncertainty| (found.covariance.sxx + found.covariance.syy).sqrt();
    let held = solution.projection_uncertainty(0, Variance::Apriori, &PLACES, (depth, Held::ByPoints)).unwrap();
    let held: Vec<f64> = held.iter().map(sigma).collect();
    assert!(held[2] > 2.5 * held[0] && held[2] > 10.0 * held[1], "{held:?}");
    let (names, covariance) = solution.covariances(Variance::Apriori).unwrap().of_camera(0);
    let evenly = frame_uncertainty(&solution.cameras()[0], (&names, &covariance), (13, 10), depth).unwrap();
    let at = |x: f64, y: f64| evenly.iter().find(|found| found.at.distance(PixelPoint::new(x, y)) < 60.0).map(sigma).unwrap();
    assert!(held[0] < 0.7 * at(200.0, 300.0) && held[2] > 1.5 * at(1200.0, 480.0), "{held:?} {} {}", at(200.0, 300.0), at(1200.0, 480.0));
    assert!(solution.projection_uncertainty(0, Variance::Apriori, &PLACES, (Distance::Near(-1.0), Held::ByPoints)).is_err());
}

/// The frame of a free network is that of its points: the same in any datum that holds them as inner constraints do.
#[test]
fn a_free_network_is_that_of_fixed_points_when_they_are_many() {
    let mut free = networks::board(networks::opencv(), 40, 3);
    free.cameras = free.cameras.into_iter().map(|camera| camera.free(&["fx", "fy", "cx", "cy", "k1"]).unwrap()).collect();
    let fixed = free.clone();
    free.points.iter_mut().for_each(|point| *point = calibench_adjust::ObjectPoint::free(point.name.clone(), point.position));
    let minimal = Network { datum: Datum::Minimal { horizontal: [0, 53], vertical: [0, 8, 45] }, ..free.clone() };
    let inner = Network { datum: Datum::Inner, ..free };
    let (fixed, inner, minimal) = (solved(&fixed), solved(&inner), solved(&minimal));
    let sigma = |solution: &Solution<'_>| {
        let found = solution.projection_uncertainty(0, Variance::Apriori, &PLACES, (Distance::Near(300.0), Held::ByPoints)).unwrap();
        found.iter().map(|found| (found.covariance.sxx + found.covariance.syy).sqrt()).collect::<Vec<_>>()
    };
    let again = minimal.in_datum(&Datum::Inner).unwrap();
    for (a, b) in sigma(&inner).into_iter().zip(sigma(&again)) {
        assert!((a / b - 1.0).abs() < 1e-6, "{a} {b}");
    }
    // Free points cost something, and the seven coordinates of a minimal datum much more than inner constraints.
    for ((fixed, inner), minimal) in sigma(&fixed).into_iter().zip(sigma(&inner)).zip(sigma(&minimal)) {
        assert!(inner > fixed && inner < 2.0 * fixed && minimal > inner, "{fixed} {inner} {minimal}");
    }
}

/// mrcal 2.2-4 of Debian, `projection_uncertainty` (its method is `mean-pcam`), of the same 540 corners with `LENSMODEL_OPENCV5` and without regularisation.
/// It takes the mean square of all residuals for the variance; ours is over the redundancy: 1080 coordinates less 69 unknowns.
#[test]
fn by_images_it_is_that_of_mrcal() {
    const FAR: [[f64; 3]; 2] = [[1.096_820e-1, 7.495_350e-3, 1.161_223e-1], [2.323_922e2, -1.144_816e2, 5.672_153e1]];
    const NEAR: [[f64; 3]; 2] = [[1.855_493e-2, 2.000_704e-3, 2.257_406e-2], [2.331_238e2, -1.143_492e2, 5.622_349e1]];
    let mut network = networks::board(networks::opencv(), 10, 5);
    networks::shake_pixels(&mut network, 0.3, &mut networks::random(21));
    network.cameras = network.cameras.into_iter().map(|camera| camera.free(&networks::FIVE).unwrap()).collect();
    let solution = solved(&network);
    let places = [PixelPoint::new(640.0, 480.0), PixelPoint::new(1200.0, 200.0)];
    for (distance, theirs) in [(Distance::Far, FAR), (Distance::Near(300.0), NEAR)] {
        let ours = solution.projection_uncertainty(0, Variance::Estimated, &places, (distance, Held::ByImages)).unwrap();
        for (ours, theirs) in ours.iter().zip(theirs) {
            let c = ours.covariance;
            for (ours, theirs) in [c.sxx, c.sxy, c.syy].into_iter().zip(theirs) {
                assert!((ours / (theirs * 1080.0 / 1011.0) - 1.0).abs() < 2e-5, "{distance:?}: {ours} for {theirs}");
            }
        }
    }
}
