//! Shading, exposure and filter at the pixel's centre.

use calibench_model::PixelPoint;

use super::*;
use crate::sensor::{ColourFilter, FallOff, Gradient, Pattern, Per, Vignetting};

/// Greys of even light against `expected(x, y)`.
fn assert_grey(design: Design, size: (usize, usize), expected: impl Fn(f64, f64) -> f64) {
    let taken = expose(design, flat(size, 1.0), KEY).image;
    for (x, y) in (0..size.1).flat_map(|y| (0..size.0).map(move |x| (x, y))) {
        let (found, expected) = (f64::from(taken.at(x, y)), expected(x as f64, y as f64));
        assert!((found - expected).abs() < 2e-7, "({x}, {y}): {found} {expected}");
    }
}

#[test]
fn cos4_is_that_of_the_rays_angle() {
    let centre = PixelPoint::new(10.3, 7.9);
    let vignetting = Some(Vignetting { centre: Some(centre), fall_off: FallOff::Cos4 { c: 40.0 } });
    let angle = |x: f64, y: f64| ((x - centre.x).hypot(y - centre.y) / 40.0).atan();
    assert_grey(Design { vignetting, ..Design::default() }, (31, 17), |x, y| angle(x, y).cos().powi(4));
}

#[test]
fn a_polynomial_has_its_sum_in_the_corners_and_never_falls_below_zero() {
    let vignetting = |a| Some(Vignetting { centre: None, fall_off: FallOff::Polynomial(a) });
    let t = |x: f64, y: f64| ((x - 15.0).powi(2) + (y - 8.0).powi(2)) / (225.0 + 64.0);
    let design = Design { vignetting: vignetting([-0.4, 0.1, -0.05]), ..Design::default() };
    assert_grey(design, (31, 17), |x, y| 1.0 - 0.4 * t(x, y) + 0.1 * t(x, y).powi(2) - 0.05 * t(x, y).powi(3));
    let dark = Design { vignetting: vignetting([-2.0, 0.0, 0.0]), ..Design::default() };
    assert_grey(dark, (31, 17), |x, y| (1.0 - 2.0 * t(x, y)).max(0.0));
}

#[test]
fn a_gradient_is_stated_per_pixel_or_across_the_frame() {
    let gradient = |per| Some(Gradient { x: 0.02, y: -0.01, per });
    let design = Design { gradient: gradient(Per::Pixel), ..Design::default() };
    assert_grey(design, (21, 11), |x, y| 1.0 + 0.02 * (x - 10.0) - 0.01 * (y - 5.0));
    let design = Design { gradient: gradient(Per::Frame), exposure: 0.5, ..Design::default() };
    assert_grey(design, (21, 11), |x, y| 0.5 * (1.0 + 0.02 * (x - 10.0) / 20.0 - 0.01 * (y - 5.0) / 10.0));
}

#[test]
fn each_photosite_sees_its_colour() {
    for (pattern, name) in [(Pattern::Rggb, "rggb"), (Pattern::Bggr, "bggr"), (Pattern::Grbg, "grbg"), (Pattern::Gbrg, "gbrg")] {
        let filter = Some(ColourFilter { pattern, sensitivity: [0.25, 1.0, 0.5] });
        let of = |letter: u8| match letter {
            b'r' => 0.25,
            b'g' => 1.0,
            _ => 0.5,
        };
        let at = |x: f64, y: f64| name.as_bytes()[(y as usize % 2) * 2 + x as usize % 2];
        assert_grey(Design { filter, ..Design::default() }, (5, 5), |x, y| of(at(x, y)));
    }
}
