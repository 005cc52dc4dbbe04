//! Tables to sensors, and mistakes at their keys.

use calibench_model::PixelPoint;
use calibench_synth::sensor::{Design, FallOff, Gamma, Noise, Per, Processing, Sensor};
use schemars::schema_for;
use toml::de::DeTable;

use super::*;

const AROUND: Surroundings = Surroundings {
    principal_distance: Some(3000.0),
    principal_point: Some(PixelPoint { x: 99.0, y: 77.0 }),
    contrast: Some(0.7),
    mean: Some(0.5),
};

fn read_in(text: &str, around: &Surroundings) -> (Option<SensorSetup>, Vec<Problem>) {
    let table = DeTable::parse(text).unwrap();
    let section = Section { name: "[sensor]", span: 0..0, table: table.into_inner() };
    let mut problems = Vec::new();
    let setup = read_sensor(section, around, &mut problems);
    assert_eq!(setup.is_some(), problems.is_empty(), "{problems:?}");
    (setup, problems)
}

fn design(text: &str) -> Design {
    let (setup, problems) = read_in(text, &AROUND);
    setup.unwrap_or_else(|| panic!("{text}: {problems:?}")).sensor.design().clone()
}

#[test]
fn an_empty_table_passes_light_on() {
    let (setup, _) = read_in("", &AROUND);
    assert_eq!(setup, Some(SensorSetup { sensor: Sensor::new(Design::default()).unwrap(), row_jitter: 0.0 }));
}

#[test]
fn every_key_reaches_its_stage() {
    let text = "
        vignetting = [-0.3, 0.1, 0]
        gradient_across = [0.1, -0.2]
        exposure = 0.9
        filter = 'gbrg'
        filter_sensitivity = [0.5, 1, 0.6]
        full_well = 10500
        photons = 20000
        quantum_efficiency = 0.5
        prnu = 0.8
        dark_current = 50.0
        exposure_time = 0.02
        dsnu = 1.5
        read_noise = 2.4
        row_noise = 0.3
        gain = 0.38
        black_level = 64
        adc_bits = 12
        demosaic = 'green'
        white_balance = [2, 1, 1.7]
        gamma = 2.2
        bits = 8
        jpeg_quality = 95
        row_jitter = 0.05";
    let (setup, problems) = read_in(text, &AROUND);
    let setup = setup.unwrap_or_else(|| panic!("{problems:?}"));
    let design = setup.sensor.design();
    let Noise::Electrons(electrons) = design.noise else { panic!("{design:?}") };
    assert_eq!((electrons.full_well, electrons.at_white, electrons.dark), (10500.0, 10000.0, 1.0));
    assert!((electrons.prnu - 0.008).abs() < 1e-15);
    assert_eq!((electrons.dsnu, electrons.read, electrons.row, electrons.gain, electrons.black_level), (1.5, 2.4, 0.3, Some(0.38), 64.0));
    let vignetting = design.vignetting.unwrap();
    assert_eq!((vignetting.centre, vignetting.fall_off), (AROUND.principal_point, FallOff::Polynomial([-0.3, 0.1, 0.0])));
    let gradient = design.gradient.unwrap();
    assert_eq!((gradient.x, gradient.y, gradient.per), (0.1, -0.2, Per::Frame));
    assert_eq!((design.exposure, design.converter, design.output, design.jpeg), (0.9, Some(12), Some(8), Some(95)));
    assert_eq!(design.filter.unwrap().sensitivity, [0.5, 1.0, 0.6]);
    assert_eq!(design.demosaic.unwrap().white_balance, Some([2.0, 1.0, 1.7]));
    assert_eq!((design.gamma, setup.row_jitter), (Some(Gamma::Power(2.2)), 0.05));
}

#[test]
fn decibels_are_below_what_their_key_names_after_exposure() {
    for (text, sigma) in [("snr_contrast_db = 40\nexposure = 0.5", 0.0035), ("snr_mean_db = 20", 0.05), ("grey_noise = 0.02", 0.02)] {
        let Noise::White { sigma: found, prnu: 0.0 } = design(text).noise else { panic!("{text}") };
        assert!((found - sigma).abs() < 1e-12, "{text}: {found}");
    }
}

