//! Without noise the truth comes back.

use calibench_adjust::{Network, Options, adjust};
use calibench_model::camera::{Camera, CameraModel};

use crate::networks;

/// Adjusts `network`, whose values are the truth, from shaken ones.
fn comes_back(truth: &Network, shift: f64, turn: f64) {
    let mut start = truth.clone();
    networks::shake_start(&mut start, shift, turn, 5);
    let solution = adjust(&start, &Options::default()).unwrap_or_else(|error| panic!("{error}"));
    assert!(solution.sigma0().is_some_and(|sigma0| sigma0 < 1e-9), "{:?}", solution.sigma0());
    for (found, truth) in solution.cameras().iter().zip(&truth.cameras) {
        for (found, truth) in found.parameters().iter().zip(truth.camera.parameters()) {
            let off = (found.value - truth.value).abs();
            assert!(off <= 1e-10 * truth.value.abs().max(1e-6), "{}: {} for {}", found.name, found.value, truth.value);
        }
    }
    let extent = truth.images.iter().map(|image| image.pose.centre.coords.norm()).fold(0.0, f64::max);
    for (found, truth) in solution.poses().iter().zip(&truth.images) {
        assert!((found.centre - truth.pose.centre).norm() <= 1e-10 * extent);
        assert!((found.rotation - truth.pose.rotation).amax() <= 1e-10);
    }
    for (found, truth) in solution.points().iter().zip(&truth.points) {
        assert!((found - truth.position).norm() <= 1e-10 * extent);
    }
}

fn board(camera: Camera, names: &[&str]) -> Network {
    let mut network = networks::board(camera, 12, 3);
    networks::free(&mut network, names);
    network
}

#[test]
fn boards_with_every_model() {
    for (camera, names) in networks::cameras() {
        // A plane board does not tell Ebner's affinity from its tilt well enough for so few images: the others are free.
        comes_back(&board(camera, &names), 5.0, 0.02);
    }
}

#[test]
fn bundles_with_every_model() {
    for (camera, names) in networks::cameras() {
        // Near enough that points fill the frame: k3 acts at its edge.
        let mut network = networks::ring_from(camera, 4.0, 12, 60, 4);
        networks::free(&mut network, &names);
        networks::control(&mut network, 6, 1e-3);
        comes_back(&network, 0.02, 0.005);
    }
}

#[test]
fn covariances_of_observations_and_several_cameras() {
    let mut network = networks::ring(networks::photogrammetric(), 12, 60, 4);
    network.cameras.push(network.cameras[0].clone());
    network.images.iter_mut().skip(7).for_each(|image| image.camera = 1);
    network.cameras = network.cameras.into_iter().map(|camera| camera.free(&["c", "x0", "y0", "k1"]).unwrap()).collect();
    let covariance = calibench_model::Covariance { sxx: 0.04, sxy: 0.01, syy: 0.09 };
    network.observations.iter_mut().for_each(|o| o.precision = calibench_adjust::Precision::Covariance(covariance));
    networks::control(&mut network, 6, 1e-3);
    comes_back(&network, 0.02, 0.005);
}

#[test]
fn more_views_than_board_points_eliminate_views_even_if_the_board_is_free() {
    let mut network = networks::board(networks::opencv(), 40, 3);
    networks::free(&mut network, &networks::FIVE);
    for i in [3, 11, 27, 40] {
        network.points[i] = calibench_adjust::ObjectPoint::free(format!("{i}"), network.points[i].position);
    }
    comes_back(&network, 2.0, 0.01);
}

#[test]
fn from_afar() {
    let mut network = networks::ring(networks::photogrammetric(), 10, 50, 4);
    networks::free(&mut network, &["c", "x0", "y0", "k1"]);
    networks::control(&mut network, 4, 1e-3);
    comes_back(&network, 0.3, 0.1);
    comes_back(&board(networks::opencv(), &networks::FIVE), 40.0, 0.15);
}

#[test]
fn a_sparse_network() {
    let network = sparse();
    comes_back(&network, 0.3, 0.003);
}

/// A strip of images of which each overlaps few others.
pub fn sparse() -> Network {
    let mut network = networks::strip(networks::photogrammetric(), 90, 11);
    networks::free(&mut network, &["c", "x0", "y0", "k1"]);
    networks::control(&mut network, 5, 1e-2);
    network
}
