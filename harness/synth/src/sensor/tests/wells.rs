//! What is clipped is counted, each pixel once.

use statrs::distribution::{ContinuousCDF, DiscreteCDF, Normal, Poisson};

use super::*;
use crate::sensor::Clipped;

#[test]
fn levels_outside_are_counted_exactly() {
    let step = 1.0 / 255.0;
    let greys = vec![-1.0, -0.51 * step, -0.49 * step, 0.0, 0.5, 1.0, 1.0 + 0.49 * step, 1.0 + 0.51 * step, 2.0];
    let light = Image::new(9, 1, greys);
    let converted = expose(Design { converter: Some(8), ..Design::default() }, light.clone(), KEY);
    assert_eq!(converted.clipped, Clipped { low: 2, high: 2 });
    assert_eq!(converted.image.grey()[..4], [0.0; 4]);
    assert_eq!(converted.image.grey()[5..], [1.0; 4]);
    // Without a converter the output's levels clip; without either nothing does.
    assert_eq!(expose(Design { output: Some(8), ..Design::default() }, light.clone(), KEY).clipped, converted.clipped);
    let open = expose(Design::default(), light.clone(), KEY);
    assert_eq!((open.image, open.clipped), (light, Clipped::default()));
}

#[test]
fn a_full_well_counts_once_though_the_converter_is_at_its_top_too() {
    for converter in [None, Some(8), Some(12)] {
        for read in [0.0, 30.0] {
            let design = Design { converter, ..electrons(Electrons { read, ..Electrons::of_well(1e4) }) };
            let taken = expose(design, flat((100, 50), 10.0), KEY);
            assert_eq!(taken.clipped.high, 5000, "{converter:?} {read}");
        }
    }
}

#[test]
fn wells_overflow_as_often_as_poisson_says() {
    // 1000.5: no whole number of electrons is the brim itself, so that a grey value of 1 is a clipped one.
    let well = 1000.5;
    let poisson = |mean: f64| Poisson::new(mean).unwrap().sf(1000);
    for read in [0.0, 0.6] {
        for mean in [950.0, 1000.0, 1060.0] {
            let design = electrons(Electrons { read, ..Electrons::of_well(well) });
            let taken = expose(design, flat((1000, 1000), (mean / well) as f32), KEY);
            let (n, p) = (1e6, poisson(mean));
            let bound = 5.0 * (n * p * (1.0 - p)).sqrt();
            assert!((taken.clipped.high as f64 - n * p).abs() < bound, "{mean}, read {read}: {} {}", taken.clipped.high, n * p);
            if read == 0.0 {
                let full = taken.image.grey().iter().filter(|&&grey| grey == 1.0).count();
                assert_eq!(full as u64, taken.clipped.high);
            }
        }
    }
}

#[test]
fn read_noise_is_clipped_below_black_as_often_as_it_falls_there() {
    let design = Design { converter: Some(12), ..electrons(Electrons { read: 5.0, ..Electrons::of_well(1e4) }) };
    let taken = expose(design, flat(SIZE, 0.0), KEY);
    let n = 1e7;
    let p = Normal::standard().cdf(-0.5 / (5.0 * 4095.0 / 1e4));
    let bound = 5.0 * (n * p * (1.0 - p)).sqrt();
    assert!((taken.clipped.low as f64 - n * p).abs() < bound, "{} {}", taken.clipped.low, n * p);
    assert_eq!(taken.clipped.high, 0);
}

#[test]
fn the_brim_has_the_mean_and_variance_of_a_clipped_poisson() {
    let (well, mean) = (5000.0, 5020.0);
    let design = electrons(Electrons { read: 3.0, ..Electrons::of_well(well) });
    let taken = expose(design, flat((2000, 1000), (mean / well) as f32), KEY);
    let theory = Poisson::new(mean).unwrap();
    let kept = |power: i32| {
        let below = (4000..5000).map(|k| statrs::distribution::Discrete::pmf(&theory, k) * (k as f64 - well).powi(power));
        below.sum::<f64>()
    };
    let (first, second) = (kept(1), kept(2) + 9.0);
    let errors = Errors::of(&taken.image, 1.0, well);
    let variance = second - first * first;
    assert!((errors.moment(1) - first).abs() < 5.0 * (variance / errors.count()).sqrt(), "{} {first}", errors.moment(1));
    assert!((errors.moment(2) / second - 1.0).abs() < 5.0 * (5.0 / errors.count()).sqrt(), "{} {second}", errors.moment(2));
}
