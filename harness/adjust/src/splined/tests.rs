use calibench_model::camera::{Camera, CameraModel, ImageSize, OpenCv, Ray, Splined};
use calibench_model::{Covariance, PixelPoint, Pose};
use nalgebra::{DMatrix, DVector, Matrix3, Point3, Rotation3, Vector3};

use super::equations::{Frame, SplinedNormals, SplinedState, SplinedStep};
use super::*;
use crate::network::{Exterior, Interior, Layout, ObjectPoint, OnSurface, Precision, Surface};
use crate::normal::Loss;
use crate::quality::Variance;
use crate::solution::Options;

const SIZE: ImageSize = ImageSize { width: 640, height: 480 };
const OPTIONS: Options = Options { huber: None, most_iterations: 100, left_out: Vec::new(), worth: crate::descent::EXACT };

fn truth(order: usize) -> Splined {
    let mut camera = Splined::flat(SIZE, [300.0, 304.0, 322.0, 238.0], order, [7, 6], 120.0);
    for (i, point) in camera.control.iter_mut().enumerate() {
        let (x, y) = ((i % 7) as f64 - 3.0, (i / 7) as f64 - 2.5);
        *point = [-2e-3 * x * (x * x + y * y), -2e-3 * y * (x * x + y * y) + 4e-3 * x.sin()];
    }
    camera
}

fn poses() -> Vec<Pose> {
    let pose = |[roll, tilt, turn, x, y, z]: [f64; 6]| {
        let rotation = *Rotation3::from_euler_angles(roll, tilt, turn).matrix();
        Pose { rotation, centre: Point3::from(-(rotation.transpose() * Vector3::new(x, y, -z))) }
    };
    [
        [0.3, 0.1, 0.05, -0.2, -0.2, 0.9],
        [-0.3, 0.4, 1.6, -0.8, 0.3, 0.8],
        [0.1, -0.5, 3.1, 0.5, 0.4, 0.7],
        [0.5, 0.2, -1.5, 0.3, 0.5, 0.8],
        [-0.4, -0.3, 0.7, -0.1, -0.6, 0.6],
        [0.2, 0.6, 2.3, 0.4, -0.3, 0.7],
    ]
    .map(pose)
    .to_vec()
}

/// Six images of a bent board of 9 x 7 points of which the camera pictures each that lies in its frame, with errors of `noise` px.
fn network(order: usize, noise: f64) -> SplinedNetwork {
    let (camera, poses, bend) = (truth(order), poses(), [0.004, -0.003, 0.0]);
    let mut network = Network {
        cameras: vec![Interior::fixed(
            "the camera",
            Camera::from(OpenCv { size: SIZE, fx: 300.0, fy: 300.0, cx: 320.0, cy: 240.0, distortion: [0.0; 14], coefficients: 5 }),
        )],
        ..Network::default()
    };
    let mut on = Vec::new();
    for k in 0..63 {
        let [u, v] = [f64::from(k % 9) / 4.0 - 1.0, f64::from(k / 9) / 3.0 - 1.0];
        network.points.push(ObjectPoint::fixed(format!("p{k}"), Point3::new(0.4 * u, 0.3 * v, 0.0)));
        let basis = Matrix3::from_columns(&[1.0 - u * u, 1.0 - v * v, u * v].map(|height| Vector3::z() * height));
        on.push(OnSurface { point: k as usize, basis });
    }
    let statuses = [Status::Free, Status::Free, Status::Fixed];
    network.surfaces = vec![Surface { name: "bend".into(), coefficients: [0.0; 3], statuses, points: on.clone() }];
    let mut random = 1_u64;
    let mut error = || {
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        noise * ((random >> 33) as f64 / f64::from(1_u32 << 30) - 1.0)
    };
    for (index, pose) in poses.iter().enumerate() {
        network.images.push(Exterior::free(format!("i{index}"), 0, *pose));
        for (k, on) in on.iter().enumerate() {
            let at = network.points[k].position + on.basis * Vector3::from(bend);
            let ray = pose.ray(&at);
            let Some(seen) = camera.cell(ray).and_then(|_| camera.project(ray).ok()) else { continue };
            if (0.0..640.0).contains(&seen.x) && (0.0..480.0).contains(&seen.y) {
                let position = PixelPoint::new(seen.x + error(), seen.y + error());
                let precision = Precision::Covariance(Covariance { sxx: 0.04, sxy: 0.01, syy: 0.02 });
                network.observations.push(ImageObservation { image: index, point: k, position, precision, behind: false });
            }
        }
    }
    assert!(network.observations.len() > 200, "{}", network.observations.len());
    let flat = Splined { control: vec![[0.0; 2]; camera.control.len()], ..camera };
    SplinedNetwork { network, camera: flat, core: [false; 4], prior: KnotPrior { along: 0.5, across: 2.0 } }
}

