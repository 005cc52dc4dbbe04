//! What is no crossing: bare edges, noise and texture.

use calibench_model::{Image, PixelPoint, Start};

use super::{chess, operator};
use crate::tests::no_corners::accepted;
use crate::tests::quadrature_images;

/// Of all windows of a kind at most one in a thousand.
fn refuses(spec: &str, windows: usize) {
    for (what, count) in accepted(&*operator(spec), windows) {
        assert!(count * 1000 <= windows, "{spec}, {what}: {count} of {windows}");
    }
}

#[test]
fn edges_noise_and_texture_are_no_corners() {
    refuses("window=15", 3000);
}

/// With a gradient, a curvature or a smaller window up to one texture in a hundred passes: the more unknowns and the fewer pixels, the more a saddle of grey values is like a
/// corner.
#[test]
#[ignore = "takes minutes"]
fn of_a_hundred_thousand_windows_next_to_none_is_taken_for_a_corner() {
    for spec in ["window=15", "window=21"] {
        refuses(spec, std::env::var("WINDOWS").map_or(100_000, |windows| windows.parse().unwrap()));
    }
}

/// A block of a JPEG file that has but one wave along each axis is a saddle of a grey level or two, as smooth as a blurred corner and without noise.
#[test]
fn a_block_of_two_grey_levels_is_no_corner_and_a_faint_corner_is_one() {
    let wave = |at: usize| (std::f64::consts::PI * (2 * (at % 8) + 1) as f64 / 16.0).cos();
    let measured = |image: &Image| operator("window=15").measure(image, &Start::at(PixelPoint::new(19.0, 20.0)));
    for offset in [0.5, 1.0, 1.4] {
        let block = |x: usize, y: usize| x / 8 == 2 && y / 8 == 2;
        let level = |x, y| if block(x, y) { (100.0 + offset + 0.8 * offset * wave(x) * wave(y)).round() } else { 100.0 };
        let image = Image::from_fn(41, 41, |x, y| (level(x, y) / 255.0) as f32);
        assert!(measured(&image).is_err(), "{offset}: {:?}", measured(&image));
    }
    // The same contrast in 16 bits, as of a set that is merely dark.
    let faint = super::Chess { mean: 0.01, half: 0.006, position: [19.8, 20.3], ..chess(0.3, 0.4, 0.7, [0.0; 2]) };
    let grey: Vec<f64> = faint.render(41).iter().map(|grey| (grey * 65535.0).round() / 65535.0).collect();
    let found = measured(&quadrature_images::image(&grey, 41)).unwrap().position;
    assert!(found.distance(PixelPoint::new(19.8, 20.3)) < 0.01, "{found:?}");
}
