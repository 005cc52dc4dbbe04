//! Covariances, redundancy numbers, tests.

use calibench_adjust::{Attitude, Datum, Network, ObjectPoint, Options, Snooping, Solution, Test, Use, Variance, adjust, compare, snoop};
use calibench_model::camera::{Camera, CameraModel};

use crate::{networks, noise_free};

fn bundle() -> Network {
    let mut network = networks::ring_from(networks::photogrammetric(), 4.2, 9, 40, 6);
    networks::free(&mut network, &["c", "x0", "y0", "k1", "k2", "p1"]);
    networks::control(&mut network, 5, 1e-3);
    network.cameras[0] = network.cameras[0].clone().observed("c", 24.3, 0.002).unwrap();
    network.images[2].attitude = Attitude::Observed { value: network.images[2].pose.rotation, sigma: [1e-3, 2e-3, 1e-3] };
    network.images[4].centre = calibench_adjust::Centre::Observed { value: network.images[4].pose.centre, sigma: [1e-3; 3] };
    networks::shake_pixels(&mut network, 1.0, &mut networks::random(12));
    network
}

fn board() -> Network {
    let mut network = networks::board(networks::opencv(), 8, 6);
    networks::free(&mut network, &networks::FIVE);
    for i in [3, 40] {
        network.points[i] = ObjectPoint::observed(format!("{i}"), network.points[i].position, [0.5; 3]);
    }
    networks::shake_pixels(&mut network, 1.0, &mut networks::random(13));
    network
}

fn minimal() -> Network {
    Network {
        datum: Datum::Minimal { horizontal: [1, 7], vertical: [3, 11, 21] },
        ..free(&networks::ring(networks::photogrammetric(), 7, 30, 2))
    }
}

fn free(network: &Network) -> Network {
    let mut network = network.clone();
    networks::free(&mut network, &["c", "x0", "y0"]);
    networks::shake_pixels(&mut network, 0.5, &mut networks::random(14));
    network
}

fn solved(network: &Network) -> Solution<'_> {
    adjust(network, &Options::default()).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn blocks_are_those_of_the_full_covariance() {
    for network in [bundle(), board(), minimal(), noise_free::sparse()] {
        let solution = solved(&network);
        let blocks = solution.covariances(Variance::Apriori).unwrap();
        let full = solution.full_covariance(Variance::Apriori).unwrap();
        assert!((&full - full.transpose()).amax() < 1e-9 * full.amax());
        let (width, images) = (blocks.interior.nrows(), blocks.poses.len());
        let close = |a: f64, b: f64, scale: f64| assert!((a - b).abs() <= 1e-7 * scale, "{a:e} {b:e}");
        for k in 0..width * width {
            let (i, j) = (k / width, k % width);
            close(blocks.interior[(i, j)], full[(i, j)], (full[(i, i)] * full[(j, j)]).sqrt());
        }
        for (n, block) in blocks.poses.iter().enumerate() {
            for k in 0..36 {
                let (i, j) = (width + 6 * n + k / 6, width + 6 * n + k % 6);
                close(block[(k / 6, k % 6)], full[(i, j)], (full[(i, i)] * full[(j, j)]).sqrt());
            }
        }
        for (n, block) in blocks.points.iter().enumerate() {
            for k in 0..9 {
                let (i, j) = (width + 6 * images + 3 * n + k / 3, width + 6 * images + 3 * n + k % 3);
                close(block[(k / 3, k % 3)], full[(i, j)], (full[(i, i)] * full[(j, j)]).sqrt());
            }
        }
    }
}

#[test]
fn redundancy_numbers_sum_up_to_the_redundancy() {
    for network in [bundle(), board(), minimal()] {
        let solution = solved(&network);
        let reliability = solution.reliability(Test::default()).unwrap();
        let (sum, redundancy) = (reliability.redundancy(), solution.counts().redundancy() as f64);
        assert!((sum - redundancy).abs() < 1e-6 * redundancy, "{sum} for {redundancy}");
        assert_eq!(reliability.points.len(), network.observations.len());
        assert!((reliability.critical - 3.2905).abs() < 1e-4 && (reliability.noncentrality - 4.1321).abs() < 1e-4);
    }
}

#[test]
fn a_bias_of_an_observation_changes_its_residual_by_the_redundancy_number() {
    let mut network = bundle();
    let before = solved(&network);
    let reliability = before.reliability(Test::default()).unwrap();
    for k in [5, 100, 200] {
        let bias = 1e-3;
        let v = before.residuals()[k].v.unwrap();
        let mut biased = network.clone();
        biased.observations[k].position.x += bias;
        let after = solved(&biased).residuals()[k].v.unwrap();
        let expected = -bias * reliability.points[k].redundancy[0];
        assert!((after[0] - v[0] - expected).abs() < 1e-3 * bias, "{} {expected}", after[0] - v[0]);
        let w = v[0] / reliability.points[k].redundancy[0].sqrt();
        assert!((reliability.points[k].w[0] - w).abs() < 1e-9);
        let detectable = reliability.noncentrality / reliability.points[k].redundancy[0].sqrt();
        assert!((reliability.points[k].detectable[0] - detectable).abs() < 1e-9);
    }
    network.observations.truncate(0);
    assert!(adjust(&network, &Options::default()).is_err());
}