fn frame(network: &SplinedNetwork) -> Frame<'_> {
    Frame::new(network, Layout::new(&network.network, &[], &[]).unwrap(), Loss::Squares)
}

fn at(frame: &Frame<'_>, state: &SplinedState) -> SplinedNormals {
    let mut normals = SplinedNormals::default();
    frame.linearise(state, &mut normals).unwrap();
    normals
}

/// A step along one of all unknowns: those that are kept, then poses.
fn along(frame: &Frame<'_>, unknown: usize, by: f64) -> SplinedStep {
    let (kept, images) = (frame.free.len(), frame.of.network.images.len());
    let mut step = SplinedStep { kept: vec![0.0; kept], poses: vec![[0.0; 6]; images] };
    if unknown < kept {
        step.kept[unknown] = by;
    } else {
        step.poses.as_flattened_mut()[unknown - kept] = by;
    }
    step
}

fn state(network: &SplinedNetwork) -> SplinedState {
    SplinedState { camera: truth(network.camera.order), poses: poses(), surfaces: vec![[0.003, -0.002, 0.0]] }
}

#[test]
fn the_gradient_is_that_of_the_sum_of_squares() {
    for order in [2, 3] {
        let network = SplinedNetwork { core: [true; 4], ..network(order, 0.5) };
        let (frame, state) = (frame(&network), state(&network));
        let (normals, h) = (at(&frame, &state), 1e-6);
        let all = frame.free.len() + 6 * network.network.images.len();
        for unknown in (0..all).filter(|&unknown| frame.free.get(unknown) != Some(&false)) {
            let cost = |by: f64| at(&frame, &frame.moved(&state, &along(&frame, unknown, by))).cost;
            let slope = (cost(h) - cost(-h)) / (2.0 * h);
            let own = -2.0 * normals.along(&along(&frame, unknown, 1.0));
            assert!((slope - own).abs() < 1e-5 * (1.0 + own.abs()), "order {order}, unknown {unknown}: {slope} {own}");
        }
        assert!(normals.prior > 0.0 && normals.prior < normals.cost);
    }
}

/// The whole matrix by differences of white residuals, without elimination.
fn dense(frame: &Frame<'_>, state: &SplinedState) -> DMatrix<f64> {
    let kept = frame.free.len();
    let all = kept + 6 * frame.of.network.images.len();
    let white = |by: f64, unknown: usize| -> Vec<f64> {
        let normals = at(frame, &frame.moved(state, &along(frame, unknown, by)));
        let given = &frame.of.network.observations;
        let sights = frame.layout.sights.iter().zip(&normals.residuals);
        sights.flat_map(|(sight, residual)| sight.observed(given).precision.whitened(residual.px)).collect()
    };
    let h = 1e-6;
    let column = |unknown: usize| {
        let (after, before) = (white(h, unknown), white(-h, unknown));
        DVector::from_iterator(after.len(), after.iter().zip(&before).map(|(a, b)| (a - b) / (2.0 * h)))
    };
    let a = DMatrix::from_columns(&(0..all).map(column).collect::<Vec<_>>());
    let mut n = a.tr_mul(&a);
    for place in 0..frame.of.camera.control.len() {
        let ([xx, xy, yy], i) = (frame.of.prior.weight(&frame.of.camera, place), CORE + 2 * place);
        (n[(i, i)], n[(i + 1, i + 1)]) = (n[(i, i)] + xx, n[(i + 1, i + 1)] + yy);
        (n[(i, i + 1)], n[(i + 1, i)]) = (n[(i, i + 1)] + xy, n[(i + 1, i)] + xy);
    }
    for held in (0..kept).filter(|&i| !frame.free[i]) {
        n.row_mut(held).fill(0.0);
        n.column_mut(held).fill(0.0);
        n[(held, held)] = 1.0;
    }
    n
}

