//! PuzzleBoards: parts, rims, dots that are hidden or wrong.

use calibench_detect::{Doubt, NotFound, detect};
use calibench_model::Image;
use calibench_model::boards::{BoardPoint, Layout};

use crate::picture::{View, board, noisy, scale};

/// Places in the pattern: its beginning, its end, where the tables begin anew, and others.
const PLACES: [[usize; 2]; 6] = [[0, 0], [490, 493], [160, 330], [333, 165], [100, 200], [287, 41]];

fn upright(text: &str, pixels: f64) -> (calibench_model::boards::Board, Layout, View) {
    let (board, layout) = board(text);
    let view = View::whole(&layout, scale(&board, &layout, pixels));
    (board, layout, view)
}

#[test]
fn any_part_of_the_pattern_is_found_from_dots_of_four_pixels() {
    for ([x, y], turn) in PLACES.into_iter().zip([0.0, 90.0, 180.0, 270.0, 35.0, -50.0]) {
        let text = format!("puzzle:11x8:30:{x},{y}");
        let (board, layout, whole) = upright(&text, 4.0);
        for tilt in [[0.0, 0.0], [45.0, 10.0], [-45.0, 80.0]] {
            let view = View { turn, tilt, ..whole };
            let what = format!("{text} {turn} {tilt:?}");
            let found = detect(&view.draw(&layout), &board).unwrap_or_else(|error| panic!("{what}: {error}"));
            view.check(&layout, &found, 1.0, &what);
            assert_eq!((found.points.len(), found.doubts.len()), (88, 0), "{what}");
            assert_eq!(found.markers, 10 * 8 + 11 * 7, "{what}: dots");
        }
    }
}

#[test]
fn a_blur_of_three_pixels_loses_nothing() {
    // Dots that run together with their corners move what is seen of these.
    for (pixels, within) in [(8.0, 2.5), (12.0, 2.5), (20.0, 1.0)] {
        let (board, layout, whole) = upright("puzzle:11x8:30:100,200", pixels);
        let view = View { turn: 20.0, tilt: [20.0, 50.0], blur: 3.0, ..whole };
        let found = detect(&view.draw(&layout), &board).unwrap_or_else(|error| panic!("{pixels}: {error}"));
        view.check(&layout, &found, within, "blurred");
        assert_eq!(found.points.len(), 88, "{pixels}");
    }
}

/// Few squares of 60 px: dots are seen on their sides from the first level on.
#[test]
fn large_squares_with_large_dots_lose_nothing() {
    let (board, layout, whole) = upright("puzzle:9x7:30:50,100", 20.0);
    for (turn, tilt) in [(0.0, [-25.0, 65.0]), (80.0, [30.0, 0.0]), (10.0, [-35.0, 90.0]), (0.0, [0.0, 0.0])] {
        let view = View { turn, tilt, ..whole };
        let found = detect(&view.draw(&layout), &board).unwrap();
        view.check(&layout, &found, 1.0, "large");
        assert_eq!(found.points.len(), 63, "{turn} {tilt:?}");
    }
}

#[test]
fn half_of_it_is_enough() {
    let (board, layout, whole) = upright("puzzle:16x12:30:222,333", 6.0);
    let view = View { turn: 12.0, tilt: [25.0, 60.0], ..whole };
    let picture = view.draw(&layout);
    for hidden in [|x: f64, _: f64| x < 0.5, |x: f64, _: f64| x > 0.5, |_: f64, y: f64| y < 0.5, |x: f64, y: f64| x + y > 1.0] {
        let at = |x: usize, y: usize| hidden(x as f64 / picture.width() as f64, y as f64 / picture.height() as f64);
        let image = Image::from_fn(picture.width(), picture.height(), |x, y| if at(x, y) { 0.4 } else { picture.at(x, y) });
        let found = detect(&image, &board).unwrap();
        view.check(&layout, &found, 1.0, "half hidden");
        assert!(found.points.len() > 60 && found.points.len() < 140, "{}", found.points.len());
        assert!(found.points.iter().all(|point| !at(point.position.x as usize, point.position.y as usize)));
    }
}

