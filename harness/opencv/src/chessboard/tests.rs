use std::path::Path;

use calibench_measure::{Board, BoardDetector};
use calibench_model::{Image, PixelPoint};
use opencv::core::{Mat, Size};
use opencv::imgproc::{INTER_CUBIC, resize};
use opencv::prelude::MatTraitConstManual;

use super::{ChessboardDetector, enlarge};

const BOARD: Board = Board { columns: 9, rows: 6 };

/// A board of 10 x 7 squares of `side` px on white, turned by 0.1 rad, and its inner corners along the rows.
pub(crate) fn drawn(width: usize, height: usize, side: f64) -> (Image<'static>, Vec<PixelPoint>) {
    let (sin, cos) = 0.1_f64.sin_cos();
    let middle = PixelPoint::new(width as f64 * 0.52, height as f64 * 0.47);
    let grey = |x: usize, y: usize| {
        let (dx, dy) = ((x as f64 - middle.x) / side, (y as f64 - middle.y) / side);
        let (u, v) = (cos * dx + sin * dy + 5.0, cos * dy - sin * dx + 3.5);
        if !(0.0..10.0).contains(&u) || !(0.0..7.0).contains(&v) {
            return 0.9;
        }
        let wave = |t: f64| (t * std::f64::consts::PI).sin();
        (0.5 - 0.4 * (side * wave(u) * wave(v) * 0.5).tanh()) as f32
    };
    let corner = |index: usize| {
        let (du, dv) = ((index % 9) as f64 - 4.0, (index / 9) as f64 - 2.5);
        PixelPoint::new(middle.x + side * (cos * du - sin * dv), middle.y + side * (sin * du + cos * dv))
    };
    (Image::from_fn(width, height, grey), (0..54).map(corner).collect())
}

/// The largest distance, in the given or the reversed order.
fn farthest(a: &[PixelPoint], b: &[PixelPoint]) -> f64 {
    let worst = |b: &mut dyn Iterator<Item = &PixelPoint>| a.iter().zip(b).map(|(p, q)| p.distance(*q)).fold(0.0, f64::max);
    worst(&mut b.iter()).min(worst(&mut b.iter().rev()))
}

/// Grey values from a multiplicative hash, uniform in [0, 1).
fn uniform(index: usize) -> f32 {
    let hash = (index as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    let hash = (hash ^ (hash >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    (hash >> 40) as f32 / (1_u64 << 24) as f32
}

#[test]
fn a_drawn_board_is_found_at_any_size() {
    for (width, height, side) in [(300, 240, 20.0), (640, 480, 40.0), (1501, 1003, 90.0), (4000, 3000, 250.0), (4000, 3000, 60.0)] {
        let (image, truth) = drawn(width, height, side);
        let found = ChessboardDetector.detect(&image, BOARD).unwrap_or_else(|| panic!("{width} x {height}, {side} px"));
        assert!(farthest(&found, &truth) < 0.2, "{width} x {height}, {side} px: {}", farthest(&found, &truth));
    }
}

#[test]
fn the_middle_of_an_image_stays_in_the_middle() {
    let mat = |side: usize| Mat::new_rows_cols_with_default(side as i32, side as i32, opencv::core::CV_8U, 0.0.into()).unwrap();
    for (small, large) in [(320_usize, 4000_usize), (321, 4000), (480, 481)] {
        let middle = |side: usize| (side - 1) as f64 / 2.0;
        let from = PixelPoint::new(middle(small), middle(small));
        let to = enlarge(from, &mat(small), &mat(large));
        assert!(to.distance(PixelPoint::new(middle(large), middle(large))) < 1e-9, "{to:?}");
    }
}

#[test]
fn nothing_is_found_where_nothing_is() {
    let noises: [fn(usize, usize) -> f32; 4] = [
        |x, y| uniform(4000 * y + x),
        |x, y| 0.5 + 0.3 * (uniform(4000 * y + x) - 0.5),
        |x, y| if uniform(4000 * y + x) < 0.02 { 1.0 } else { 0.5 },
        |_, _| f32::NAN,
    ];
    for noise in noises {
        assert!(ChessboardDetector.detect(&Image::from_fn(4000, 3000, noise), BOARD).is_none());
    }
    for side in 0..12 {
        assert!(ChessboardDetector.detect(&Image::from_fn(side, side, |x, y| uniform(y * side + x)), BOARD).is_none());
    }
}

#[test]
fn another_board_is_not_found_and_ends() {
    let (image, _) = drawn(2000, 1500, 120.0);
    assert!(ChessboardDetector.detect(&image, Board { columns: 5, rows: 4 }).is_none());
    assert!(ChessboardDetector.detect(&image, Board { columns: 20, rows: 15 }).is_none());
}

pub(crate) fn photographs() -> Vec<(String, Image<'static>)> {
    let folder = Path::new(option_env!("CALIBENCH_PHOTOGRAPHS").unwrap_or_default());
    let numbers = (1..=14).filter(|&n| n != 10);
    let read = |name: String| {
        let grey = image::open(folder.join(&name)).unwrap().into_luma8();
        let values = grey.as_raw().iter().map(|&g| f32::from(g) / 255.0).collect();
        (name, Image::new(grey.width() as usize, grey.height() as usize, values))
    };
    numbers.map(|n| read(format!("left{n:02}.jpg"))).collect()
}

#[test]
#[cfg_attr(not(photographs), ignore = "needs the photographs opencv-left in the folder CALIBENCH_DATA")]
fn all_thirteen_photographs_show_their_board_as_taken_and_enlarged() {
    for (name, photograph) in photographs() {
        let found = ChessboardDetector.detect(&photograph, BOARD).unwrap_or_else(|| panic!("{name}"));
        let large = enlarged(&photograph, 4000, 3000);
        let again = ChessboardDetector.detect(&large, BOARD).unwrap_or_else(|| panic!("{name}, enlarged"));
        let scale = 4000.0 / photograph.width() as f64;
        let back = |p: &PixelPoint| {
            let corner = p.to_corner();
            calibench_model::CornerPoint { x: corner.x / scale, y: corner.y / scale }.to_pixel()
        };
        let again: Vec<PixelPoint> = again.iter().map(back).collect();
        // The windows differ in size, and the images are compressed.
        assert!(farthest(&found, &again) < 0.5, "{name}: {}", farthest(&found, &again));
    }
}

fn enlarged(image: &Image, width: usize, height: usize) -> Image<'static> {
    let header = Mat::new_rows_cols_with_data(image.height() as i32, image.width() as i32, image.grey()).unwrap();
    let mut large = Mat::default();
    resize(&header, &mut large, Size::new(width as i32, height as i32), 0.0, 0.0, INTER_CUBIC).unwrap();
    Image::new(width, height, large.data_typed::<f32>().unwrap().to_vec())
}

#[test]
fn a_small_board_in_a_large_noisy_frame_is_found() {
    for noise in [0.01_f32, 0.03, 0.06] {
        let (image, truth) = drawn(4000, 3000, 60.0);
        let noisy = Image::from_fn(4000, 3000, |x, y| image.at(x, y) + noise * (uniform(4000 * y + x) + uniform(4000 * y + x + 77) - 1.0));
        let found = ChessboardDetector.detect(&noisy, BOARD).unwrap_or_else(|| panic!("noise {noise}"));
        assert!(farthest(&found, &truth) < 0.5, "noise {noise}: {}", farthest(&found, &truth));
    }
}
