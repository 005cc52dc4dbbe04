use super::*;
use crate::TargetKind;
use crate::testfield::PlatePoint;

/// The signed area of an outline, in thin chords.
fn area(shape: &Shape) -> f64 {
    let points: Vec<PlatePoint> =
        shape.outline.0.iter().flat_map(|curve| (0..500).map(move |step| curve.at(f64::from(step) / 500.0))).collect();
    let next = points.iter().cycle().skip(1);
    points.iter().zip(next).map(|(a, b)| 0.5 * (a[0] * b[1] - b[0] * a[1])).sum::<f64>()
}

fn all() -> impl Iterator<Item = (&'static str, Board, Layout)> {
    examples().map(|(name, example)| {
        let board: Board = example.parse().unwrap();
        (name, board, board.layout().unwrap())
    })
}

/// The conformance of a kind of board: points apart and inside, room that is free of everything else, names once.
#[test]
fn every_kind_of_board_conforms() {
    for (kind, _, layout) in all() {
        let mut names: Vec<&str> = layout.points.iter().map(|point| point.id.as_str()).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), layout.points.len(), "{kind}: names");
        let [[u0, v0], [u1, v1]] = layout.printed;
        for point in &layout.points {
            let [u, v] = point.at;
            assert!(u0 <= u && u <= u1 && v0 <= v && v <= v1, "{kind} {}: not on the board", point.id);
            assert!(point.size > 0.0 && point.room > 0.0, "{kind} {}", point.id);
        }
        assert_eq!(layout.points[0].at, [0.0, 0.0], "{kind}: the first point is the origin");
        let curves = layout.shapes.iter().flat_map(|shape| &shape.outline.0);
        for [u, v] in curves.map(|curve| curve.at(0.5)) {
            let slack = 1e-9 * (u1 - u0);
            assert!(u0 - slack <= u && u <= u1 + slack && v0 - slack <= v && v <= v1 + slack, "{kind}: ({u}, {v}) is outside");
        }
        let inked: f64 = layout.shapes.iter().map(|shape| if shape.dark { area(shape).abs() } else { -area(shape).abs() }).sum();
        let share = inked / ((u1 - u0) * (v1 - v0));
        assert!((0.05..0.8).contains(&share), "{kind}: {share} of it is dark");
    }
}

#[test]
fn boards_are_written_as_they_are_read() {
    let more = [
        "charuco:8x5:30:21:DICT_5X5_100:7:legacy",
        "aprilgrid:6x5:0.03:0.25:4:border1:plain",
        "gridboard:3x4:0.05:0.0125:DICT_4X4_50:30:border2",
        "acircles:4x11:20:8",
        "circles:10x10:20:10:20@r10c1",
        "circles:14x10:10:3:3/1@r3c3,r8c3,r8c12:gap@r5c7",
        "puzzle:11x8:60",
        "dotted:9x6:25:2,1",
    ];
    for text in examples().map(|(_, example)| example).chain(more) {
        let board: Board = text.parse().unwrap();
        assert_eq!(board.to_string().parse(), Ok(board), "{text}: {board}");
    }
}

#[test]
fn outlines_are_closed_and_of_their_area() {
    for (kind, _, layout) in all() {
        for shape in &layout.shapes {
            let next = shape.outline.0.iter().cycle().skip(1);
            for (curve, next) in shape.outline.0.iter().zip(next) {
                let (end, start) = (curve.at(1.0), next.at(0.0));
                assert!((end[0] - start[0]).hypot(end[1] - start[1]) < 1e-9 * (1.0 + end[0].abs() + end[1].abs()), "{kind}");
            }
        }
    }
    // A ring of 12 sectors, d = 8: dark sectors are twelfths of pi (12^2 - 8^2); the disc is pi 4^2.
    let layout = "rings:12:1x1:50:8".parse::<Board>().unwrap().layout().unwrap();
    let found: f64 = layout.shapes.iter().map(|shape| area(shape).abs()).sum();
    let expected = std::f64::consts::PI * (16.0 + (144.0 - 64.0) / 12.0);
    assert!((found / expected - 1.0).abs() < 1e-5, "{found} {expected}");
}