/// The board as it is described is smaller than what is printed.
#[test]
fn corners_beyond_the_board_are_left_out_and_said() {
    let (_, layout, whole) = upright("puzzle:20x15:30:95,190", 6.0);
    let view = View { turn: -30.0, tilt: [20.0, 0.0], ..whole };
    let (asked, part) = board("puzzle:8x6:30:100,200");
    let found = detect(&view.draw(&layout), &asked).unwrap();
    assert_eq!(
        found.points.iter().map(|point| point.index).collect::<Vec<_>>(),
        (0..40).collect::<Vec<_>>(),
        "five of six rows are printed"
    );
    assert_eq!(found.doubts, [Doubt::Beyond { corners: 300 - 40 }]);
    assert_eq!(found.doubts[0].name(), "foreign");
    // The first corner of the part is the sixth of row 11.
    let first = view.at(&layout, layout.points[10 * 20 + 5].at);
    assert!(first.distance(found.points[0].position) < 1.0 && part.points[0].id == "r1c1");
}

#[test]
fn dots_of_others_are_refused() {
    let (board, mut layout, view) = upright("puzzle:16x12:30:222,333", 6.0);
    // The dots of another place, about half of them turned over.
    let (_, other) = crate::picture::board("puzzle:16x12:30:10,15");
    let turn_over = |shape: &calibench_model::boards::Shape| {
        let mut shape = shape.clone();
        for curve in &mut shape.outline.0 {
            if let calibench_model::testfield::Curve::Arc { centre, sweep, .. } = curve {
                let [u, v] = centre.map(|value| (value / 15.0).round() as i64);
                if (u.wrapping_mul(73_856_093) ^ v.wrapping_mul(19_349_663)) >> 4 & 1 == 1 {
                    *sweep = -*sweep;
                }
            }
        }
        shape
    };
    layout.shapes = other.shapes.iter().map(turn_over).collect();
    let error = detect(&view.draw(&layout), &board).unwrap_err();
    assert!(matches!(error, NotFound::OtherDots { dots, .. } if dots > 2 * (16 + 12)), "{error}");
}

#[test]
fn a_print_that_is_light_on_dark_is_found_its_axes_a_quarter_on() {
    let (board, layout, whole) = upright("puzzle:11x8:30:7,4", 6.0);
    let view = View { paper: 0.1, ink: 0.9, tilt: [30.0, 40.0], turn: 100.0, ..whole };
    let found = detect(&view.draw(&layout), &board).unwrap();
    assert_eq!((found.points.len(), found.markers), (88, 10 * 8 + 11 * 7));
    let turned = Layout { points: layout.points.iter().map(|p| BoardPoint { turns: p.turns + 1, ..p.clone() }).collect(), ..layout };
    view.check(&turned, &found, 1.0, "light on dark");
}

#[test]
fn the_same_board_twice_is_said() {
    let (board, layout, view) = upright("puzzle:8x6:30:40,60", 6.0);
    let one = view.draw(&layout);
    let (width, height) = (one.width(), one.height());
    let both = Image::from_fn(2 * width, height, |x, y| one.at(x % width, y));
    let found = detect(&both, &board);
    assert_eq!(found.unwrap_err().name(), "other_arrangement", "no corner is left");
}

/// Twelve megapixels: a board beside noise.
#[test]
fn large_pictures_are_no_trouble() {
    let (board, layout, view) = upright("puzzle:23x16:30:50,100", 20.0);
    let view = View { width: 4000, height: 3000, middle: [2000.0, 1500.0], turn: 10.0, tilt: [30.0, 0.0], ..view };
    let picture = noisy(&view.draw(&layout), 0.01, 3);
    let start = std::time::Instant::now();
    let found = detect(&picture, &board).unwrap();
    eprintln!("{:?}", start.elapsed());
    view.check(&layout, &found, 1.0, "large");
    assert_eq!(found.points.len(), 23 * 16);
}
