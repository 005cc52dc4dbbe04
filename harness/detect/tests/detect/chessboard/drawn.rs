//! Boards that are found, where they are and in the order that is documented.

use calibench_model::boards::{Layout, Shape};
use calibench_model::testfield::Outline;
use calibench_model::{Image, PixelPoint};

use super::chessboard;
use crate::picture::{View, noisy};

/// A board with `columns` x `rows` inner corners and squares of one unit; the square at the lower left is dark.
pub fn layout(columns: usize, rows: usize) -> Layout {
    let squares = (0..=rows).flat_map(|v| (0..=columns).map(move |u| [u, v])).filter(|[u, v]| (u + v).is_multiple_of(2));
    let shape = |[u, v]: [usize; 2]| Shape {
        outline: Outline::rectangle([u, v].map(|at| at as f64), [u + 1, v + 1].map(|at| at as f64)),
        dark: true,
    };
    let printed = [[0.0, 0.0], [columns as f64 + 1.0, rows as f64 + 1.0]];
    Layout { points: Vec::new(), markers: Vec::new(), shapes: squares.map(shape).collect(), printed }
}

/// Its inner corners as they are seen, row by row from the upper left one of the board.
fn corners(view: &View, layout: &Layout, columns: usize, rows: usize) -> Vec<PixelPoint> {
    let places = (0..rows).flat_map(|row| (0..columns).map(move |column| [column as f64 + 1.0, (rows - row) as f64]));
    places.map(|at| view.at(layout, at)).collect()
}

/// Finds the corners in any order, and says where in the list of what is true the first three corners are: at the start, after it and at the start of the next row.
fn found(image: &Image, truth: &[PixelPoint], (columns, rows): (usize, usize), within: f64, what: &str) -> [usize; 3] {
    let found = chessboard(image, columns, rows).unwrap_or_else(|| panic!("{what}: not found"));
    assert_eq!(found.len(), truth.len(), "{what}");
    let place =
        |at: &PixelPoint| truth.iter().position(|other| other.distance(*at) < within).unwrap_or_else(|| panic!("{what}: none at {at:?}"));
    let places: Vec<usize> = found.iter().map(place).collect();
    let mut sorted = places.clone();
    sorted.sort_unstable();
    sorted.dedup();
    assert_eq!(sorted.len(), truth.len(), "{what}: each once");
    let [first, next, below] = [found[0], found[1], found[columns]];
    let turned = (next.x - first.x) * (below.y - first.y) - (next.y - first.y) * (below.x - first.x);
    assert!(turned > 0.0, "{what}: mirrored");
    [places[0], places[1], places[columns]]
}

fn check(size: (usize, usize), within: f64, what: &str, change: impl Fn(View) -> View) {
    let layout = layout(size.0, size.1);
    let view = change(View::whole(&layout, 24.0));
    found(&view.draw(&layout), &corners(&view, &layout, size.0, size.1), size, within, what);
}

#[test]
fn boards_are_found_as_they_are_turned_and_tilted() {
    for size in [(9, 6), (5, 4), (6, 6), (7, 5), (3, 3)] {
        for (index, tilt) in [0.0, 30.0, 50.0, 65.0].into_iter().enumerate() {
            for turn in [0.0, 37.0, 122.0, 201.0, 290.0] {
                let tilt = [tilt, 20.0 + 55.0 * index as f64 + turn];
                check(size, 0.3, &format!("{size:?}, turned by {turn}, tilted by {tilt:?}"), |view| View { turn, tilt, ..view });
            }
        }
    }
}