#[test]
fn cofactors_are_those_of_the_whole_matrix() {
    for core in [[false; 4], [true, true, false, true]] {
        let network = SplinedNetwork { core, prior: KnotPrior { along: 30.0, across: 100.0 }, ..network(3, 0.5) };
        let (frame, state) = (frame(&network), state(&network));
        let normals = at(&frame, &state);
        let solved = normals.eliminate(0.0).unwrap().factor(&normals).unwrap();
        let (own, kept) = (solved.cofactors(&frame), frame.free.len());
        let inverse = dense(&frame, &state).try_inverse().unwrap();
        for (i, j) in (0..kept).flat_map(|i| (0..kept).map(move |j| (i, j))).filter(|&(i, j)| frame.free[i] && frame.free[j]) {
            let bound = (inverse[(i, i)] * inverse[(j, j)]).sqrt();
            assert!((own[i * kept + j] - inverse[(i, j)]).abs() < 2e-4 * bound, "{i} {j}: {} {}", own[i * kept + j], inverse[(i, j)]);
        }
        assert!((0..kept).filter(|&i| !frame.free[i]).all(|i| own[i * (kept + 1)] == 0.0));
        // The step is that of the whole matrix.
        let all = kept + 6 * network.network.images.len();
        let right = DVector::from_fn(all, |unknown, _| normals.along(&along(&frame, unknown, 1.0)));
        let (step, whole) = (solved.step(&normals).unwrap(), &inverse * right);
        let own = step.kept.iter().chain(step.poses.as_flattened());
        let largest = whole.amax();
        assert!(own.zip(whole.iter()).all(|(own, whole)| (own - whole).abs() < 1e-4 * largest));
    }
}

/// Image coordinates less the trace of what they say of the unknowns by the inverse of all.
#[test]
fn redundancy_is_that_of_image_points() {
    let network = SplinedNetwork { prior: KnotPrior { along: 30.0, across: 100.0 }, ..network(3, 0.5) };
    let found = adjust_splined(&network, &OPTIONS).unwrap();
    let ended = found.ended();
    let (frame, none) = (frame(&ended), SplinedNetwork { prior: KnotPrior { along: 1e-9, across: 1e-9 }, ..ended.clone() });
    let state = frame.start();
    let own = frame.free.iter().enumerate().filter(|(_, free)| !**free).count() as f64;
    let all = dense(&frame, &state).try_inverse().unwrap() * dense(&self::frame(&none), &state);
    let expected = found.counts().image_coordinates as f64 - (all.trace() - own);
    let fit = found.quality(Variance::Estimated).unwrap().fit;
    let by_unknowns = found.counts().image_coordinates as f64 - found.counts().unknowns as f64;
    assert!((fit.redundancy - expected).abs() < 0.02 && expected > by_unknowns + 5.0, "{fit:?} {expected} {by_unknowns}");
    let sigma0 = ((found.cost() - found.prior_cost()) / expected).sqrt();
    assert!((fit.sigma0.unwrap() - sigma0).abs() < 1e-4 * sigma0);
}

