//! A set of EMVA parameters, or a ratio in decibel, gives the signal-to-noise ratio that it states.

use super::*;

/// A machine-vision sensor in 12 bits: K = 0.38 DN/e-, black level 64 DN.
const CAMERA: Electrons = Electrons {
    full_well: 10_500.0,
    at_white: 10_000.0,
    prnu: 0.0,
    dark: 5.0,
    dsnu: 0.0,
    read: 2.4,
    row: 0.0,
    gain: Some(0.38),
    black_level: 64.0,
};

/// Grey values over one period of the levels.
const PHASES: u32 = 34;

/// Signal-to-noise ratio of a pixel whose mean is `grey`: the signal above the dark one, to the standard deviation from image to image; `None` without noise.
fn snr(sensor: &Sensor, grey: f64) -> Option<f64> {
    let sigma = sensor.scatter(grey, false)?.sqrt();
    (sigma > 0.0).then(|| (grey - sensor.mean(0.0).unwrap_or(0.0)) / sigma)
}

#[test]
fn the_snr_follows_emvas_curve_within_a_hundredth() {
    let design = Design { converter: Some(12), ..electrons(CAMERA) };
    let sensor = Sensor::new(design).unwrap();
    let dark = 64.0 + 0.38 * 5.0;
    for signal in [20.0, 120.0, 1000.0, 9000.0] {
        let taken = sensor.expose(flat((1000, 1000), (signal / 1e4) as f32), KEY).unwrap();
        let grey = sensor.mean(signal / 1e4).unwrap();
        let errors = Errors::of(&taken.image, grey, 4095.0);
        let (mean, sigma) = (4095.0 * grey + errors.moment(1), errors.moment(2).sqrt());
        // Eq. 12 of release 4.0: sigma_d^2 = sigma_d0^2 + mu_d, sigma_q^2 = 1/12.
        let theory = signal / (2.4_f64.powi(2) + 5.0 + 1.0 / (12.0 * 0.38 * 0.38) + signal).sqrt();
        let measured = (mean - dark) / sigma;
        assert!((measured / theory - 1.0).abs() < 0.01, "{signal}: {measured} {theory}");
        assert!((snr(&sensor, grey).unwrap() / theory - 1.0).abs() < 1e-9, "{signal}");
        assert!((mean - dark - 0.38 * signal).abs() < 5.0 * sigma / 1e3, "{signal}: {mean}");
    }
}

#[test]
fn the_stated_variance_is_that_of_ten_million_pixels() {
    let all = Electrons { prnu: 0.008, dsnu: 1.5, ..CAMERA };
    for (converter, output) in [(12, None), (8, None), (12, Some(8)), (14, Some(12))] {
        // A gain that leaves the noise wider than half a step: quantisation is then noise of a twelfth.
        let gain = Some(0.38 * 2_f64.powi(converter as i32 - 12) * if converter == 8 { 2.0 } else { 1.0 });
        let black_level = 2_f64.powi(converter as i32 - 6);
        let design = Design { converter: Some(converter), output, ..electrons(Electrons { gain, black_level, ..all }) };
        let sensor = Sensor::new(design).unwrap();
        // From 4095 to 255 levels every seventeenth bin is a level wider, which a single grey value sees: the mean over such a period is stated.
        let (mut found, mut stated) = (0.0, 0.0);
        for phase in 0..PHASES {
            let light = (0.2 + f64::from(phase) / f64::from(PHASES) * 273.0 / 0.38 / 1e4) as f32;
            let grey = sensor.mean(f64::from(light)).unwrap();
            let taken = sensor.expose(flat((600, 500), light), Key { trial: u64::from(phase), view: "v", ..KEY }).unwrap();
            found += Errors::of(&taken.image, grey, 1.0).moment(2);
            stated += sensor.variance(grey).unwrap();
            assert_eq!(taken.clipped, crate::sensor::Clipped::default());
        }
        let n = f64::from(PHASES) * 3e5;
        // The patterns, at most this part of the variance, are the same in all phases: they have the error of one.
        let fixed = 0.17;
        let error = (2.0 / n).sqrt() + fixed * (2.0_f64 / 3e5).sqrt();
        assert!((found / stated - 1.0).abs() < 5.0 * error, "{converter} {output:?}: {found:e} {stated:e}");
    }
}

#[test]
fn decibels_are_of_what_the_key_names() {
    // Targets of 0.2 and 0.8 at 26 dB of contrast; a mean of 0.5 at 40 dB.
    for (signal, decibel, low, high) in [(0.6, 26.0, 0.2, 0.8), (0.5, 40.0, 0.5, 0.5)] {
        let design = Design { noise: Noise::white_below(signal, decibel, 0.0), ..Design::default() };
        let errors = |light: f32| Errors::of(&expose(design.clone(), flat((1000, 1000), light), KEY).image, 0.0, 1.0);
        let (dark, light) = (errors(low), errors(high));
        let sigma = (light.moment(2) - light.moment(1).powi(2)).sqrt();
        let measured = if low < high { light.moment(1) - dark.moment(1) } else { light.moment(1) } / sigma;
        assert!((20.0 * measured.log10() - decibel).abs() < 20.0 * 1.01_f64.log10(), "{measured}");
    }
}

#[test]
fn no_variance_is_stated_where_more_than_the_grey_value_counts() {
    let plain = electrons(CAMERA);
    let plain = Design { converter: Some(12), ..plain };
    assert!(Sensor::new(plain.clone()).unwrap().variance(0.5).is_some());
    let rows = electrons(Electrons { row: 1.0, ..CAMERA });
    for design in [
        Design { jpeg: Some(90), ..plain.clone() },
        Design { gamma: Some(crate::sensor::Gamma::Srgb), ..plain },
        Design { converter: Some(12), ..rows },
    ] {
        assert!(Sensor::new(design).unwrap().variance(0.5).is_none());
    }
    assert!(snr(&Sensor::new(Design::default()).unwrap(), 0.5).is_none(), "no noise, no ratio");
}
