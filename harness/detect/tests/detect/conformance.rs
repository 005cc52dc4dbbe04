//! Every kind of board, in every position.

use calibench_detect::detect;
use calibench_model::Image;
use calibench_model::boards::examples;

use crate::picture::{View, board, scale};

/// How far a position may be off, px.
const WITHIN: f64 = 1.0;

#[test]
fn every_kind_is_found_whole_in_four_rotations_and_under_tilts() {
    for (_, example) in examples() {
        let (board, layout) = board(example);
        let upright = View::whole(&layout, scale(&board, &layout, 4.0));
        // Circles that a half turn leaves as they were are numbered from the upper left.
        let is_symmetric = example.starts_with("circles") && !board.is_coded();
        let turns: &[f64] = if is_symmetric { &[0.0, 30.0, -40.0] } else { &[0.0, 90.0, 180.0, 270.0, 35.0] };
        for turn in turns {
            for tilt in [[0.0, 0.0], [30.0, 0.0], [45.0, 0.0], [45.0, 90.0], [-45.0, 20.0]] {
                let view = View { turn: *turn, tilt, ..upright };
                let what = format!("{example}, turned by {turn}, tilted by {tilt:?}");
                let found = detect(&view.draw(&layout), &board).unwrap_or_else(|error| panic!("{what}: {error}"));
                view.check(&layout, &found, WITHIN, &what);
                assert_eq!(found.points.len(), layout.points.len(), "{what}");
                assert_eq!(found.doubts, [], "{what}");
            }
        }
    }
}

#[test]
fn boards_are_found_large_blurred_dim_and_bright() {
    for (_, example) in examples() {
        let (board, layout) = board(example);
        let near = View { turn: 20.0, tilt: [20.0, 50.0], ..View::whole(&layout, scale(&board, &layout, 12.0)) };
        for (paper, ink, blur, noise) in [(0.85, 0.1, 0.4, 0.0), (0.85, 0.1, 3.0, 0.02), (0.2, 0.05, 1.0, 0.005), (1.0, 0.5, 1.0, 0.01)] {
            let view = View { paper, ink, blur, noise, ..near };
            let what = format!("{example}: {paper} {ink} {blur} {noise}");
            let found = detect(&view.draw(&layout), &board).unwrap_or_else(|error| panic!("{what}: {error}"));
            view.check(&layout, &found, WITHIN, &what);
            assert_eq!(found.points.len(), layout.points.len(), "{what}");
        }
    }
}

#[test]
fn a_part_of_a_coded_board_is_enough() {
    // A chessboard with three dots is in view with them or not at all, as is a grid of circles with its origin: tests of their own.
    let parts = |name: &str| !["chessboard", "dotted"].contains(&name) && !name.contains("circles");
    for (name, example) in examples().filter(|(name, _)| parts(name)) {
        let (board, layout) = board(example);
        let whole = View::whole(&layout, scale(&board, &layout, 6.0));
        for middle in [[0.0, 0.5], [0.6, 0.0], [1.0, 1.0]] {
            let middle = [middle[0] * whole.width as f64, middle[1] * whole.height as f64];
            let view = View { middle, turn: 15.0, tilt: [25.0, 10.0], ..whole };
            let found = detect(&view.draw(&layout), &board).unwrap_or_else(|error| panic!("{name} {middle:?}: {error}"));
            view.check(&layout, &found, WITHIN, name);
            assert!(
                found.points.len() * 10 > layout.points.len() && found.points.len() < layout.points.len(),
                "{name}: {}",
                found.points.len()
            );
        }
    }
}

#[test]
fn other_dictionaries_and_forms_are_found_too() {
    for text in [
        "charuco:6x4:30:21:DICT_5X5_100:10",
        "charuco:6x4:30:24:DICT_6X6_250:legacy",
        "charuco:9x6:1:0.7:DICT_7X7_1000",
        "charuco:6x4:30:21:DICT_ARUCO_ORIGINAL",
        "charuco:5x4:30:20:DICT_APRILTAG_16h5",
        "aprilgrid:4x3:0.05:0.25:100:border1",
        "aprilgrid:4x3:0.05:0.4:plain",
        "gridboard:4x3:40:12:DICT_4X4_50:17",
        "gridboard:3x5:40:16:DICT_5X5_100:border2",
        "gridboard:4x3:0.05:0.02:DICT_APRILTAG_36h11:500",
        "gridboard:6x1:40:20:DICT_7X7_50",
        "gridboard:1x4:40:20:DICT_ARUCO_ORIGINAL",
        "circles:6x6:20:12",
        "acircles:3x4:20",
        "rings:14:4x3:60:8",
        "rings:20:4x3:60:10",
        "puzzle:8x6:30",
        "puzzle:11x9:30:490,492",
        "puzzle:16x12:30:165,166",
        "dotted:9x6:25",
        "dotted:4x4:25",
        "dotted:14x11:25:11,1",
    ] {
        let (board, layout) = board(text);
        let view = View { turn: 10.0, tilt: [30.0, 40.0], ..View::whole(&layout, scale(&board, &layout, 6.0)) };
        let found = detect(&view.draw(&layout), &board).unwrap_or_else(|error| panic!("{text}: {error}"));
        view.check(&layout, &found, WITHIN, text);
        assert_eq!(found.points.len(), layout.points.len(), "{text}");
    }
}

#[test]
fn circles_are_found_light_on_dark() {
    for text in ["circles:7x5:20", "acircles:4x11:20"] {
        let (board, layout) = board(text);
        let whole = View::whole(&layout, scale(&board, &layout, 4.0));
        let view = View { paper: 0.1, ink: 0.9, tilt: [30.0, 40.0], ..whole };
        let found = detect(&view.draw(&layout), &board).unwrap_or_else(|error| panic!("{text}: {error}"));
        view.check(&layout, &found, WITHIN, text);
        assert_eq!(found.points.len(), layout.points.len(), "{text}");
    }
}

#[test]
fn what_is_covered_is_not_reported() {
    for (name, example) in examples() {
        let (board, layout) = board(example);
        if !board.is_coded() {
            continue;
        }
        let view = View { turn: 25.0, tilt: [25.0, 80.0], ..View::whole(&layout, scale(&board, &layout, 6.0)) };
        let picture = view.draw(&layout);
        let reach = 0.12 * picture.width() as f64;
        let covers = |x: f64, y: f64| (x - view.middle[0]).hypot(y - view.middle[1]) < reach;
        for grey in [0.05, 0.5, 0.9] {
            let at = |x: usize, y: usize| if covers(x as f64, y as f64) { grey } else { picture.at(x, y) };
            let image = Image::from_fn(picture.width(), picture.height(), at);
            let found = detect(&image, &board).unwrap_or_else(|error| panic!("{name} {grey}: {error}"));
            // The edge of what covers a board of plain squares draws the corners beside it, as that of a shadow does; a disc of which a sliver is covered has its middle elsewhere.
            view.check(&layout, &found, if name == "dotted" || name.contains("circles") { 1.5 } else { WITHIN }, name);
            let hidden = found.points.iter().filter(|point| covers(point.position.x, point.position.y)).count();
            assert_eq!(hidden, 0, "{name} {grey}");
            assert!(2 * found.points.len() > layout.points.len(), "{name} {grey}: {}", found.points.len());
        }
    }
}
