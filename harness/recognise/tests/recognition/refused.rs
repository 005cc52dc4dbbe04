//! Images that do not show the field: each is refused by name.

use calibench_model::Image;
use calibench_model::testfield::Testfield;
use calibench_random::Key;
use calibench_synth::testfield::{Chessboard, Levels};

use crate::campaign::{Setting, shots};
use crate::{BOTH, recogniser, told};

fn key(seed: u64) -> Key<'static> {
    Key { seed, of: "refused", trial: 0, view: "", target: "" }
}

/// Uniform noise around the middle grey, as wide as told.
fn noise(width: usize, height: usize, wide: f32) -> Image<'static> {
    let mut state = 12_345_u32;
    Image::from_fn(width, height, |_, _| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        0.5 + wide * ((state >> 8) as f32 / (1 << 24) as f32 - 0.5)
    })
}

/// All of these images are refused for one of these reasons, by either classifier.
fn refused(field: &Testfield, images: &[Image], reasons: &[&str]) {
    for classifier in BOTH {
        let recogniser = recogniser(field, classifier);
        for (index, image) in images.iter().enumerate() {
            let found = recogniser.recognise(image);
            println!("{index}: {}", told(&found));
            let error = found.expect_err("an image that does not show the field");
            assert!(reasons.contains(&error.name()), "image {index}: {}: {error}", error.name());
        }
    }
}

fn paper() -> Testfield {
    Setting::paper(2201, 0.6, 46.0).testfield()
}

#[test]
fn images_of_nothing() {
    let field = paper();
    let flat = |grey: f32| Image::from_fn(240, 180, |_, _| grey);
    refused(&field, &[flat(0.0), flat(0.5), flat(1.0)], &["blank"]);
    refused(&field, &[noise(240, 240, 0.01), noise(240, 240, 1.0), noise(641, 479, 0.3)], &["blank", "too_few_lines", "no_grid"]);
    let slope = Image::from_fn(300, 200, |x, y| 0.2 + 0.001 * x as f32 + 0.0005 * y as f32);
    let dark = Image::from_fn(300, 200, |x, _| if x < 150 { 0.1 } else { 0.9 });
    refused(&field, &[slope, dark], &["blank", "too_few_lines"]);
}

#[test]
fn images_that_are_too_small_or_no_images() {
    let field = paper();
    let board =
        |width: usize, height: usize| Image::from_fn(width, height, |x, y| if (x / 5 + y / 5).is_multiple_of(2) { 0.1 } else { 0.9 });
    refused(&field, &[board(20, 20), board(1, 1), board(4000, 1), board(31, 500)], &["too_small"]);
    refused(&field, &[board(32, 32), board(33, 47)], &["blank", "too_few_lines", "no_grid", "no_whole_square"]);
    let broken = |value: f32| Image::from_fn(64, 64, |x, y| if (x, y) == (40, 40) { value } else { 0.5 });
    refused(&field, &[broken(f32::NAN), broken(f32::INFINITY)], &["not_finite"]);
}

/// Flipped left to right, top to bottom, and turned over.
#[test]
fn mirror_images() {
    for (blur, decibel) in [(0.6, 46.0), (0.8, 26.0)] {
        let setting = Setting::paper(2202, blur, decibel);
        let field = setting.testfield();
        let tilts = [(0.0, [0.0, 0.0]), (30.0, [0.0, 30.0]), (45.0, [-45.0, 0.0])];
        let mirrored = shots(&setting, &field, &tilts, &[0.0, 40.0]).into_iter().flat_map(|shot| {
            let (image, n) = (shot.image, 239);
            [
                Image::from_fn(240, 240, |x, y| image.at(n - x, y)),
                Image::from_fn(240, 240, |x, y| image.at(x, n - y)),
                Image::from_fn(240, 240, |x, y| image.at(y, x)),
            ]
        });
        refused(&field, &mirrored.collect::<Vec<_>>(), &["mirrored"]);
    }
}

/// A chessboard as it is photographed, and one that fills the image.
#[test]
fn chessboards() {
    let setting = Setting::paper(2203, 0.6, 46.0);
    let board = |square: f64, margin: f64| Chessboard {
        rows: 6,
        columns: 8,
        square,
        margin,
        bend: None,
        print_noise: 0.0,
        levels: Levels { paper: 0.85, ink: 0.05 },
        background: 0.2,
    };
    let tilts = [(0.0, [0.0, 0.0]), (30.0, [0.0, 30.0]), (45.0, [45.0, 0.0])];
    let views = |square: f64| {
        let board = board(square, 20.0).generate(key(1)).unwrap();
        shots(&setting, &board, &tilts, &[0.0, 25.0]).into_iter().map(|shot| shot.image).collect::<Vec<_>>()
    };
    let reasons = ["too_few_lines", "no_grid", "no_whole_square", "no_targets", "other_field"];
    refused(&setting.testfield(), &[views(40.0), views(60.0), views(110.0)].concat(), &reasons);
    let filled = |side: usize| Image::from_fn(640, 480, |x, y| if (x / side + y / side).is_multiple_of(2) { 0.1 } else { 0.9 });
    refused(&setting.testfield(), &[filled(16), filled(41), filled(100)], &reasons);
}

/// Lines at equal distances with nothing between them, and with the same target in every square.
#[test]
fn grids_without_targets() {
    let field = paper();
    let grid = |dot: bool| {
        Image::from_fn(300, 300, |x, y| {
            let (u, v) = (x % 60, y % 60);
            let target = dot && [15, 45].iter().any(|a| [15, 45].iter().any(|b| u.abs_diff(*a).max(v.abs_diff(*b)) < 5));
            if u < 2 || v < 2 || target { 0.1 } else { 0.9 }
        })
    };
    refused(&field, &[grid(false), grid(true)], &["no_targets"]);
}
