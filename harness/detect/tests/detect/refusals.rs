//! What is no picture of the board is refused by name.

use calibench_detect::{NotFound, detect};
use calibench_model::Image;
use calibench_model::boards::{Board, examples};

use crate::picture::{View, board, noisy, scale};

fn reason(pictured: &str, asked: &str, change: impl Fn(View) -> View) -> NotFound {
    let (of, layout) = board(pictured);
    let view = change(View { turn: 12.0, tilt: [25.0, 60.0], ..View::whole(&layout, scale(&of, &layout, 6.0)) });
    let found = detect(&view.draw(&layout), &board(asked).0);
    found.expect_err(&format!("{pictured} as {asked}"))
}

#[test]
fn mirror_images_are_named() {
    let tells = |example: &str| example.parse::<Board>().is_ok_and(|board| board.is_coded());
    // Of a grid of circles in a mirror the marks stand elsewhere.
    for (_, example) in examples().filter(|(name, example)| tells(example) && !name.contains("circles")) {
        let error = reason(example, example, |view| View { mirrored: true, ..view });
        assert_eq!(error.name(), "mirrored", "{example}: {error}");
    }
}

#[test]
fn other_boards_are_named() {
    for (pictured, asked, name) in [
        ("aprilgrid:6x6:0.088:0.3", "aprilgrid:6x6:0.088:0.2", "other_spacing"),
        ("aprilgrid:6x6:0.088:0.3", "aprilgrid:6x6:0.088:0.45", "other_spacing"),
        ("charuco:8x5:30:21:DICT_4X4_50", "charuco:8x5:30:24:DICT_4X4_50", "other_spacing"),
        ("charuco:8x5:30:21:DICT_4X4_50", "charuco:8x5:30:16:DICT_4X4_50", "other_spacing"),
        ("charuco:8x6:30:21:DICT_4X4_50", "charuco:8x6:30:21:DICT_4X4_50:legacy", "other_arrangement"),
        ("charuco:9x4:30:21:DICT_4X4_50", "charuco:9x4:30:21:DICT_4X4_50:legacy", "other_arrangement"),
        ("charuco:9x4:30:21:DICT_4X4_50:legacy", "charuco:9x4:30:21:DICT_4X4_50", "other_arrangement"),
        ("charuco:5x8:30:21:DICT_4X4_50", "charuco:5x8:30:21:DICT_4X4_50:legacy", "other_arrangement"),
        ("charuco:8x5:30:21:DICT_4X4_50", "charuco:7x6:30:21:DICT_4X4_50", "other_arrangement"),
        ("aprilgrid:6x6:0.088:0.3", "aprilgrid:5x7:0.088:0.3", "other_arrangement"),
        ("charuco:8x5:30:21:DICT_4X4_50", "charuco:8x5:30:21:DICT_5X5_50", "other_dictionary"),
        ("charuco:8x5:30:21:DICT_5X5_50", "charuco:8x5:30:21:DICT_4X4_50", "other_dictionary"),
        ("charuco:8x5:30:21:DICT_6X6_50", "charuco:8x5:30:21:DICT_APRILTAG_36h11", "other_dictionary"),
        ("charuco:8x5:30:21:DICT_4X4_50:25", "charuco:8x5:30:21:DICT_4X4_50", "other_ids"),
        ("aprilgrid:6x6:0.088:0.3", "aprilgrid:6x6:0.088:0.3:border1", "other_frames"),
        ("gridboard:5x4:40:10:DICT_6X6_250", "gridboard:5x4:40:14:DICT_6X6_250", "other_spacing"),
        ("gridboard:5x4:40:10:DICT_6X6_250", "gridboard:4x5:40:10:DICT_6X6_250", "other_arrangement"),
        ("gridboard:5x4:40:10:DICT_6X6_250", "gridboard:5x4:40:10:DICT_5X5_250", "other_dictionary"),
        ("gridboard:5x4:40:10:DICT_6X6_250:40", "gridboard:5x4:40:10:DICT_6X6_250", "other_ids"),
        ("gridboard:5x4:40:12:DICT_6X6_250:border2", "gridboard:5x4:40:12:DICT_6X6_250", "other_frames"),
        // The same tags with the same gaps: OpenCV counts them from the upper left, Kalibr from the lower left and upside down.
        ("aprilgrid:4x4:40:0.3:border1:plain", "gridboard:4x4:40:12:DICT_APRILTAG_36h11", "other_arrangement"),
        ("gridboard:4x4:40:12:DICT_APRILTAG_36h11", "aprilgrid:4x4:40:0.3:border1:plain", "other_arrangement"),
        ("circles:7x5:20", "circles:6x5:20", "no_grid"),
        ("circles:7x5:20", "circles:8x5:20", "no_grid"),
        ("circles:7x5:20", "acircles:7x5:20", "other_rows"),
        ("circles:7x5:20", "circles:7x5:20:10:16@r1c1", "other_marks"),
        ("circles:9x7:20:9:16@r7c1", "circles:9x7:20:9:16@r1c1", "other_marks"),
        ("circles:9x7:20:9:16@r7c1", "circles:10x7:20:9", "no_grid"),
        ("circles:9x7:20:9:9/4@r3c3,r4c7", "circles:9x7:20:9:9/4@r3c3,r5c6", "other_marks"),
        ("rings:12:6x5:50:8", "rings:12:6x5:30:8", "other_spacing"),
        ("rings:12:6x5:50:8", "rings:12:5x6:50:8", "other_arrangement"),
        ("puzzle:11x8:30:40,60", "puzzle:11x8:30:300,60", "other_place"),
        ("puzzle:11x8:30:40,60", "puzzle:11x8:30:51,60", "other_place"),
        ("chessboard:11x8:30", "puzzle:11x8:30:40,60", "no_puzzle"),
        ("chessboard:11x8:30", "dotted:11x8:30", "no_dots"),
        ("dotted:11x8:30", "dotted:11x8:30:2,3", "other_counts"),
        ("dotted:12x8:30:5,4", "dotted:11x8:30:5,4", "other_counts"),
        ("puzzle:11x8:30:40,60", "dotted:11x8:30", "no_dots"),
        ("charuco:8x5:30:21:DICT_4X4_50", "dotted:7x4:30", "no_dots"),
    ] {
        let error = reason(pictured, asked, |view| view);
        assert_eq!(error.name(), name, "{pictured} as {asked}: {error}");
    }
}