#[test]
fn the_response_may_be_uneven_beside_any_noise() {
    for text in ["snr_contrast_db = 46", "snr_mean_db = 46", "grey_noise = 0.02", "grey_noise = 0"] {
        let Noise::White { prnu: 0.0, .. } = design(text).noise else { panic!("{text}") };
        let Noise::White { prnu, sigma } = design(&format!("{text}\nprnu = 1.5")).noise else { panic!("{text}") };
        let Noise::White { sigma: alone, .. } = design(text).noise else { panic!("{text}") };
        assert!((prnu - 0.015).abs() < 1e-15 && sigma == alone, "{text}: {prnu} {sigma}");
    }
    let Noise::Electrons(electrons) = design("full_well = 1000\nprnu = 1.5").noise else { panic!("electrons") };
    assert!((electrons.prnu - 0.015).abs() < 1e-15);
}

#[test]
fn cos4_takes_the_cameras_principal_distance_and_its_own_centre() {
    let vignetting = design("cos4 = true\nvignetting_centre = [10, 20]").vignetting.unwrap();
    assert_eq!((vignetting.centre, vignetting.fall_off), (Some(PixelPoint::new(10.0, 20.0)), FallOff::Cos4 { c: 3000.0 }));
    assert!(design("cos4 = false\nsrgb = false").vignetting.is_none());
    assert_eq!(design("srgb = true").gamma, Some(Gamma::Srgb));
}

#[test]
fn what_a_camera_does_to_its_pictures_is_read() {
    let processed = design("smoothing = 0.6\nsharpening = 0.8\nsharpening_radius = 1.5\nshoulder = { start = 0.8, gain = 4 }");
    assert_eq!(processed.processing, Some(Processing { smoothing: 0.6, sharpening: 0.8, radius: 1.5 }));
    assert_eq!(processed.gamma, Some(Gamma::Shoulder { start: 0.8, gain: 4.0 }));
    let steps: Vec<String> = (1..=64).map(|step: u8| step.to_string()).collect();
    assert_eq!(design(&format!("jpeg_tables = [{}]", steps.join(", "))).tables.unwrap()[63], 64);
    assert_eq!(design("exposure = 1").processing, None);
}

#[test]
fn each_mistake_stands_at_its_key() {
    for (text, at, message) in [
        ("grey_noise = 0.1\nfull_well = 1000", "full_well", "`full_well` beside `grey_noise`: expected one description of the noise"),
        ("snr_mean_db = 30\nsnr_contrast_db = 30", "snr_mean_db", "`snr_mean_db` beside `snr_contrast_db`"),
        ("snr_mean_db = 30\nread_noise = 3", "read_noise", "`read_noise` beside `snr_mean_db`"),
        ("read_noise = 3", "read_noise", "`read_noise` without `full_well`"),
        ("prnu = 1", "prnu", "`prnu` without a description of the noise"),
        ("prnu = 1\nread_noise = 3", "read_noise", "`read_noise` without `full_well`"),
        ("full_well = 100\nphotons = 5", "photons", "`photons` without `quantum_efficiency`"),
        ("full_well = 100\nquantum_efficiency = 0.5", "quantum_efficiency", "without `photons`"),
        ("full_well = 100\nelectrons = 5\nphotons = 5\nquantum_efficiency = 1", "photons", "`photons` beside `electrons`"),
        ("full_well = 100\ndark_current = 5", "dark_current", "without `exposure_time`"),
        ("full_well = 100\nexposure_time = 5", "exposure_time", "without `dark_current`"),
        ("full_well = 100\ngain = 5", "gain", "without `adc_bits`"),
        ("full_well = 100\nblack_level = 5", "black_level", "without `adc_bits`"),
        ("full_well = 100\nadc_bits = 8\nblack_level = 200", "black_level", "the black level is 200: expected a number from 0 to 127.5"),
        ("full_well = 0.5", "full_well", "the full well is 0.5"),
        ("full_well = 9\ndark_current = 1e6\nexposure_time = 1e4", "dark_current", "the dark signal is 10000000000"),
        ("cos4 = true\nvignetting = [0, 0, 0]", "cos4", "`cos4` beside `vignetting`"),
        ("gradient_across = [0, 0]\ngradient_per_pixel = [0, 0]", "gradient_across", "beside `gradient_per_pixel`"),
        ("vignetting_centre = [0, 0]", "vignetting_centre", "without `vignetting` or `cos4`"),
        ("demosaic = 'grey'", "demosaic", "`demosaic` without `filter`"),
        ("filter_sensitivity = [1, 1, 1]", "filter_sensitivity", "without `filter`"),
        ("filter = 'rggb'\nwhite_balance = [1, 1, 1]", "white_balance", "without `demosaic`"),
        ("gamma = 2.2\nsrgb = true", "srgb", "`srgb` beside `gamma`"),
        ("jpeg_quality = 90\nbits = 16", "bits", "JPEG has 8 bits"),
        ("gamma = 2.2\nshoulder = { start = 0.8, gain = 4 }", "shoulder", "`shoulder` beside `gamma`"),
        ("sharpening_radius = 2", "sharpening_radius", "without `sharpening`"),
    ] {
        let (_, problems) = read_in(text, &AROUND);
        let [problem] = &problems[..] else { panic!("{text}: {problems:?}") };
        assert_eq!(&text[problem.span.clone()], at, "{text}: {problem:?}");
        assert!(problem.message.contains(message), "{text}: {problem:?}");
    }
}