#[test]
fn blunders_are_found_and_none_disappears() {
    let mut network = bundle();
    for (k, size) in [(17, 30.0), (120, -25.0), (250, 40.0)] {
        network.observations[k].position.y += size;
    }
    let (solution, found) = snoop(&network, &Options::default(), Snooping::default()).unwrap();
    let mut left_out: Vec<usize> = found.iter().filter(|found| found.left_out).map(|found| found.observation).collect();
    left_out.sort_unstable();
    assert!([17, 120, 250].iter().all(|k| left_out.contains(k)), "{found:?}");
    assert!(left_out.len() <= 5, "{found:?}");
    assert!(found.iter().all(|found| found.w > found.critical));
    let residuals = solution.residuals();
    assert_eq!(residuals.len(), network.observations.len());
    let listed: Vec<usize> =
        residuals.iter().filter(|residual| residual.used == Use::LeftOut).map(|residual| residual.observation).collect();
    assert_eq!(listed, left_out);
    assert!((residuals[17].v.unwrap()[1].abs() - 30.0).abs() < 5.0, "{:?}", residuals[17]);
    assert_eq!(solution.counts().image_coordinates, 2 * (network.observations.len() - left_out.len()));
    let limited = Snooping { most: 1, ..Snooping::default() };
    let (_, found) = snoop(&network, &Options::default(), limited).unwrap();
    assert_eq!(found.iter().filter(|found| found.left_out).count(), 1);
    assert!(found.len() > 1, "what may not be left out is listed all the same");
}

#[test]
fn an_observation_of_no_image_is_refused_by_snooping_too() {
    let mut network = bundle();
    network.observations[5].image = network.images.len();
    assert!(snoop(&network, &Options::default(), Snooping::default()).is_err());
}

#[test]
fn huber_s_weights_hold_a_blunder_back() {
    let clean = bundle();
    let mut network = clean.clone();
    network.observations[17].position.y += 200.0;
    let truth = solved(&clean);
    let (plain, robust) = (solved(&network), adjust(&network, &Options { huber: Some(2.0), ..Options::default() }).unwrap());
    let off = |solution: &Solution| (solution.cameras()[0].parameters()[1].value - truth.cameras()[0].parameters()[1].value).abs();
    assert!(off(&robust) < 0.2 * off(&plain), "{} {}", off(&robust), off(&plain));
    let weights: Vec<_> = robust.residuals().iter().filter(|r| matches!(r.used, Use::Downweighted(_))).map(|r| r.observation).collect();
    assert!(weights.contains(&17) && weights.len() < network.observations.len() / 4, "{weights:?}");
    let Use::Downweighted(weight) = robust.residuals()[17].used else { panic!("full weight") };
    assert!((weight - 2.0 / 200.0).abs() < 2e-3, "{weight}");
}

#[test]
fn tests_tell_parameters_that_are_needed_from_others() {
    // The truth has k1, k2, p1 and p2, and no k3, b1, b2.
    let of = |camera: &Camera, change: &dyn Fn(&str, f64) -> f64| {
        camera.with_parameters(&camera.parameters().iter().map(|p| change(p.name, p.value)).collect::<Vec<_>>())
    };
    let decentred = of(&networks::photogrammetric(), &|name, value| if name.starts_with('p') { 10.0 * value } else { value });
    let network = |names: &[&str]| {
        let mut network = networks::ring_from(decentred, 4.2, 9, 60, 6);
        networks::shake_pixels(&mut network, 0.1, &mut networks::random(15));
        let start = |name: &str, value: f64| if name.starts_with('p') && !names.contains(&name) { 0.0 } else { value };
        network.cameras[0].camera = of(&decentred, &start);
        networks::free(&mut network, names);
        networks::control(&mut network, 5, 1e-3);
        network
    };
    let base = ["c", "x0", "y0", "k1", "k2"];
    let (small, right) = (network(&base), network(&[&base[..], &["p1", "p2"]].concat()));
    let large = network(&[&base[..], &["p1", "p2", "k3", "b1", "b2"]].concat());
    let (small, right, large) = (solved(&small), solved(&right), solved(&large));
    let needed = compare(&small, &right).unwrap();
    assert!(needed.more == 2 && needed.p < 1e-6 && needed.second_aic < needed.first_aic, "{needed:?}");
    let idle = compare(&right, &large).unwrap();
    assert!(idle.more == 3 && idle.p > 0.01 && idle.second_aic > idle.first_aic, "{idle:?}");
    assert!(compare(&large, &right).is_err());
    let tests = |solution: &Solution| solution.significance(&solution.covariances(Variance::Estimated).unwrap()).unwrap();
    let p = |solution: &Solution, name: &str| tests(solution).into_iter().find(|found| found.parameter == name).unwrap().p;
    assert!(["k3", "b1", "b2"].iter().all(|name| p(&large, name) > 1e-3));
    assert!(["k1", "k2", "p1", "p2"].iter().all(|name| p(&right, name) < 1e-3), "{:?}", tests(&right));
    let correlated = large.covariances(Variance::Estimated).unwrap().correlated(0.9);
    let named = |pair: [usize; 2]| pair.map(|i| large.covariances(Variance::Apriori).unwrap().parameters[i].1);
    assert!(correlated.iter().any(|found| named(found.pair) == ["k2", "k3"] && found.rho < -0.9), "{correlated:?}");
}

#[test]
fn the_same_observations_give_the_same_bits() {
    let network = bundle();
    let (a, b) = (solved(&network), solved(&network));
    assert_eq!(a.points(), b.points());
    assert_eq!(a.covariances(Variance::Estimated).unwrap(), b.covariances(Variance::Estimated).unwrap());
}
