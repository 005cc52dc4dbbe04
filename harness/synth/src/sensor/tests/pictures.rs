//! Demosaic, gamma, output levels and JPEG.

use super::*;
use crate::sensor::{ColourFilter, Demosaic, DemosaicTo, Gamma, Pattern, through_jpeg};

const PATTERNS: [Pattern; 4] = [Pattern::Rggb, Pattern::Bggr, Pattern::Grbg, Pattern::Gbrg];

fn mosaic(pattern: Pattern, to: DemosaicTo, white_balance: Option<[f64; 3]>) -> Design {
    let filter = Some(ColourFilter { pattern, sensitivity: [0.45, 1.0, 0.62] });
    Design { filter, demosaic: Some(Demosaic { to, white_balance }), ..Design::default() }
}

#[test]
fn flat_grey_stays_flat_and_what_it_was() {
    for (pattern, to) in PATTERNS.into_iter().flat_map(|p| [(p, DemosaicTo::Grey), (p, DemosaicTo::Green)]) {
        for size in [(8, 6), (7, 5), (2, 2), (1, 4), (1, 1)] {
            let taken = expose(mosaic(pattern, to, None), flat(size, 0.6), KEY);
            assert!(taken.image.grey().iter().all(|grey| (grey - 0.6).abs() < 2e-7), "{:?}", taken.image);
        }
        let levels = Design { converter: Some(16), output: Some(8), ..mosaic(pattern, to, None) };
        let taken = expose(levels, flat((9, 9), 0.6), KEY);
        assert!(taken.image.grey().iter().all(|&grey| grey == 153.0 / 255.0), "{:?}", taken.image);
    }
}

#[test]
fn a_ramp_is_interpolated_without_error_inside() {
    let ramp = Image::from_fn(20, 16, |x, y| 0.1 + 0.02 * x as f32 + 0.03 * y as f32);
    for (pattern, to) in PATTERNS.into_iter().flat_map(|p| [(p, DemosaicTo::Grey), (p, DemosaicTo::Green)]) {
        let taken = expose(mosaic(pattern, to, None), ramp.clone(), KEY).image;
        for (x, y) in (1..15).flat_map(|y| (1..19).map(move |x| (x, y))) {
            assert!((taken.at(x, y) - ramp.at(x, y)).abs() < 5e-7, "{pattern:?} {to:?} ({x}, {y})");
        }
    }
}

#[test]
fn without_balance_the_grey_is_the_weighted_sum_of_the_sensitivities() {
    let taken = expose(mosaic(Pattern::Rggb, DemosaicTo::Grey, Some([1.0; 3])), flat((8, 8), 0.5), KEY);
    let expected = 0.5 * (0.299 * 0.45 + 0.587 + 0.114 * 0.62);
    assert!(taken.image.grey().iter().all(|&grey| (f64::from(grey) - expected).abs() < 1e-7));
}

#[test]
fn the_black_level_is_taken_away_before_colours_are_balanced() {
    let of = Electrons { black_level: 256.0, read: 1.0, ..Electrons::of_well(1e8) };
    let design = Design { converter: Some(16), noise: Noise::Electrons(of), ..mosaic(Pattern::Rggb, DemosaicTo::Grey, None) };
    for light in [0.0, 0.5] {
        let taken = expose(design.clone(), flat((100, 100), light), KEY).image;
        let mean = taken.grey().iter().map(|&grey| f64::from(grey)).sum::<f64>() / 1e4;
        assert!((mean - f64::from(light)).abs() < 2e-5, "{light}: {mean}");
    }
}

#[test]
fn gamma_goes_there_and_back() {
    for gamma in [Gamma::Power(2.2), Gamma::Power(0.45), Gamma::Srgb] {
        for i in 0..=1000 {
            let light = f64::from(i) / 1000.0;
            assert!((gamma.decode(gamma.encode(light)) - light).abs() < 1e-12, "{gamma:?} {light}");
        }
    }
    // Middle grey of 18 % is level 118 of sRGB, half the light 188.
    let level = |light| (255.0 * Gamma::Srgb.encode(light)).round();
    assert_eq!([level(0.18), level(0.5)], [118.0, 188.0]);
    let knee = Gamma::Srgb.encode(0.003_130_8 + 1e-9) - Gamma::Srgb.encode(0.003_130_8);
    assert!(knee.abs() < 1e-7, "{knee}");
}

