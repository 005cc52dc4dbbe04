//! Blocks of the inverse that are found alone are those of the whole inverse, whatever is eliminated first and however sparse the rest is.

use calibench_adjust::{Covariances, Datum, Network, Options, Status, Test, Variance, adjust};
use nalgebra::DMatrix;
use rand::RngExt;

use crate::networks;

fn shaken(mut network: Network, seed: u64) -> Network {
    networks::shake_pixels(&mut network, 0.5, &mut networks::random(seed));
    network
}

/// A strip with a camera for each tenth of its images: those of its ends see no point together.
fn cameras() -> Network {
    let mut network = networks::strip(networks::photogrammetric(), 90, 11);
    let camera = network.cameras.remove(0).free(&["c", "x0", "y0"]).unwrap();
    network.cameras = (0..10).map(|i| calibench_adjust::Interior { name: format!("camera {i}"), ..camera.clone() }).collect();
    network.images.iter_mut().enumerate().for_each(|(i, image)| image.camera = i / 9);
    networks::control(&mut network, 3, 1e-3);
    shaken(network, 1)
}

/// A strip flown twice with few points: images are eliminated, and what is left of the points is a band.
fn points_kept() -> Network {
    let mut network = networks::strip(networks::photogrammetric(), 60, 12);
    networks::free(&mut network, &["c", "x0", "y0", "k1"]);
    for mut again in network.images.clone() {
        again.name.push_str(" again");
        again.pose.centre.z += 20.0;
        network.images.push(again);
    }
    let last = network.points.len() - 24;
    let is_kept = |i: usize| i.is_multiple_of(4) || i < 24 || i >= last;
    network.points =
        std::mem::take(&mut network.points).into_iter().enumerate().filter(|(i, _)| is_kept(*i)).map(|(_, point)| point).collect();
    networks::observe(&mut network, 1.0);
    networks::control(&mut network, 4, 1e-3);
    assert!(6 * network.images.len() > 3 * network.points.len() && 3 * network.points.len() > 400);
    shaken(network, 2)
}

/// Images of a block of which each point is seen by two of three at random; those that few see are known.
fn at_random() -> Network {
    let mut network = networks::block(networks::photogrammetric(), [14, 6], [40, 20], 5);
    networks::free(&mut network, &["c", "k1"]);
    networks::control(&mut network, 9, 1e-3);
    let mut random = networks::random(8);
    network.observations.retain(|_| random.random::<f64>() < 0.67);
    let mut seen = vec![0; network.points.len()];
    network.observations.iter().for_each(|o| seen[o.point] += 1);
    let few = network.points.iter_mut().zip(seen).filter(|(_, seen)| *seen < 4);
    few.for_each(|(point, _)| point.coordinates = [Status::Fixed; 3]);
    shaken(network, 3)
}

fn board() -> Network {
    let mut network = networks::board(networks::opencv(), 12, 6);
    networks::free(&mut network, &networks::FIVE);
    shaken(network, 4)
}

/// The same with distances between points from everywhere.
fn bars(mut network: Network) -> Network {
    let count = network.points.len();
    let mut random = networks::random(9);
    for k in 0..7 {
        let points = [(k * 31) % count, (k * 67 + 11) % count];
        let [from, to] = points.map(|point| network.points[point].position);
        let (length, sigma) = ((to - from).norm(), 1e-2);
        let value = length + sigma * networks::normal(&mut random);
        network.distances.push(calibench_adjust::DistanceObservation { points, value, sigma });
    }
    network
}

fn close(found: f64, expected: f64, scale: f64) {
    assert!((found - expected).abs() <= 1e-9 * scale, "{found:e} is not {expected:e} by {scale:e}");
}

fn blocks_are_those_of(full: &DMatrix<f64>, found: &Covariances) {
    let (width, images) = (found.interior.nrows(), found.poses.len());
    let compare = |value: f64, i: usize, j: usize| close(value, full[(i, j)], (full[(i, i)] * full[(j, j)]).sqrt());
    (0..width * width).for_each(|k| compare(found.interior[(k / width, k % width)], k / width, k % width));
    for (n, block) in found.poses.iter().enumerate() {
        let first = width + 6 * n;
        (0..36).for_each(|k| compare(block[(k / 6, k % 6)], first + k / 6, first + k % 6));
    }
    for (n, block) in found.points.iter().enumerate() {
        let first = width + 6 * images + 3 * n;
        (0..9).for_each(|k| compare(block[(k / 3, k % 3)], first + k / 3, first + k % 3));
    }
}

#[test]
fn blocks_are_those_of_the_whole_inverse() {
    let ring = || {
        let mut network = networks::ring(networks::photogrammetric(), 9, 40, 6);
        networks::free(&mut network, &["c", "x0", "y0"]);
        network.datum = Datum::Minimal { horizontal: [1, 7], vertical: [3, 11, 21] };
        shaken(network, 5)
    };
    let of_bars = [bars(cameras()), bars(points_kept()), bars(at_random())];
    for network in
        [cameras(), points_kept(), at_random(), board(), ring(), shaken(networks::vosselman_foerstner(), 6)].into_iter().chain(of_bars)
    {
        for huber in [None, Some(1.0)] {
            let solution = adjust(&network, &Options { huber, ..Options::default() }).unwrap_or_else(|error| panic!("{error}"));
            let full = solution.full_covariance(Variance::Apriori).unwrap();
            let (found, reliability) = solution.quality(Variance::Apriori, Test::default()).unwrap();
            blocks_are_those_of(&full, &found);
            assert_eq!(found, solution.covariances(Variance::Apriori).unwrap());
            assert_eq!(reliability, solution.reliability(Test::default()).unwrap());
            if huber.is_none() {
                let redundancy = solution.counts().redundancy() as f64;
                close(reliability.redundancy(), redundancy, redundancy);
            }
        }
    }
}
