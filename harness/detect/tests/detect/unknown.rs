//! What board is it?

use calibench_detect::{Identified, detect, identify};
use calibench_model::Image;
use calibench_model::boards::Board;

use crate::picture::{View, board, noisy, scale};

fn pictured(text: &str, change: impl Fn(View) -> View) -> Image<'static> {
    let (board, layout) = board(text);
    change(View::whole(&layout, scale(&board, &layout, 5.0))).draw(&layout)
}

/// What is printed, and what it is taken for, with lengths in sides of squares, of markers, or in distances of circles.
const BOARDS: [(&str, &str); 28] = [
    ("charuco:8x5:30:21:DICT_4X4_50", "charuco:8x5:1:0.7:DICT_4X4_50"),
    ("charuco:5x8:30:21:DICT_4X4_50", "charuco:5x8:1:0.7:DICT_4X4_50"),
    ("charuco:8x6:30:24:DICT_5X5_100", "charuco:8x6:1:0.8:DICT_5X5_50"),
    ("charuco:8x6:30:24:DICT_5X5_100:legacy", "charuco:8x6:1:0.8:DICT_5X5_50:legacy"),
    ("charuco:5x6:30:15:DICT_6X6_250", "charuco:5x6:1:0.5:DICT_6X6_50"),
    ("charuco:5x6:30:15:DICT_6X6_250:legacy", "charuco:5x6:1:0.5:DICT_6X6_50:legacy"),
    ("charuco:7x7:30:21:DICT_4X4_50:11", "charuco:7x7:1:0.7:DICT_4X4_50:11"),
    ("charuco:14x9:30:21:DICT_4X4_100", "charuco:14x9:1:0.7:DICT_4X4_100"),
    ("charuco:6x4:30:21:DICT_APRILTAG_36h11", "charuco:6x4:1:0.7:DICT_APRILTAG_36h11"),
    ("aprilgrid:6x6:0.088:0.3", "aprilgrid:6x6:1:0.3"),
    ("aprilgrid:5x7:0.088:0.2", "aprilgrid:5x7:1:0.2"),
    ("aprilgrid:6x4:0.088:0.3:border1", "aprilgrid:6x4:1:0.3:border1"),
    ("aprilgrid:5x4:0.05:0.4:plain", "aprilgrid:5x4:1:0.4:plain"),
    ("gridboard:5x7:40:10:DICT_6X6_250", "gridboard:5x7:1:0.25:DICT_6X6_50"),
    ("gridboard:7x5:40:20:DICT_4X4_50", "gridboard:7x5:1:0.5:DICT_4X4_50"),
    ("gridboard:4x3:40:12:DICT_ARUCO_ORIGINAL:17", "gridboard:4x3:1:0.3:DICT_ARUCO_ORIGINAL:17"),
    ("gridboard:12x1:40:12:DICT_5X5_50:1", "gridboard:12x1:1:0.3:DICT_5X5_50:1"),
    ("gridboard:4x4:40:12:DICT_APRILTAG_36h11:border2", "gridboard:4x4:1:0.3:DICT_APRILTAG_36h11:border2"),
    ("chessboard:9x6:25", "chessboard:9x6:1"),
    ("chessboard:7x7:25", "chessboard:7x7:1"),
    ("puzzle:11x8:60:40,60", "puzzle:11x8:1:40,60"),
    ("dotted:13x9:25:2,1", "dotted:13x9:1:2,1"),
    ("dotted:9x7:25:6,5", "dotted:9x7:1:6,5"),
    ("circles:7x5:20", "circles:7x5:1:0.5"),
    ("circles:5x5:20", "circles:5x5:1:0.5"),
    ("acircles:4x11:20", "acircles:4x11:1:0.5"),
    ("circles:9x7:20:10:16@r7c1", "circles:9x7:1:0.5:0.~"),
    ("circles:9x7:20:10:10/5@r3c3,r4c7", "circles:9x7:1:0.5:0.5/0.2~"),
];