#[test]
fn a_charuco_board_is_numbered_as_opencv_does() {
    let board = |text: &str| text.parse::<Board>().unwrap().layout().unwrap();
    // The upper left square is dark, the second holds marker 0: from (square, 0.3 square / 2) of the board's upper left.
    let new = board("charuco:5x4:30:21:DICT_4X4_50");
    assert_eq!((new.points.len(), new.markers.len()), (12, 10));
    assert_eq!(new.markers[0].corners[0], [4.5, 25.5], "origin: the first inner corner, v upwards");
    let legacy = board("charuco:5x4:30:21:DICT_4X4_50:legacy");
    assert_eq!(legacy.markers[0].corners[0], [-25.5, 25.5]);
    assert_eq!(board("charuco:5x3:30:21:DICT_4X4_50:legacy").markers, board("charuco:5x3:30:21:DICT_4X4_50").markers, "odd rows: alike");
    assert_eq!((new.points[0].turns, new.points[1].turns, legacy.points[0].turns), (0, 1, 1));
    assert_eq!(board("charuco:5x4:30:21:DICT_4X4_50:7").markers[9].id, 16);
}

#[test]
fn an_aprilgrid_is_numbered_as_kalibr_does() {
    let layout = "aprilgrid:6x6:0.088:0.3".parse::<Board>().unwrap().layout().unwrap();
    assert_eq!((layout.points.len(), layout.markers.len()), (144, 36));
    let upper = layout.points.iter().find(|point| point.id == "t7c2").unwrap();
    // Column 1, row 1: a pitch of 0.1144 m, and its upper right corner.
    assert!((upper.at[0] - 0.2024).abs() < 1e-12 && (upper.at[1] - 0.2024).abs() < 1e-12, "{:?}", upper.at);
    // Tags stand upside down: the upper left corner of the first as it is read is at the lower right.
    assert_eq!(layout.markers[0].corners[0], [0.088, 0.0]);
    assert_eq!(upper.kind, TargetKind::ChessCorner);
    // Ten cells: 36 tags and 49 small squares, less white cells.
    let plain = "aprilgrid:6x6:0.088:0.3:border1:plain".parse::<Board>().unwrap().layout().unwrap();
    assert_eq!(plain.points[0].kind, TargetKind::Corner);
    assert_eq!(layout.shapes.len() - plain.shapes.len(), 49);
}

/// Object points of `cv::aruco::GridBoard((3, 2), 4, 1, dictionary, ids 10 to 15)` of OpenCV 4.6 and 5.0, with y downwards.
#[test]
fn a_gridboard_is_numbered_as_opencv_does() {
    let layout = "gridboard:3x2:4:1:DICT_4X4_50:10".parse::<Board>().unwrap().layout().unwrap();
    assert_eq!((layout.points.len(), layout.markers.len()), (24, 6));
    let theirs = |id: u32| -> [[f64; 2]; 4] {
        let [x, y] = [5.0 * f64::from((id - 10) % 3), 5.0 * f64::from((id - 10) / 3)];
        [[x, y], [x + 4.0, y], [x + 4.0, y + 4.0], [x, y + 4.0]]
    };
    for (marker, id) in layout.markers.iter().zip(10..) {
        assert_eq!((marker.id, marker.corners), (id, theirs(id).map(|[x, y]| [x, -y])));
        for (k, at) in marker.corners.iter().enumerate() {
            let point = &layout.points[4 * (id as usize - 10) + k];
            assert_eq!((point.id.as_str(), point.at), (format!("t{id}c{k}").as_str(), *at));
            // The marker lies from its corner towards its own u and its own v, which points down.
            let [u, v] = point.target(0, point.at).axes;
            let inside = [0, 1].map(|i| at[i] + u[i] + v[i]);
            assert!(
                marker.corners.iter().all(|corner| (corner[0] - inside[0]).abs() < 4.0 && (corner[1] - inside[1]).abs() < 4.0),
                "{id} {k}"
            );
        }
    }
    // A wider frame leaves more room, up to the gap.
    let wide = "gridboard:3x2:4:1:DICT_4X4_50:border2".parse::<Board>().unwrap();
    assert_eq!(wide.dictionary().map(|(dictionary, border)| (dictionary.name, border)), Some(("DICT_4X4_50", 2)));
    assert_eq!((layout.points[0].room, wide.layout().unwrap().points[0].room), (4.0 / 6.0, 1.0));
}

