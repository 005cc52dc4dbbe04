//! Noise and edges are no corners, corners are.

use std::f64::consts::TAU;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::parameter::ON_PHOTOGRAPHS;
use crate::registry::Registry;
use crate::tests::bound::noisy;
use crate::tests::junction_images::Junction;
use crate::tests::no_corners::{WIDTH, edge};
use crate::tests::quadrature_images::image;

const WINDOWS: usize = 2000;

fn measured(spec: &str, mut grey: impl FnMut(&mut ChaCha8Rng) -> Vec<f64>) -> usize {
    let operator = Registry::builtin().parse(spec).unwrap().operator.unwrap();
    let mut rng = ChaCha8Rng::seed_from_u64(81);
    let middle = Start::at(PixelPoint::new(20.0, 20.0));
    (0..WINDOWS).filter(|_| operator.measure(&image(&grey(&mut rng), WIDTH), &middle).is_ok()).count()
}

#[test]
fn noise_and_bare_edges_are_no_corners() {
    let noise = |rng: &mut ChaCha8Rng| noisy(&[0.5; WIDTH * WIDTH], 0.02, rng);
    for spec in ["forstner:window=11", "forstner:window=15", "forstner:window=15,iterations=10", "forstner:window=15,gauss=3"] {
        let tested = format!("{spec},significance={ON_PHOTOGRAPHS}");
        let (flat, edges) = (measured(&tested, noise), measured(&tested, edge));
        let (all_flat, all_edges) = (measured(spec, noise), measured(spec, edge));
        println!("{spec}: of {WINDOWS} noise {flat} ({all_flat} without the test), edges {edges} ({all_edges})");
        assert!(flat <= WINDOWS / 100 && edges <= WINDOWS / 100, "{spec}: {flat} {edges}");
    }
}

/// Corners of 60 to 120 degrees in a window of 11 px, their noise up to a tenth of the contrast: there alone some are not significant, all of them soft.
#[test]
fn corners_are_as_before() {
    let mut rng = ChaCha8Rng::seed_from_u64(82);
    let with = Registry::builtin().parse_for_photographs("forstner:window=11").unwrap().operator.unwrap();
    let without = Forstner::new(11);
    let (mut lost, mut both) = (0, 0);
    for _ in 0..60 {
        let turn = rng.random_range(0.0..TAU);
        let corner = Junction {
            position: [20.0 + rng.random_range(-0.5..0.5), 20.0 + rng.random_range(-0.5..0.5)],
            directions: vec![turn, turn + rng.random_range(60.0_f64..120.0).to_radians()],
            grey: vec![0.8, 0.2],
            blur: rng.random_range(0.3..2.0),
            gradient: [0.0; 2],
            light: [0.0; 2],
            each: Vec::new(),
            photosite: 1.0,
        };
        let grey = corner.render(WIDTH);
        for noise in [0.003, 0.012, 0.06] {
            for _ in 0..20 {
                let image = image(&noisy(&grey, noise, &mut rng), WIDTH);
                let start = Start::at(PixelPoint::new(20.0, 20.0));
                match (with.measure(&image, &start), without.measure(&image, &start)) {
                    (Ok(with), Ok(without)) => {
                        both += 1;
                        assert_eq!(with, without);
                    }
                    (Err(_), Ok(_)) => {
                        assert!(noise > 0.05, "{corner:?}, noise {noise}");
                        lost += 1;
                    }
                    (with, without) => assert_eq!(with, without),
                }
            }
        }
    }
    println!("{both} measured alike, {lost} rejected by the test");
    assert!(both >= 3000 && lost <= 30, "{both} {lost}");
}
