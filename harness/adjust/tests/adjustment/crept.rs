//! Blocks of a bent stand under noise: down a bent valley where damped steps creep.

use calibench_adjust::{Network, Options, adjust};

use crate::networks::{normal, random};
use crate::stands::{Sets, block};

/// The block of eight sets with noise of `sigma` px.
fn noisy(seed: u64, sigma: f64) -> Network {
    let (mut network, mut random) = (block(0.8, Sets::Eight), random(seed));
    for observation in &mut network.observations {
        observation.position.x += sigma * normal(&mut random);
        observation.position.y += sigma * normal(&mut random);
    }
    network
}

fn converges(seed: u64, sigma: f64) {
    let solution = adjust(&noisy(seed, sigma), &Options::default());
    let solution = solution.unwrap_or_else(|error| panic!("{seed}, {sigma} px: {error}"));
    let sigma0 = solution.sigma0().unwrap();
    assert!((sigma0 / sigma - 1.0).abs() < 0.1, "{seed}, {sigma} px: {sigma0}");
}

/// Three times the errors of the paper's recordings.
#[test]
fn blocks_of_eight_sets_converge_under_noise() {
    (0..40).for_each(|seed| converges(seed, 0.1));
}

/// Nine times the noise: from where damped steps have crept to, undamped ones find the way.
#[test]
fn what_creeps_looks_ahead() {
    for seed in [16, 17, 21, 25, 27, 28] {
        converges(seed, 0.3);
    }
}