#[test]
fn numbers_out_of_bounds_and_of_the_wrong_form_are_named() {
    for (text, at, message) in [
        ("exposure = nan", "nan", "from 0.000001 to 1000000"),
        ("exposure = 0", "0", "found 0"),
        ("prnu = 101", "101", "from 0 to 100"),
        ("vignetting = [1, 2]", "[1, 2]", "expected 3 numbers in a list, found 2"),
        ("gradient_across = [1, 2, 1]", "[1, 2, 1]", "expected 2 numbers in a list, found 3"),
        ("adc_bits = 9", "9", "expected 8, 10, 12, 14 or 16 bits, found 9"),
        ("bits = 14", "14", "expected 8, 12 or 16 bits, found 14"),
        ("jpeg_quality = 0", "0", "expected a whole number from 1 to 100"),
        ("filter = 'rgb'", "'rgb'", "rggb"),
        ("smoothing = 6", "6", "from 0 to 5"),
        ("sharpening = -1", "-1", "from -0.9 to 5"),
        ("shoulder = { start = 1, gain = 4 }", "1", "from 0 to 0.99"),
        ("jpeg_tables = [1, 2, 3]", "[1, 2, 3]", "expected 64 numbers in a list, found 3"),
        ("snr = 30", "snr", "unknown key `snr` in [sensor]"),
    ] {
        let (_, problems) = read_in(text, &AROUND);
        let [problem] = &problems[..] else { panic!("{text}: {problems:?}") };
        assert_eq!(&text[problem.span.clone()], at, "{text}: {problem:?}");
        assert!(problem.message.contains(message), "{text}: {problem:?}");
    }
}

#[test]
fn what_the_surroundings_do_not_say_is_asked_for() {
    for text in ["cos4 = true", "snr_contrast_db = 30", "snr_mean_db = 30"] {
        let (_, problems) = read_in(text, &Surroundings::default());
        let [problem] = &problems[..] else { panic!("{text}: {problems:?}") };
        assert!(problem.message.contains("known") && problem.help.is_some(), "{problem:?}");
        assert_eq!(Some(&text[problem.span.clone()]), text.split(' ').next());
    }
}

#[test]
fn every_key_is_described_in_the_schema() {
    let schema = schema_for!(SensorWire).to_value();
    let properties = schema["properties"].as_object().unwrap();
    assert!(properties.len() > 25);
    for (key, property) in properties {
        let about = property["description"].as_str().unwrap_or_default();
        assert!(about.len() > 15, "{key}: {property}");
    }
    assert!(schema["required"].is_null(), "every key may be left out");
}