#[test]
fn asymmetric_circles_stand_as_opencv_has_them() {
    let layout = "acircles:4x11:20".parse::<Board>().unwrap().layout().unwrap();
    assert_eq!(layout.points.len(), 44);
    // ((2 j + i % 2) s, i s) of row i and column j.
    assert_eq!((layout.points[4].id.as_str(), layout.points[4].at), ("r2c1", [20.0, -20.0]));
    assert_eq!(layout.points[43].at, [120.0, -200.0]);
}

#[test]
fn circles_unlike_the_others_are_drawn_where_they_are_said_to_be() {
    let layout = "circles:10x10:20:10:20@r10c1:12/6@r1c1:gap@r4c4".parse::<Board>().unwrap().layout().unwrap();
    assert_eq!(layout.points.len(), 99);
    assert!(layout.points.iter().all(|point| point.id != "r4c4"), "nothing is measured where no circle is");
    let size = |id: &str| layout.points.iter().find(|point| point.id == id).map(|point| (point.size, point.at, point.room));
    assert_eq!(size("r10c1"), Some((20.0, [0.0, -180.0], 15.0)));
    assert_eq!(size("r9c1"), Some((10.0, [0.0, -160.0], 10.0)), "half of a spacing up to the larger one");
    assert_eq!(size("r5c5"), Some((10.0, [80.0, -80.0], 15.0)));
    assert_eq!(layout.printed, [[-10.0, -190.0], [185.0, 6.0]]);
    assert_eq!(layout.shapes.iter().filter(|shape| !shape.dark).count(), 1);
}

/// Marks number a grid where no turn of it leaves them as they are.
#[test]
fn what_marks_tell() {
    for (text, tell) in [
        ("circles:10x10:20", false),
        ("circles:10x10:20:10:20@r10c1", true),
        ("circles:9x9:20:10:20@r5c5", false),
        ("circles:9x9:20:10:20@r1c1,r9c9", false),
        ("circles:9x7:20:10:20@r1c1,r7c1", true),
        ("circles:9x9:20:10:20@r3c3,r3c7,r7c3,r7c7", false),
        ("circles:9x9:20:10:15@r3c3,r3c7,r7c3:20@r7c7", true),
        ("circles:9x9:20:10:gap@r1c9", true),
        ("acircles:4x10:20:10:gap@r5c2", true),
        ("acircles:4x10:20:10:14@r5c2,r6c3", false),
    ] {
        assert_eq!(text.parse::<Board>().unwrap().is_coded(), tell, "{text}");
    }
}

#[test]
fn ring_codes_are_as_many_as_necklaces() {
    // Binary necklaces of 12 beads are 352, two of them of one colour; of 14: 1182, of 16: 4116, of 20: 52488 (OEIS A000031).
    for (bits, necklaces) in [(12, 352), (14, 1182), (16, 4116), (20, 52488)] {
        assert_eq!(ring_codes(bits, false).len(), necklaces - 2, "{bits}");
    }
    assert!(ring_codes(12, true).iter().all(|code| code.count_ones() % 2 == 0));
    assert_eq!(least_rotation(0b1000_0000_0011, 12), 0b111);
}

