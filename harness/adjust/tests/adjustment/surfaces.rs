//! Boards that are bent: the shape is an unknown beside cameras and poses.

use calibench_adjust::{
    AdjustError, Datum, Exterior, Interior, Network, ObjectPoint, OnSurface, Options, Status, Surface, Test, Variance, adjust,
};
use calibench_model::camera::{Camera, CameraModel};
use nalgebra::{DMatrix, Matrix3, Point3, Vector3};

use super::networks;

const TRUTH: [f64; 3] = [1.2, -0.7, 0.4];
const NAMES: [&str; 9] = networks::FIVE;

/// Shift along Z by `1 - u^2`, `1 - v^2` and `u v`, over the board's extent.
fn basis(point: &Point3<f64>) -> Matrix3<f64> {
    let (u, v) = (point.x / 100.0 - 1.0, point.y / 62.5 - 1.0);
    Matrix3::from_rows(&[
        Vector3::zeros().transpose(),
        Vector3::zeros().transpose(),
        Vector3::new(1.0 - u * u, 1.0 - v * v, u * v).transpose(),
    ])
}

fn surface(points: &[ObjectPoint], coefficients: [f64; 3]) -> Surface {
    let points = points.iter().enumerate().filter(|(_, point)| point.coordinates == [Status::Fixed; 3]);
    let points = points.map(|(i, point)| OnSurface { point: i, basis: basis(&point.position) }).collect();
    Surface { name: "shape of the board".into(), coefficients, statuses: [Status::Free; 3], points }
}

/// A board bent by `TRUTH`, seen by two cameras together with some tie points beside it; start values are the truth but for the shape.
fn bent() -> Network {
    let mut network = networks::board(networks::opencv(), 10, 5);
    let flat = network.points.clone();
    network.points.iter_mut().for_each(|point| point.position += basis(&point.position) * Vector3::from(TRUTH));
    let tie = |k: usize| ObjectPoint::free(format!("tie {k}"), Point3::new(30.0 * k as f64, 140.0, 15.0 - 4.0 * k as f64));
    network.points.extend((0..6).map(tie));
    let second = networks::opencv().with_parameters(&networks::opencv().parameters().iter().map(|p| 1.01 * p.value).collect::<Vec<_>>());
    network.cameras.push(Interior::fixed("second", second));
    network.images.iter_mut().skip(6).for_each(|image| image.camera = 1);
    networks::observe(&mut network, 0.5);
    network.cameras = network.cameras.into_iter().map(|camera| camera.free(&NAMES).unwrap()).collect();
    network.points.iter_mut().zip(flat).for_each(|(point, flat)| point.position = flat.position);
    network.surfaces = vec![surface(&network.points, [0.0; 3])];
    network
}

fn solved(network: &Network) -> calibench_adjust::Solution<'_> {
    adjust(network, &Options::default()).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn the_shape_of_exact_data_is_found() {
    let network = bent();
    let solution = solved(&network);
    let shape = solution.surfaces().next().unwrap();
    assert!((Vector3::from(shape) - Vector3::from(TRUTH)).amax() < 1e-7, "{shape:?}");
    assert!(solution.cost() < 1e-12, "{}", solution.cost());
    for (truth, found) in network.cameras.iter().zip(solution.cameras()) {
        truth
            .camera
            .parameters()
            .iter()
            .zip(found.parameters())
            .for_each(|(a, b)| assert!((a.value - b.value).abs() < 1e-5, "{a:?} {b:?}"));
    }
    // Points are where the bent board has them, and there are no more of them than were given.
    assert_eq!(solution.points().len(), network.points.len());
    let corner = &network.points[22].position;
    assert!((solution.points()[22] - (corner + basis(corner) * Vector3::from(TRUTH))).norm() < 1e-7);
    // A flat board does not fit.
    let flat = Network { surfaces: Vec::new(), ..network.clone() };
    assert!(solved(&flat).cost() > 1.0);
    assert_eq!(solution.counts().unknowns, solved(&flat).counts().unknowns + 3);
}

