//! What belongs to the camera, and what to the row.

use super::*;
use crate::sensor::row_shifts;

const WELL: f64 = 1e5;

/// Two views' errors in electrons of even light of `mean` electrons.
fn two_views(of: Electrons, mean: f64) -> [Errors; 2] {
    let taken = |key| Errors::of(&expose(electrons(of), flat(SIZE, (mean / WELL) as f32), key).image, (mean + of.dark) / WELL, WELL);
    [taken(KEY), taken(Key { view: "b", trial: 5, ..KEY })]
}

fn assert_fixed(of: Electrons, mean: f64, temporal: f64, fixed: f64) {
    let [a, b] = two_views(of, mean);
    let all = temporal + fixed;
    // The law of total cumulance: where the response is high the shot noise is too.
    let third = mean + of.dark + 3.0 * (of.prnu * mean).powi(2);
    a.assert_white(all, third, third);
    let bound = 5.0 * (all * all + fixed * fixed).sqrt() / a.count().sqrt();
    let product = a.product_with(&b);
    assert!((product - fixed).abs() < bound, "what two views share: {product}, expected {fixed} +- {bound}");
}

#[test]
fn response_non_uniformity_is_the_same_in_all_views() {
    assert_fixed(Electrons { prnu: 0.01, read: 3.0, ..Electrons::of_well(WELL) }, 2e4, 2e4 + 9.0, 200.0 * 200.0);
}

/// Beside white noise the response is what it is beside electrons, pixel by pixel, and the noise lies on top.
#[test]
fn response_non_uniformity_beside_white_noise_is_the_same_pattern() {
    let (prnu, sigma, light) = (0.02, 0.01, 0.6);
    let white = |prnu, key| {
        let design = Design { exposure: 0.5, noise: Noise::White { sigma, prnu }, ..Design::default() };
        Errors::of(&expose(design, flat(SIZE, light), key).image, 0.5 * f64::from(light), 100.0)
    };
    let (a, b) = (white(prnu, KEY), white(prnu, Key { view: "b", trial: 5, ..KEY }));
    // In hundredths of full scale.
    let (temporal, fixed) = (1.0, (100.0 * prnu * 0.5 * f64::from(light)).powi(2));
    a.assert_white(temporal + fixed, 0.0, 0.0);
    let product = a.product_with(&b);
    let bound = 5.0 * (temporal + fixed) * 2_f64.sqrt() / a.count().sqrt();
    assert!((product - fixed).abs() < bound, "what two views share: {product}, expected {fixed} +- {bound}");
    let alone = Electrons { prnu, ..Electrons::of_well(1e9) };
    let pattern = Errors::of(&expose(electrons(alone), flat(SIZE, light), KEY).image, f64::from(light), 100.0);
    let (product, expected) = (pattern.product_with(&a), 2.0 * fixed);
    assert!((product - expected).abs() < 0.02 * expected, "{product}, expected {expected}");
    let design = Design { exposure: 0.5, noise: Noise::White { sigma, prnu }, ..Design::default() };
    let told = Sensor::new(design).unwrap().variance(0.5 * f64::from(light)).unwrap();
    assert!((told * 1e4 - temporal - fixed).abs() < 1e-6, "what the bound is told: {told}");
}

#[test]
fn dark_signal_non_uniformity_is_the_same_in_all_views_and_at_any_light() {
    for mean in [0.0, 500.0] {
        assert_fixed(Electrons { dsnu: 20.0, read: 10.0, ..Electrons::of_well(WELL) }, mean, mean + 100.0, 400.0);
    }
}

#[test]
fn another_camera_has_another_pattern() {
    let of = Electrons { prnu: 0.05, ..Electrons::of_well(WELL) };
    let taken = |key| Errors::of(&expose(electrons(of), flat((1000, 1000), 0.5), key).image, 0.5, WELL);
    let product = taken(KEY).product_with(&taken(Key { seed: 99, ..KEY }));
    let variance = 5e4 + 2500.0 * 2500.0;
    assert!(product.abs() < 5.0 * variance / 1e3, "{product}");
}

#[test]
fn row_noise_is_common_to_a_row_and_new_in_each_row_and_image() {
    let (row, read, rows) = (4.0, 3.0, 100_000);
    let of = Electrons { read, row, ..Electrons::of_well(WELL) };
    let taken = |key| Errors::of(&expose(electrons(of), flat((100, rows), 0.0), key).image, 0.0, WELL);
    let (a, b) = (taken(KEY), taken(Key { view: "b", ..KEY }));
    // The rows, not the pixels, are independent.
    let error = 5.0 * (row * row + read * read) / (rows as f64).sqrt();
    for (what, found, expected) in [
        ("variance", a.moment(2), row * row + read * read),
        ("within rows", a.product(1, 0), row * row),
        ("far within rows", a.product(64, 0), row * row),
        ("between rows", a.product(0, 1), 0.0),
        ("between images", a.product_with(&b), 0.0),
    ] {
        assert!((found - expected).abs() < error * 2_f64.sqrt(), "{what}: {found}, expected {expected} +- {error}");
    }
}

#[test]
fn rows_are_shifted_by_white_numbers_of_the_images_own() {
    let shifts = row_shifts(0.3, 100_000, KEY);
    let n = shifts.len() as f64;
    let variance = shifts.iter().map(|shift| shift * shift).sum::<f64>() / n;
    let neighbours = shifts.windows(2).map(|pair| pair[0] * pair[1]).sum::<f64>() / n;
    assert!((variance - 0.09).abs() < 5.0 * 0.09 * (2.0 / n).sqrt(), "{variance}");
    assert!(neighbours.abs() < 5.0 * 0.09 / n.sqrt(), "{neighbours}");
    assert_eq!(shifts[..50], row_shifts(0.3, 50, KEY)[..]);
    assert_ne!(shifts[0], row_shifts(0.3, 1, Key { view: "b", ..KEY })[0]);
}