#[test]
fn gamma_is_applied_to_the_image() {
    let light = Image::new(4, 1, vec![-0.1, 0.25, 1.0, 1.5]);
    let taken = expose(Design { gamma: Some(Gamma::Power(2.0)), ..Design::default() }, light, KEY);
    assert_eq!(taken.image.grey(), [0.0, 0.5, 1.0, 1.0]);
    assert_eq!((taken.clipped.low, taken.clipped.high), (1, 1));
}

#[test]
fn a_veil_is_light_that_exposure_leaves_alone_and_a_filter_does_not() {
    let light = || Image::new(2, 1, vec![0.25, 0.5]);
    let veiled = |veil: f64, filter: Option<ColourFilter>| Design { exposure: 0.5, veil, filter, ..Design::default() };
    assert_eq!(expose(veiled(-0.25, None), light(), KEY).image.grey(), [-0.125, 0.0]);
    let filter = ColourFilter { pattern: Pattern::Rggb, sensitivity: [0.5, 1.0, 1.0] };
    assert_eq!(expose(veiled(0.125, Some(filter)), light(), KEY).image.grey(), [0.125, 0.375]);
    let sensor = Sensor::new(veiled(0.125, None)).unwrap();
    assert_eq!(sensor.mean(0.5), Some(0.375));
}

#[test]
fn the_output_has_its_levels() {
    for (bits, top) in [(8, 255.0), (12, 4095.0), (16, 65535.0)] {
        let light = Image::from_fn(256, 4, |x, y| (x as f32 + 0.3 * y as f32) / 256.0);
        let taken = expose(Design { output: Some(bits), ..Design::default() }, light.clone(), KEY).image;
        for (grey, light) in taken.grey().iter().zip(light.grey()) {
            assert!((grey * top - (grey * top).round()).abs() < 0.01 && (grey - light).abs() <= 0.501 / top, "{bits}");
        }
    }
}

#[test]
fn jpeg_of_quality_100_errs_as_cut_coefficients_do() {
    // The encoder cuts coefficients, which it has in eighths, to whole numbers (mean square 140/512), and the decoder rounds pixels (1/12). In a pixel, 64
    // coefficients of at most 7/8 add up to 8 times that.
    let noise = Design { noise: Noise::White { sigma: 0.1, prnu: 0.0 }, converter: Some(8), ..Design::default() };
    let taken = expose(noise, flat((203, 157), 0.5), KEY).image;
    let again = through_jpeg(taken.clone(), 100).unwrap();
    let errors = || taken.grey().iter().zip(again.grey()).map(|(a, b)| 255.0 * f64::from(a - b));
    let rms = (errors().map(|error| error * error).sum::<f64>() / (203.0 * 157.0)).sqrt();
    assert!(rms < 1.02 * (140.0_f64 / 512.0 + 1.0 / 12.0).sqrt(), "{rms}");
    assert!(errors().all(|error| error.abs() < 7.5));
    let coarse = through_jpeg(taken.clone(), 50).unwrap();
    let worse = taken.grey().iter().zip(coarse.grey()).map(|(a, b)| 255.0 * f64::from((a - b).abs())).fold(0.0, f64::max);
    assert!(worse > 7.5, "{worse}");
}

#[test]
fn jpeg_leaves_even_grey_alone() {
    let taken = expose(Design { jpeg: Some(75), ..Design::default() }, flat((64, 40), 0.5), KEY).image;
    assert!(taken.grey().iter().all(|&grey| (grey * 255.0 - 127.5).abs() < 1.6), "{}", taken.at(0, 0) * 255.0);
    assert!(through_jpeg(flat((65_536, 1), 0.5), 75).is_err());
}
