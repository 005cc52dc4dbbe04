//! Chessboards with three dots: parts, dots that are hidden or too many.

use calibench_detect::detect;
use calibench_model::Image;
use calibench_model::boards::{Board, Layout, Shape};
use calibench_model::testfield::Outline;

use crate::picture::{View, board, scale};

/// 14 x 11 squares of 25; the first dot in the middle of one.
const TEXT: &str = "dotted:13x10:25:5,4";
const FIRST: [f64; 2] = [4.5 * 25.0, -3.5 * 25.0];

fn seen() -> (Board, Layout, View) {
    let (board, layout) = board(TEXT);
    let view = View::whole(&layout, scale(&board, &layout, 4.0));
    (board, layout, view)
}

/// A view with something of the board in its middle.
fn centred(view: View, layout: &Layout, at: [f64; 2], [width, height]: [usize; 2]) -> View {
    let there = view.at(layout, at);
    let middle = [view.middle[0] - there.x + width as f64 / 2.0, view.middle[1] - there.y + height as f64 / 2.0];
    View { width, height, middle, ..view }
}

#[test]
fn a_part_with_the_dots_is_enough_in_every_turn() {
    let (board, layout, whole) = seen();
    for turn in [0.0, 90.0, 180.0, 270.0, 35.0, -70.0] {
        for tilt in [[0.0, 0.0], [40.0, 10.0], [-40.0, 80.0]] {
            // Between six and eight squares a side of the image.
            let view = centred(View { turn, tilt, ..whole }, &layout, FIRST, [96, 84]);
            let what = format!("{turn} {tilt:?}");
            let found = detect(&view.draw(&layout), &board).unwrap_or_else(|error| panic!("{what}: {error}"));
            view.check(&layout, &found, 1.0, &what);
            assert!(found.points.len() >= 30 && found.points.len() < 130, "{what}: {}", found.points.len());
            assert_eq!((found.markers, found.doubts.len()), (3, 0), "{what}");
        }
    }
}

#[test]
fn without_its_dots_in_view_it_is_refused() {
    let (board, layout, whole) = seen();
    for at in [[10.0 * 25.0, -3.5 * 25.0], [0.0, -8.0 * 25.0]] {
        let error = detect(&centred(whole, &layout, at, [90, 84]).draw(&layout), &board).unwrap_err();
        assert_eq!(error.name(), "no_dots", "{error}");
    }
    // One of the three is hidden.
    let picture = whole.draw(&layout);
    let hidden = whole.at(&layout, [FIRST[0] + 25.0, FIRST[1]]);
    let covers = |x: usize, y: usize| (x as f64 - hidden.x).hypot(y as f64 - hidden.y) < 9.0;
    let image = Image::from_fn(picture.width(), picture.height(), |x, y| if covers(x, y) { 0.5 } else { picture.at(x, y) });
    assert_eq!(detect(&image, &board).unwrap_err().name(), "no_dots");
}

#[test]
fn a_print_that_is_light_on_dark_is_found_its_axes_a_quarter_on() {
    let (board, layout, whole) = seen();
    let view = View { paper: 0.1, ink: 0.9, turn: 100.0, tilt: [30.0, 40.0], ..whole };
    let found = detect(&view.draw(&layout), &board).unwrap();
    let turned =
        |point: &calibench_model::boards::BoardPoint| calibench_model::boards::BoardPoint { turns: point.turns + 1, ..point.clone() };
    let exchanged = Layout { points: layout.points.iter().map(turned).collect(), ..layout.clone() };
    view.check(&exchanged, &found, 1.0, "light on dark");
    assert_eq!(found.points.len(), 130);
}

#[test]
fn a_spot_is_no_dot_too_many_and_three_more_are() {
    let (board, mut layout, whole) = seen();
    let expected = layout.clone();
    let spot = |layout: &mut Layout, column: f64, row: f64| {
        layout.shapes.push(Shape::dark(Outline::disc([(column - 0.5) * 25.0, (0.5 - row) * 25.0], 4.5)));
    };
    // The square (8, 7) is light, as are (9, 8) and those beside dark ones.
    spot(&mut layout, 8.0, 7.0);
    let view = View { turn: 20.0, tilt: [25.0, 70.0], ..whole };
    let found = detect(&view.draw(&layout), &board).unwrap();
    view.check(&expected, &found, 1.0, "a spot");
    assert_eq!(found.points.len(), 130);
    for shape in board_dots(&board, [3, 3]) {
        layout.shapes.push(shape);
    }
    let error = detect(&view.draw(&layout), &board).unwrap_err();
    assert_eq!(error.name(), "other_arrangement", "{error}");
}

/// The dots of such a board, moved.
fn board_dots(board: &Board, by: [i32; 2]) -> Vec<Shape> {
    let Board::Dotted(board) = board else { panic!() };
    let place = [0, 1].map(|i| (board.place[i] as i32 + by[i]) as usize);
    let layout = calibench_model::boards::Dotted { place, ..*board }.layout().unwrap();
    layout.shapes[layout.shapes.len() - 3..].to_vec()
}

#[test]
fn small_and_blurred_squares_are_read() {
    let (board, layout, _) = seen();
    // Squares of 9 px, dots of 3 px; and a strong blur.
    for (square, blur, noise) in [(9.0, 0.7, 0.02), (12.0, 1.0, 0.03), (24.0, 3.0, 0.02), (60.0, 1.0, 0.01)] {
        let view = View { turn: -30.0, tilt: [20.0, 50.0], blur, noise, ..View::whole(&layout, square / 25.0) };
        let found = detect(&view.draw(&layout), &board).unwrap_or_else(|error| panic!("{square} {blur}: {error}"));
        view.check(&layout, &found, 1.0, "small or blurred");
        // Under the strong blur a corner of the board itself may be none.
        assert!(found.points.len() >= if blur > 2.0 { 128 } else { 130 }, "{square} {blur}: {}", found.points.len());
    }
}
