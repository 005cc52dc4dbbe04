//! What is no such board is not found, and nothing panics.

use calibench_detect::{NotFound, detect};
use calibench_model::Image;
use calibench_model::boards::{Board, Chessboard};

use super::chessboard;
use super::drawn::layout;
use crate::picture::{View, noisy};

/// The counts of the board that is seen in place of the one asked for.
fn instead(image: &Image, columns: usize, rows: usize) -> Option<[usize; 2]> {
    match detect(image, &Board::Chessboard(Chessboard { columns, rows, square: 1.0 })) {
        Err(NotFound::NoChessboard { other, .. }) => other,
        found => panic!("{columns} x {rows}: {found:?}"),
    }
}

#[test]
fn boards_with_other_counts_are_refused() {
    let layout = layout(8, 6);
    for tilt in [0.0, 40.0, 60.0] {
        let image = View { turn: 25.0, tilt: [tilt, 50.0], ..View::whole(&layout, 24.0) }.draw(&layout);
        assert!(chessboard(&image, 8, 6).is_some(), "tilted by {tilt}");
        for (columns, rows) in [(7, 6), (9, 6), (8, 5), (8, 7), (7, 5), (9, 7), (8, 8), (6, 6), (3, 3), (40, 30), (4, 3)] {
            assert_eq!(chessboard(&image, columns, rows), None, "{columns} x {rows}, tilted by {tilt}");
        }
    }
}

#[test]
fn the_board_that_is_there_is_named() {
    for (size, asked) in [
        ((9, 6), [(9, 7), (10, 7), (8, 6), (8, 5), (10, 6), (7, 7), (20, 20), (3, 3)]),
        ((5, 4), [(4, 4), (5, 5), (6, 5), (4, 3), (5, 3), (6, 4), (9, 6), (3, 3)]),
    ] {
        let layout = layout(size.0, size.1);
        for tilt in [0.0, 40.0, 60.0] {
            let image = View { turn: 25.0, tilt: [tilt, 50.0], ..View::whole(&layout, 24.0) }.draw(&layout);
            for (columns, rows) in asked {
                assert_eq!(instead(&image, columns, rows), Some([size.0, size.1]), "{columns} x {rows} of {size:?}, tilted by {tilt}");
            }
        }
    }
}

#[test]
fn boards_that_are_hidden_in_part_are_refused() {
    let layout = layout(8, 6);
    let view = View { turn: 10.0, ..View::whole(&layout, 24.0) };
    let image = view.draw(&layout);
    for hidden in [[4.0, 3.0], [1.0, 1.0], [8.0, 4.0]] {
        let at = view.at(&layout, hidden);
        let covered =
            Image::from_fn(
                view.width,
                view.height,
                |x, y| {
                    if (x as f64 - at.x).hypot(y as f64 - at.y) < 14.0 { 0.6 } else { image.at(x, y) }
                },
            );
        assert_eq!(instead(&covered, 8, 6), None, "hidden at {hidden:?}");
    }
    // Two columns are beyond the border.
    let out = View { middle: [view.middle[0] - 0.42 * view.width as f64, view.middle[1]], ..view };
    assert_eq!(instead(&out.draw(&layout), 8, 6), None);
}

#[test]
fn noise_and_nothing_are_no_board() {
    let flat = Image::from_fn(300, 200, |_, _| 0.5);
    let stripes = Image::from_fn(300, 200, |x, _| f32::from(u8::from((x / 10) % 2 == 0)));
    let noise = [0.01, 0.3].map(|sigma| noisy(&flat, sigma, 7));
    let ramp = Image::from_fn(300, 200, |x, y| (x * y) as f32 / 6e4);
    let [weak, strong] = noise;
    for image in [flat, stripes, weak, strong, ramp] {
        for (columns, rows) in [(3, 3), (4, 3), (9, 6)] {
            assert_eq!(instead(&image, columns, rows), None);
        }
    }
}

#[test]
fn odd_images_and_counts_are_none() {
    for (width, height) in [(0, 0), (1, 1), (1, 900), (900, 1), (16, 16), (17, 40), (25, 24)] {
        assert_eq!(chessboard(&Image::from_fn(width, height, |x, y| ((x + y) % 2) as f32), 3, 3), None, "{width} x {height}");
    }
    let layout = layout(5, 4);
    let image = View::whole(&layout, 20.0).draw(&layout);
    for (columns, rows) in [(0, 0), (1, 1), (5, 0), (2, 4), (usize::MAX, usize::MAX), (usize::MAX, 3), (1 << 33, 1 << 33)] {
        assert_eq!(chessboard(&image, columns, rows), None, "{columns} x {rows}");
    }
    for odd in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN_POSITIVE] {
        assert_eq!(chessboard(&Image::from_fn(90, 70, |_, _| odd), 5, 4), None, "{odd}");
        let speckled = Image::from_fn(image.width(), image.height(), |x, y| if (x * 31 + y * 17) % 97 == 0 { odd } else { image.at(x, y) });
        let _ = chessboard(&speckled, 5, 4);
    }
    // Numbers everywhere on the board.
    let bordered = Image::from_fn(image.width(), image.height(), |x, y| if x.min(y) < 2 { f32::NAN } else { image.at(x, y) });
    assert!(chessboard(&bordered, 5, 4).is_some());
}