/// All unknowns in the order of the full covariance without poses' axes: cameras, poses, points, shape.
fn pictured(network: &Network, change: &[f64]) -> Vec<f64> {
    let mut next = change.iter().copied();
    let mut three = || Vector3::new(next.next().unwrap(), next.next().unwrap(), next.next().unwrap());
    let mut cameras: Vec<Vec<f64>> =
        network.cameras.iter().map(|interior| interior.camera.parameters().iter().map(|parameter| parameter.value).collect()).collect();
    for values in &mut cameras {
        values[..9].chunks_mut(3).for_each(|part| part.iter_mut().zip(three().iter()).for_each(|(value, change)| *value += change));
    }
    let cameras: Vec<Camera> =
        network.cameras.iter().zip(&cameras).map(|(interior, values)| interior.camera.with_parameters(values)).collect();
    let poses: Vec<_> = network
        .images
        .iter()
        .map(|image| {
            let (shift, turn) = (three(), three());
            let rotation = *nalgebra::Rotation3::new(turn).matrix() * image.pose.rotation;
            calibench_model::Pose { rotation, centre: image.pose.centre + shift }
        })
        .collect();
    let mut points: Vec<Point3<f64>> = network.points.iter().map(|point| point.position + three()).collect();
    let shape = three();
    for on in &network.surfaces[0].points {
        points[on.point] = network.points[on.point].position + on.basis * (shape + Vector3::from(network.surfaces[0].coefficients));
    }
    let pixel = |o: &calibench_adjust::ImageObservation| {
        let camera = &cameras[network.images[o.image].camera];
        let found = camera.project(poses[o.image].ray(&points[o.point])).unwrap();
        [found.x / 0.5, found.y / 0.5]
    };
    network.observations.iter().flat_map(pixel).collect()
}

/// A second method: the inverse of dense normal equations from differences, the shape beside two cameras and tie points.
#[test]
fn covariances_are_those_of_dense_equations_by_differences() {
    let mut network = bent();
    networks::shake_pixels(&mut network, 0.5, &mut networks::random(3));
    let solution = solved(&network);
    let covariances = solution.covariances(Variance::Apriori).unwrap();
    let at = Network {
        cameras: network.cameras.iter().zip(solution.cameras()).map(|(i, camera)| Interior { camera: *camera, ..i.clone() }).collect(),
        images: network.images.iter().zip(solution.poses()).map(|(i, pose)| Exterior { pose: *pose, ..i.clone() }).collect(),
        surfaces: vec![surface(&network.points, solution.surfaces().next().unwrap())],
        points: {
            let ties = |(i, point): (usize, &ObjectPoint)| match point.coordinates {
                [Status::Free, ..] => ObjectPoint { position: solution.points()[i], ..point.clone() },
                _ => point.clone(),
            };
            network.points.iter().enumerate().map(ties).collect()
        },
        ..network.clone()
    };
    let (width, images, points) = (18, network.images.len(), network.points.len());
    let size = width + 6 * images + 3 * points + 3;
    let fixed = |k: usize| (width + 6 * images..width + 6 * images + 3 * 54).contains(&k);
    let unknown: Vec<usize> = (0..size).filter(|&k| !fixed(k)).collect();
    let slope = |k: &usize| {
        let step = if *k < width && k % 9 >= 4 { 1e-6 } else { 1e-4 };
        let moved = |sign: f64| pictured(&at, &(0..size).map(|i| if i == *k { sign * step } else { 0.0 }).collect::<Vec<_>>());
        moved(1.0).into_iter().zip(moved(-1.0)).map(|(a, b)| (a - b) / (2.0 * step)).collect::<Vec<f64>>()
    };
    let columns: Vec<_> = unknown.iter().map(slope).map(nalgebra::DVector::from_vec).collect();
    let jacobian = DMatrix::from_columns(&columns);
    let scale: Vec<f64> = jacobian.column_iter().map(|column| column.norm()).collect();
    let normal = jacobian.tr_mul(&jacobian);
    let scaled = DMatrix::from_fn(normal.nrows(), normal.ncols(), |i, j| normal[(i, j)] / (scale[i] * scale[j]));
    let inverse = scaled.cholesky().unwrap().inverse();
    let cofactor = |i: usize, j: usize| inverse[(i, j)] / (scale[i] * scale[j]);
    let close = |a: f64, i: usize, j: usize| {
        let bound = 1e-4 * (cofactor(i, i) * cofactor(j, j)).sqrt();
        assert!((a - cofactor(i, j)).abs() < bound, "{i} {j}: {a:e} {:e}", cofactor(i, j));
    };
    (0..width * width).for_each(|k| close(covariances.interior[(k / width, k % width)], k / width, k % width));
    let shape = unknown.len() - 3;
    (0..9).for_each(|k| close(covariances.surfaces[0][(k / 3, k % 3)], shape + k / 3, shape + k % 3));
    for tie in 0..6 {
        let first = shape - 18 + 3 * tie;
        (0..9).for_each(|k| close(covariances.points[54 + tie][(k / 3, k % 3)], first + k / 3, first + k % 3));
    }
    let full = solution.full_covariance(Variance::Apriori).unwrap();
    assert!((full[(size - 1, size - 1)] / covariances.surfaces[0][(2, 2)] - 1.0).abs() < 1e-7);
    assert!((full[(size - 1, 0)] / cofactor(unknown.len() - 1, 0) - 1.0).abs() < 1e-2);
    let reliability = solution.reliability(Test::default()).unwrap();
    let redundancy = solution.counts().redundancy() as f64;
    assert!((reliability.redundancy() - redundancy).abs() < 1e-6 * redundancy);
}