/// What was asked for is wrong in its counts or its order: what is there is named, whole, so that it can be asked for.
#[test]
fn the_board_that_is_there_is_named() {
    for (pictured, asked) in [
        (
            "charuco:8x6:30:21:DICT_4X4_50",
            &["charuco:8x6:30:21:DICT_4X4_50:legacy", "charuco:7x6:30:21:DICT_4X4_50", "charuco:6x8:30:21:DICT_4X4_50"][..],
        ),
        (
            "charuco:8x6:30:21:DICT_4X4_50:legacy",
            &["charuco:8x6:30:21:DICT_4X4_50", "charuco:9x6:30:21:DICT_4X4_50", "charuco:5x4:30:21:DICT_4X4_50"],
        ),
        ("charuco:5x7:30:21:DICT_4X4_50", &["charuco:7x5:30:21:DICT_4X4_50", "charuco:4x7:30:21:DICT_4X4_50"]),
        ("charuco:9x4:30:21:DICT_4X4_50", &["charuco:9x4:30:21:DICT_4X4_50:legacy"]),
        ("charuco:9x4:30:21:DICT_4X4_50:legacy", &["charuco:9x4:30:21:DICT_4X4_50"]),
        ("aprilgrid:6x5:0.088:0.3", &["aprilgrid:5x6:0.088:0.3", "aprilgrid:7x5:0.088:0.3", "aprilgrid:5x5:0.088:0.3"]),
        (
            "gridboard:6x5:40:10:DICT_6X6_250",
            &["gridboard:5x6:40:10:DICT_6X6_250", "gridboard:7x5:40:10:DICT_6X6_250", "gridboard:5x5:40:10:DICT_6X6_250"],
        ),
        ("circles:7x5:20", &["circles:8x5:20", "circles:6x5:20", "acircles:4x11:20"]),
        ("acircles:4x11:20", &["acircles:5x11:20", "circles:7x5:20", "acircles:11x4:20"]),
    ] {
        for asked in asked {
            let error = reason(pictured, asked, |view| view);
            let text = error.to_string();
            let named = if pictured.contains("circles") { pictured.trim_end_matches(":20") } else { pictured };
            assert!(text.ends_with(named), "{pictured} as {asked}: {text}");
        }
    }
}

#[test]
fn a_grid_of_circles_that_is_cut_off_is_refused() {
    let error = reason("circles:7x5:20", "circles:7x5:20", |view| View { middle: [0.2 * view.middle[0], view.middle[1]], ..view });
    assert_eq!(error.name(), "no_grid", "{error}");
}

#[test]
fn noise_and_nothing_are_no_board() {
    for (_, example) in examples() {
        let board = board(example).0;
        let flat = Image::from_fn(400, 300, |_, _| 0.5);
        for (image, what) in [(flat.lent(), "flat"), (noisy(&flat, 0.01, 5), "noisy"), (noisy(&flat, 0.3, 5), "very noisy")] {
            let error = detect(&image, &board).expect_err(what);
            assert!(
                matches!(error.name(), "no_chessboard" | "no_marker" | "no_grid" | "no_code" | "no_puzzle" | "no_dots"),
                "{example} {what}: {error}"
            );
        }
        for (image, what) in
            [(Image::from_fn(300, 200, |_, _| f32::NAN), "no numbers"), (Image::from_fn(300, 200, |x, _| x as f32 / 300.0), "ramp")]
        {
            detect(&image, &board).expect_err(what);
        }
        assert_eq!(detect(&Image::from_fn(3, 0, |_, _| 0.0), &board).unwrap_err().name(), "too_small");
    }
}