#[test]
fn control_points_are_found_from_none() {
    for order in [2, 3] {
        let network = SplinedNetwork { prior: KnotPrior { along: 1e-2, across: 1e-1 }, ..network(order, 0.0) };
        let found = adjust_splined(&network, &OPTIONS).unwrap();
        assert!(found.cost() < 1e-2, "{} after {}", found.cost(), found.iterations());
        assert!((found.surfaces()[0][0] - 0.004).abs() < 1e-4 && (found.surfaces()[0][1] + 0.003).abs() < 1e-4);
        // What the lens does to rays is known where points lie, up to a rotation of the camera.
        let worst = found.residuals().iter().filter_map(|r| r.v).fold(0.0, |worst: f64, [x, y]| worst.max(x.hypot(y)));
        assert!(worst < 2e-3, "{worst}");
        let counts = found.counts();
        assert_eq!((counts.observed, counts.unknowns), (2 * 42, 2 * 42 + 2 + 36));
        assert_eq!(counts.redundancy(), counts.image_coordinates as i64 + 84 - 122);
    }
}

/// Of many errors the image of a ray scatters as its covariance says, once the rotation is taken off.
#[test]
fn where_points_hold_the_splines_they_are_known_and_elsewhere_not() {
    let mut network = network(3, 0.3);
    // Nothing of the right third of the frame.
    network.network.observations.retain(|o| o.position.x < 440.0);
    let found = adjust_splined(&network, &OPTIONS).unwrap();
    let quality = found.quality(Variance::Estimated).unwrap();
    let map = quality.over_frame((13, 11));
    let sigma = |place: &SplinedPlace| (place.covariance.sxx + place.covariance.syy).sqrt();
    let largest = |held: bool| map.iter().filter(|place| place.is_held == held).map(sigma).fold(0.0, f64::max);
    let inner = map.iter().filter(|place| place.is_held && (150.0..350.0).contains(&place.at.x) && (150.0..330.0).contains(&place.at.y));
    assert!(inner.clone().count() > 10 && inner.map(sigma).all(|sigma| sigma < 2.0), "{:?}", map.iter().map(sigma).collect::<Vec<_>>());
    assert!(largest(false) > 5.0 * largest(true).min(5.0), "{} {}", largest(false), largest(true));
    assert!(map.iter().filter(|place| place.at.x > 600.0).all(|place| !place.is_held));
}

#[test]
fn what_cannot_be_adjusted_is_refused() {
    let good = network(3, 0.1);
    let refused = |change: &dyn Fn(&mut SplinedNetwork)| {
        let mut network = good.clone();
        change(&mut network);
        adjust_splined(&network, &OPTIONS).map(|found| found.cost()).unwrap_err().to_string()
    };
    assert!(refused(&|n| n.camera.order = 4).contains("grid"));
    assert!(refused(&|n| n.camera.control[3][1] = f64::NAN).contains("grid"));
    assert!(refused(&|n| n.prior.along = 0.0).contains("prior"));
    assert!(refused(&|n| n.network.points[0].coordinates = [Status::Free; 3]).contains("fixed"));
    assert!(refused(&|n| n.network.observations.retain(|o| o.image != 2 || o.point < 2)).contains("i2"));
    let mut narrow = good.clone();
    narrow.camera.fov_x_deg = 60.0;
    let outside = narrow.outside();
    assert!(good.outside().len() < 3 && !outside.is_empty() && outside.iter().all(|(_, fov)| (60.0..121.0).contains(fov)), "{outside:?}");
}

#[test]
fn the_prior_is_that_of_mrcal() {
    let prior = KnotPrior::of_mrcal(37_200, 600);
    assert!((prior.along - 1.392).abs() < 5e-4 && (prior.across - 13.92).abs() < 5e-3, "{prior:?}");
    let camera = Splined::flat(SIZE, [300.0, 300.0, 320.0, 240.0], 3, [7, 5], 120.0);
    // The middle has no direction; along the row of the middle x is along.
    let near = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9);
    let (along, across) = (prior.along.powi(2), prior.across.powi(2));
    assert!(near(prior.weight(&camera, 17), [along, 0.0, along]));
    assert!(near(prior.weight(&camera, 14), [along, 0.0, across]));
    assert!(near(prior.weight(&camera, 3), [across, 0.0, along]));
}