#[test]
fn a_coefficient_that_was_observed_is_held_and_one_that_is_fixed_stays() {
    let mut network = bent();
    network.surfaces[0].statuses = [Status::Observed { value: 0.2, sigma: 1e-6 }, Status::Free, Status::Fixed];
    let solution = solved(&network);
    let [first, _, third] = solution.surfaces().next().unwrap();
    assert!((first - 0.2).abs() < 1e-4 && third == 0.0, "{first} {third}");
    assert_eq!(solution.counts().observed, 1);
    let covariances = solution.covariances(Variance::Apriori).unwrap();
    assert!((covariances.surfaces[0][(0, 0)].sqrt() / 1e-6 - 1.0).abs() < 1e-3 && covariances.surfaces[0][(2, 2)] == 0.0);
    let reliability = solution.reliability(Test::default()).unwrap();
    assert_eq!(reliability.observed[0].what, "coefficient 1 of surface shape of the board");
    assert!((reliability.observed[0].v - (first - 0.2)).abs() < 1e-12);
}

#[test]
fn a_shape_that_no_view_shows_is_named() {
    // One view of known camera from above: height and shape cannot be told apart but by perspective; without images of the board, not at all.
    let mut network = bent();
    network
        .observations
        .retain(|o| network.points[o.point].name.starts_with("tie") || o.point == 0 || o.point == 8 || o.point == 45 || o.point == 53);
    network.cameras.iter_mut().for_each(|camera| camera.parameters.iter_mut().for_each(|status| *status = Status::Fixed));
    let error = adjust(&network, &Options::default()).map(|_| ()).unwrap_err();
    assert!(error.to_string().contains("shape of the board"), "{error}");
}

#[test]
fn what_cannot_be_a_surface_is_refused() {
    let refused = |change: &dyn Fn(&mut Network)| {
        let mut network = bent();
        change(&mut network);
        let error = adjust(&network, &Options::default()).map(|_| ()).unwrap_err();
        assert!(matches!(error, AdjustError::Network(_)), "{error:?}");
        error.to_string()
    };
    assert!(refused(&|n| n.datum = Datum::Inner).contains("makes them start values"));
    assert!(refused(&|n| n.points[3].coordinates[2] = Status::Free).contains("not fixed"));
    assert!(refused(&|n| n.surfaces[0].points[1].point = 0).contains("on a surface already"));
    assert!(refused(&|n| n.surfaces[0].points[0].point = 999).contains("refers to point 999"));
    assert!(refused(&|n| n.surfaces[0].coefficients[0] = f64::NAN).contains("not finite"));
    assert!(refused(&|n| n.surfaces[0].statuses[0] = Status::Observed { value: 0.0, sigma: 0.0 }).contains("standard deviation"));
}
