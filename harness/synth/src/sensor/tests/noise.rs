//! Mean, variance, skewness and autocorrelation of the temporal noise over ten million pixels.

use super::*;
use crate::sensor::electrons::COUNTED;

#[test]
fn electrons_and_read_noise_add_up_at_any_light() {
    // Counted, at the border between counting and drawing, drawn.
    for mean in [0.0, 0.4, 7.3, 60.0, f64::from(COUNTED) - 0.5, f64::from(COUNTED) + 0.5, 300.0, 5000.0] {
        let (well, read) = (1e4, 2.0);
        let design = electrons(Electrons { read, ..Electrons::of_well(well) });
        let exposure = expose(design, flat(SIZE, (mean / well) as f32), KEY);
        Errors::of(&exposure.image, mean / well, well).assert_white(mean + read * read, mean, mean);
        assert_eq!(exposure.clipped.high, 0);
    }
}

#[test]
fn shot_noise_alone_is_poisson() {
    for mean in [0.7, 90.0, 250.0] {
        let exposure = expose(electrons(Electrons::of_well(1e4)), flat((2000, 1000), (mean / 1e4) as f32), KEY);
        let whole = |&grey: &f32| (f64::from(grey) * 1e4 - (f64::from(grey) * 1e4).round()).abs() < 1e-3;
        assert!(exposure.image.grey().iter().all(whole), "electrons are whole");
        Errors::of(&exposure.image, mean / 1e4, 1e4).assert_white(mean, mean, mean);
    }
}

#[test]
fn the_dark_signal_has_shot_noise_and_a_mean() {
    let design = electrons(Electrons { dark: 40.0, read: 3.0, ..Electrons::of_well(1e4) });
    let exposure = expose(design, flat(SIZE, 0.0), KEY);
    Errors::of(&exposure.image, 0.004, 1e4).assert_white(49.0, 40.0, 40.0);
}

#[test]
fn white_noise_is_white_and_stays_where_exposure_put_it() {
    let design = Design { exposure: 0.5, noise: Noise::White { sigma: 0.01, prnu: 0.0 }, ..Design::default() };
    let exposure = expose(design, flat(SIZE, 0.8), KEY);
    Errors::of(&exposure.image, f64::from(0.8_f32) / 2.0, 100.0).assert_white(1.0, 0.0, 0.0);
}

#[test]
fn the_converter_adds_a_twelfth_of_a_squared_step() {
    // A signal of 2 DN noise falls anywhere between the levels.
    let design = Design { converter: Some(8), noise: Noise::White { sigma: 2.0 / 255.0, prnu: 0.0 }, ..Design::default() };
    let exposure = expose(design, flat(SIZE, 0.4), KEY);
    let levels = |&grey: &f32| f64::from(grey) * 255.0;
    assert!(exposure.image.grey().iter().map(levels).all(|level| (level - level.round()).abs() < 1e-4));
    Errors::of(&exposure.image, f64::from(0.4_f32), 255.0).assert_white(4.0 + 1.0 / 12.0, 0.0, 0.0);
}

#[test]
fn no_two_images_share_their_noise() {
    let design = || electrons(Electrons { read: 3.0, ..Electrons::of_well(1e4) });
    let errors = |key| Errors::of(&expose(design(), flat((1000, 1000), 0.5), key).image, 0.5, 1e4);
    let first = errors(KEY);
    for other in [Key { view: "b", ..KEY }, Key { trial: 1, ..KEY }, Key { seed: 21, ..KEY }, Key { of: "another", ..KEY }] {
        let product = first.product_with(&errors(other));
        assert!(product.abs() < 5.0 * 5009.0 / 1e3, "{product}");
    }
}