#[test]
fn texts_that_describe_no_board_are_told_what_was_expected() {
    for (text, said) in [
        ("chess:3x3", "`chess` is no kind of board: expected one of chessboard, charuco"),
        ("chessboard:9x2:25", "`rows` is 2"),
        ("charuco", "no count; expected charuco:COLUMNSxROWS"),
        ("charuco:8x5:30:21", "no dictionary"),
        ("charuco:8x5:30:21:DICT_9X9_50", "`DICT_9X9_50` is no dictionary"),
        ("charuco:8x5:30:21:DICT_4X4_50:legacy:more", "`more` is one too many"),
        ("charuco:8x5:30:31:DICT_4X4_50", "`marker` is 31"),
        ("charuco:20x20:30:21:DICT_4X4_50", "the board needs 200 markers"),
        ("charuco:8x5:-30:21:DICT_4X4_50", "`square` is -30"),
        ("aprilgrid:6x6:0.088", "no spacing"),
        ("aprilgrid:6x6:0.088:NaN", "`spacing` is NaN"),
        ("aprilgrid:60x60:0.088:0.3", "needs 3600 markers"),
        ("gridboard:5x7", "no side of a marker; expected gridboard:COLUMNSxROWS:MARKER:SEPARATION:DICTIONARY[:FIRST][:border2]"),
        ("gridboard:5x7:40:10", "no dictionary"),
        ("gridboard:5x7:40:10:DICT_6X6", "`DICT_6X6` is no dictionary"),
        ("gridboard:5x7:40:0:DICT_6X6_250", "`separation` is 0: expected 0.8 to 400"),
        ("gridboard:5x7:-40:10:DICT_6X6_250", "`marker` is -40"),
        ("gridboard:0x7:40:10:DICT_6X6_250", "`columns` is 0"),
        ("gridboard:5x7:40:10:DICT_4X4_50:20", "`first` is 20: expected at most 50: the board needs 35 markers"),
        ("gridboard:5x7:40:10:DICT_4X4_50:border3", "`border3` is one too many"),
        ("circles:7x5:wide", "`wide` is no spacing"),
        ("circles:7x5:20:30", "`diameter` is 30"),
        ("circles:7x5:20:10:20", "`20` is no mark FORM@POINT"),
        ("circles:7x5:20:10:wide@r1c1", "`wide` is no diameter"),
        ("circles:7x5:20:10:20@r0c1", "`r0c1` is no point"),
        ("circles:7x5:20:10:20@r6c1", "`20@r6c1` is beyond 7 columns and 5 rows"),
        ("circles:7x5:20:10:30@r1c1", "`30@r1c1` has a diameter of 30: expected 1 to 28"),
        ("circles:7x5:20:10:11@r1c1", "`11@r1c1` is like the others"),
        ("circles:7x5:20:10:20@r1c1,r1c1", "is there twice"),
        ("circles:7x5:20:10:gap@r1c1", "turn the board"),
        ("circles:9x5:20:10:20@r1c1,r1c2,r1c3,r1c4,r1c5,r1c6,r1c7,r1c8,r1c9", "9 circles are unlike the others"),
        ("rings:13:2x2:50:8", "`bits` is 13"),
        ("rings:12:30x30:50:8", "rings of 12 sectors have no more"),
        ("puzzle:11x8", "no side of a square; expected puzzle:COLUMNSxROWS:SQUARE[:X,Y]"),
        ("puzzle:11x8:60:12", "`12` is no place X,Y"),
        ("puzzle:11x5:60", "`rows` is 5"),
        (
            "dotted:9x6:25:4",
            "`4` is no place X,Y of the square with the first dot; expected dotted:COLUMNSxROWS:SQUARE[:X,Y], as in dotted:13x9:25:2,1",
        ),
        ("puzzle:11x8:60:491,0", "`place[0]` is 491: expected a whole number from 0 to 490"),
        ("puzzle:11x8:60:0,494", "`place[1]` is 494"),
    ] {
        let error = text.parse::<Board>().unwrap_err().to_string();
        assert!(error.contains(said), "{text}\n{error}\nexpected {said}");
    }
}