#[test]
fn boards_are_found_small_blurred_and_noisy() {
    let tilt = [30.0, 70.0];
    for blur in [0.3, 1.5, 3.0] {
        check((9, 6), 0.3, &format!("blur {blur}"), |view| View { blur, tilt, turn: 10.0, ..view });
    }
    let large = layout(6, 5);
    let view = View { blur: 6.0, tilt, turn: 10.0, ..View::whole(&large, 50.0) };
    found(&view.draw(&large), &corners(&view, &large, 6, 5), (6, 5), 0.3, "blur 6");
    for noise in [0.03, 0.08] {
        check((9, 6), 0.5, &format!("noise {noise}"), |view| View { noise, tilt, turn: 100.0, ..view });
    }
    for (scale, tilt) in [(8.0, 0.0), (10.0, 30.0), (14.0, 50.0), (100.0, 30.0)] {
        let (layout, size) = (layout(8, 5), (8, 5));
        let view = View { tilt: [tilt, 40.0], turn: 5.0, ..View::whole(&layout, scale) };
        found(&view.draw(&layout), &corners(&view, &layout, 8, 5), size, 0.3, &format!("{scale} px a square"));
    }
    check((9, 6), 0.3, "faint", |view| View { paper: 0.4, ink: 0.35, noise: 0.003, tilt, ..view });
}

#[test]
fn boards_are_found_in_uneven_light() {
    let (layout, size) = (layout(9, 6), (9, 6));
    let view = View { tilt: [35.0, 15.0], turn: 20.0, ..View::whole(&layout, 30.0) };
    let (picture, truth) = (view.draw(&layout), corners(&view, &layout, 9, 6));
    let (width, height) = (view.width as f64, view.height as f64);
    let lit = |light: &dyn Fn(f64, f64) -> f64| {
        Image::from_fn(view.width, view.height, |x, y| picture.at(x, y) * light(x as f64, y as f64) as f32)
    };
    found(&lit(&|x, y| 0.1 + 0.9 * (x + y) / (width + height)), &truth, size, 0.3, "a gradient");
    found(&lit(&|x, y| 0.15 + 0.85 * (-(x - 0.4 * width).hypot(y - 0.6 * height) / (0.2 * width)).exp()), &truth, size, 0.5, "a spot");
    found(&lit(&|x, y| if x + 0.4 * y > 0.7 * width { 1.0 } else { 0.25 }), &truth, size, 1.5, "a shadow");
}

#[test]
fn the_first_corner_is_the_documented_one() {
    for turn in [3.0, 93.0, 183.0, 273.0] {
        let order = |columns: usize, rows: usize| {
            let layout = layout(columns, rows);
            let view = View { turn, ..View::whole(&layout, 20.0) };
            let truth = corners(&view, &layout, columns, rows);
            (found(&view.draw(&layout), &truth, (columns, rows), 0.3, &format!("{columns}x{rows} turned by {turn}")), truth)
        };
        // Dark at the lower left of the board: light at its upper left and dark at its lower right, or the other way round. One start.
        let (places, _) = order(6, 5);
        assert_eq!(places, [29, 28, 23], "turned by {turn}");
        let (places, _) = order(5, 4);
        assert_eq!(places, [0, 1, 5], "turned by {turn}");
        // Two starts, of which the one at the upper left of the image is taken.
        let (places, truth) = order(7, 5);
        let far = |at: usize| truth[at].x.hypot(truth[at].y);
        assert_eq!(places[0], if far(0) < far(34) { 0 } else { 34 }, "turned by {turn}");
        // Four starts, all equally dark.
        let (places, truth) = order(4, 4);
        let far = |at: usize| truth[at].x.hypot(truth[at].y);
        let nearest = [0, 3, 12, 15].into_iter().min_by(|a, b| far(*a).total_cmp(&far(*b)));
        assert_eq!(Some(places[0]), nearest, "turned by {turn}");
        // Four, of which two are dark: the lower left and the upper right one.
        let (places, _) = order(5, 5);
        assert!([4, 20].contains(&places[0]), "turned by {turn}: {places:?}");
    }
}

#[test]
fn the_same_image_gives_the_same_bytes_and_columns_and_rows_may_be_swapped() {
    let layout = layout(9, 6);
    let image = noisy(&View { turn: 30.0, ..View::whole(&layout, 20.0) }.draw(&layout), 0.02, 3);
    let [first, second] = [0, 1].map(|_| chessboard(&image, 9, 6).unwrap());
    assert_eq!(first, second);
    let swapped = chessboard(&image, 6, 9).unwrap();
    assert!(swapped.iter().all(|at| first.contains(at)));
}
