//! The same bytes whoever works, in whatever order.

use rayon::ThreadPoolBuilder;

use super::*;
use crate::sensor::{Clipped, ColourFilter, Demosaic, DemosaicTo, FallOff, Frame, Gamma, Gradient, Pattern, Per, Vignetting};

const ALL: Electrons = Electrons {
    full_well: 3000.0,
    at_white: 3100.0,
    prnu: 0.01,
    dark: 2.0,
    dsnu: 1.0,
    read: 2.0,
    row: 0.7,
    gain: None,
    black_level: 100.0,
};

fn everything() -> Design {
    Design {
        vignetting: Some(Vignetting { centre: None, fall_off: FallOff::Cos4 { c: 500.0 } }),
        gradient: Some(Gradient { x: 0.1, y: -0.1, per: Per::Frame }),
        exposure: 0.98,
        filter: Some(ColourFilter { pattern: Pattern::Grbg, sensitivity: [0.6, 1.0, 0.8] }),
        converter: Some(12),
        demosaic: Some(Demosaic { to: DemosaicTo::Grey, white_balance: None }),
        gamma: Some(Gamma::Srgb),
        output: Some(8),
        jpeg: Some(90),
        ..electrons(ALL)
    }
}

fn scene() -> Image<'static> {
    Image::from_fn(333, 517, |x, y| if (x / 20 + y / 20) % 2 == 0 { 0.02 } else { 0.95 })
}

#[test]
fn one_thread_and_two_give_the_same_bytes() {
    for design in [everything(), Design { converter: Some(8), ..electrons(ALL) }] {
        let on = |threads| {
            let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| expose(design.clone(), scene(), KEY))
        };
        assert_eq!(on(1), on(2));
    }
}

#[test]
fn strips_of_any_height_make_the_image() {
    let design = Design { converter: Some(8), ..electrons(ALL) };
    let sensor = Sensor::new(design).unwrap();
    assert!(sensor.works_by_rows());
    let whole = sensor.expose(scene(), KEY).unwrap();
    let frame = Frame { width: 333, height: 517 };
    for rows in [1, 7, 64, 517] {
        let mut strips = scene();
        let each = strips.grey_mut().chunks_mut(333 * rows).enumerate();
        let clipped: Clipped = each.map(|(i, strip)| sensor.expose_rows(strip, i * rows, frame, KEY)).sum();
        assert_eq!((strips, clipped), (whole.image.clone(), whole.clipped), "{rows} rows");
    }
}

#[test]
fn strips_developed_afterwards_are_the_same_too() {
    let sensor = Sensor::new(everything()).unwrap();
    assert!(!sensor.works_by_rows());
    let whole = sensor.expose(scene(), KEY).unwrap();
    let mut strips = scene();
    let first = sensor.expose_rows(strips.grey_mut(), 0, Frame { width: 333, height: 517 }, KEY);
    let (image, second) = sensor.develop(strips).unwrap();
    assert_eq!((image, first + second), (whole.image, whole.clipped));
}

#[test]
fn tiny_and_empty_images_pass() {
    for (width, height) in [(0, 0), (0, 5), (5, 0), (1, 1), (1, 7), (7, 1), (2, 2)] {
        let design = Design { jpeg: None, ..everything() };
        let taken = expose(design, flat((width, height), 0.5), KEY);
        assert_eq!((taken.image.width(), taken.image.height()), (width, height));
        assert!(taken.image.grey().iter().all(|grey| grey.is_finite()));
    }
    assert!(Sensor::new(everything()).unwrap().expose(flat((0, 3), 0.5), KEY).is_err(), "JPEG of nothing");
}

#[test]
fn light_that_is_no_number_is_no_panic() {
    let light = Image::new(4, 1, vec![f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0]);
    let taken = expose(Design { jpeg: None, ..everything() }, light, KEY);
    assert!(taken.image.grey().iter().all(|grey| (0.0..=1.0).contains(grey)), "{:?}", taken.image);
}