/// An image point that is left out is missed by `(1 - H)^-1` of its residual.
#[test]
fn lengths_are_those_of_points_that_are_left_out() {
    let network = network(3, 1e-3);
    let found = adjust_splined(&network, &OPTIONS).unwrap();
    let (lengths, residuals) = (found.lengths().unwrap(), found.residuals());
    let white = |r: &crate::quality::Residual| network.network.observations[r.observation].precision.whitened(r.v.unwrap());
    let mut longer = 0.0_f64;
    for (observation, length) in lengths.iter().step_by(7) {
        let [x, y] = white(&residuals[*observation]);
        let without = found.without(&[*observation]).unwrap();
        let [ex, ey] = white(&without.residuals()[*observation]);
        let (own, square) = (length.unwrap(), x * ex + y * ey);
        assert!((own * own - square).abs() < 2e-3 * square, "{observation}: {} {square}", own * own);
        longer = longer.max(own / x.hypot(y));
    }
    assert!(longer > 1.5, "{longer}");
}

/// Of many errors the image of a far point scatters as its covariance says, once the rotation is taken off.
#[test]
fn standard_deviations_are_those_of_trials() {
    const SIGMA: f64 = 0.3;
    let places: Vec<PixelPoint> =
        (0..35).map(|k| PixelPoint::new(80.0 * f64::from(k % 7) + 80.0, 80.0 * f64::from(k / 7) + 80.0)).collect();
    let mut network = network(3, 0.0);
    let (truth, exact) = (truth(3), network.network.observations.clone());
    let seen: Vec<Ray> = exact.iter().map(|o| truth.unproject(o.position).unwrap()).collect();
    let mut random = Random(7);
    let (mut sum, mut count) = (0.0, 0.0);
    for _ in 0..60 {
        for (o, exact) in network.network.observations.iter_mut().zip(&exact) {
            o.position = PixelPoint::new(exact.position.x + SIGMA * random.normal(), exact.position.y + SIGMA * random.normal());
            o.precision = Precision::Sigma(SIGMA);
        }
        let found = adjust_splined(&network, &OPTIONS).unwrap();
        let quality = found.quality(Variance::Apriori).unwrap();
        let turn = turn_between(found.camera(), &truth, &seen);
        for place in quality.at(places.iter().copied()).iter().filter(|place| place.is_held) {
            let [x, y] = off(found.camera(), &truth, turn, truth.unproject(place.at).unwrap());
            sum += (x * x + y * y) / (place.covariance.sxx + place.covariance.syy);
            count += 1.0;
        }
    }
    let scaled = sum / count;
    assert!(count > 1000.0 && (0.85..1.18).contains(&scaled), "{scaled} of {count}");
}

/// How far the image of a far point is from that of the true camera, turned by `turn`, px.
fn off(found: &Splined, truth: &Splined, turn: Vector3<f64>, ray: Ray) -> [f64; 2] {
    let turned = Rotation3::new(turn) * Vector3::new(ray.x, ray.y, ray.z);
    let at = found.project(Ray { x: turned.x, y: turned.y, z: turned.z }).unwrap();
    let of = truth.project(ray).unwrap();
    [at.x - of.x, at.y - of.y]
}

/// The rotation that makes up for most.
fn turn_between(found: &Splined, truth: &Splined, rays: &[Ray]) -> Vector3<f64> {
    let all = |turn: Vector3<f64>| DVector::from_iterator(2 * rays.len(), rays.iter().flat_map(|ray| off(found, truth, turn, *ray)));
    let mut turn = Vector3::zeros();
    for _ in 0..4 {
        let now = all(turn);
        let columns: Vec<DVector<f64>> = (0..3).map(|k| (all(turn + 1e-6 * Vector3::ith(k, 1.0)) - &now) / 1e-6).collect();
        turn -= DMatrix::from_columns(&columns).svd(true, true).solve(&now, 1e-12).unwrap();
    }
    turn
}

/// Normal numbers after Box & Muller.
struct Random(u64);

impl Random {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as f64 + 0.5) / f64::from(1_u32 << 31)
    }

    fn normal(&mut self) -> f64 {
        (-2.0 * self.uniform().ln()).sqrt() * (std::f64::consts::TAU * self.uniform()).cos()
    }
}