/// Kind, counts, dictionary, pattern and numbers of whatever is whole in view, however it is turned and tilted; and by the words that are told all of it is found.
#[test]
fn what_is_whole_in_view_is_named() {
    for (text, expected) in BOARDS {
        for (turn, tilt) in [(0.0, [0.0, 0.0]), (100.0, [25.0, 40.0]), (185.0, [35.0, -20.0])] {
            let image = pictured(text, |view| View { turn, tilt, ..view });
            let what = format!("{text}, turned by {turn}");
            let Some(Identified::Board { board: named, points, .. }) = identify(&image) else { panic!("{what}") };
            let same = named.to_string();
            if let Some(start) = expected.strip_suffix('~') {
                // Counted from another corner the mark is elsewhere, and the board the same.
                assert!(same.starts_with(start), "{what}: {same}");
            } else {
                assert_eq!(same, expected, "{what}");
            }
            assert_eq!(points, board(text).1.points.len(), "{what}");
            assert_eq!(detect(&image, &named).map(|found| found.points.len()), Ok(points), "{what}");
        }
    }
}

/// A part of a coded board is named as far as it is seen; numbers and dictionary are right all the same.
#[test]
fn a_part_of_a_board_with_markers_is_named_as_far_as_it_is_seen() {
    for (text, expected) in [
        ("aprilgrid:6x6:0.088:0.3", "aprilgrid:6x"),
        ("gridboard:6x8:40:10:DICT_6X6_250", "gridboard:6x"),
        ("charuco:9x8:30:21:DICT_4X4_50", "charuco:9x"),
        ("charuco:9x8:30:21:DICT_4X4_50:legacy", "charuco:9x"),
    ] {
        let (_, layout) = board(text);
        let change = |view: View| View { middle: [view.middle[0], view.height as f64 * 0.9], turn: 4.0, ..view };
        let image = pictured(text, change);
        let Some(Identified::Board { board: named, points, .. }) = identify(&image) else { panic!("{text}") };
        let same = named.to_string();
        assert!(same.starts_with(expected) && same.ends_with("legacy") == text.ends_with("legacy"), "{text}: {same}");
        assert!(points > 0 && points < layout.points.len());
        // By its own words no more are found but below its last row of markers.
        let all = detect(&image, &text.parse::<Board>().unwrap()).unwrap().points.len();
        let row = if text.starts_with("charuco") { 8 } else { 0 };
        assert!(points <= all && points + row >= all, "{text}: {same}, {points} of {all}");
    }
}

#[test]
fn markers_by_themselves_are_no_board() {
    let (of, layout) = board("gridboard:3x2:40:60:DICT_5X5_100:20");
    let view = View { turn: 10.0, ..View::whole(&layout, scale(&of, &layout, 6.0)) };
    // Its markers turned in their places: no board has them so.
    let mut scattered = layout.clone();
    let shapes = |index: usize, turns: usize| {
        let mut marker = layout.markers[index];
        marker.corners.rotate_left(turns);
        calibench_model::boards::marker_shapes(&marker, of.dictionary().unwrap().0, 1)
    };
    scattered.shapes = [(0, 1), (1, 3), (4, 2)].into_iter().flat_map(|(index, turns)| shapes(index, turns)).collect();
    let found = identify(&view.draw(&scattered));
    assert_eq!(found, Some(Identified::Markers { dictionary: "DICT_5X5_50", border: 1, ids: vec![20, 21, 24] }));
    assert_eq!(found.unwrap().words(), "markers of DICT_5X5_50 with frames 1 wide, on no board that is known: 20, 21, 24");
}

#[test]
fn nothing_is_no_board() {
    let flat = Image::from_fn(400, 300, |_, _| 0.5);
    let bricks = Image::from_fn(500, 400, |x, y| {
        let row = y / 24;
        let mortar = y % 24 < 4 || (x + 20 * (row % 2)) % 40 < 4;
        if mortar { 0.8 } else { 0.35 + 0.02 * ((x / 40 + 3 * row) % 7) as f32 }
    });
    for (image, what) in [
        (noisy(&flat, 0.01, 5), "noise"),
        (noisy(&flat, 0.3, 6), "much noise"),
        (flat, "flat"),
        (noisy(&bricks, 0.01, 7), "bricks"),
        (Image::from_fn(5, 3, |_, _| 0.0), "small"),
        (Image::from_fn(300, 200, |_, _| f32::NAN), "no numbers"),
    ] {
        assert_eq!(identify(&image), None, "{what}");
    }
}
