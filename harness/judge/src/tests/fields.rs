//! Points of known coordinates in place of a board.

use calibench_model::ControlRow;
use calibench_records::judgement::measure;

use super::*;
use crate::Expected;

/// The corners of the board by other names, as points of control.
fn as_points(material: &Material) -> Material {
    let named = |row: ControlRow| ControlRow { target: format!("house {}", row.target), ..row };
    Material { field: Field::Points(material.field.control().into_iter().map(named).collect()), ..material.clone() }
}

#[test]
fn a_board_whose_corners_are_given_as_control_is_judged_alike() {
    let board = material("fields", 0, 8, &[0.05, 0.2]);
    let options = options(&["opencv4:fx,fy,cx,cy", "opencv4"], 3);
    let (of_board, of_points) = (judge(&board, &options).unwrap(), judge(&as_points(&board), &options).unwrap());
    // What does not ask which points lie side by side.
    let alike =
        [measure::CORNERS, measure::RESIDUALS, measure::SPLIT, measure::SPLIT_TEST, measure::MAP, measure::FRAME, measure::UNCERTAINTY];
    let of = |rows: &[Row]| rows.iter().filter(|row| alike.contains(&&*row.measure)).cloned().collect::<Vec<_>>();
    assert!(of(&of_board).len() > 100 && of(&of_board) == of(&of_points));
    let straight = |rows: &[Row]| rows.iter().filter(|row| &*row.measure == measure::STRAIGHT).count();
    assert_eq!((straight(&of_board), straight(&of_points)), (2 * 2 * 8, 0));
    let summary = Summary::new(&of_points, options.seed);
    let trusted = summary.trusted().unwrap();
    assert_eq!((&*trusted.cell.method, &*trusted.cell.model), ("operator-1", "opencv4"));
}

#[test]
fn halves_of_points_part_them_along_their_longest_extents() {
    let at = |x: f64, y: f64, z: f64| ControlRow::new(format!("{x} {y} {z}"), [x, y, z]);
    // 2 wide, 9 high, 5 deep.
    let field = Field::Points(vec![at(0.0, 9.0, 1.0), at(2.0, 0.0, 5.0), at(1.0, 3.0, 0.0), at(0.5, 6.0, 4.0)]);
    let [even, odd] = field.interleaved();
    assert_eq!(even, [false, true, false, true]);
    assert_eq!(odd, [true, false, true, false]);
    let [low, high, near, far] = field.sides();
    assert_eq!((low, high), (vec![false, true, true, false], vec![true, false, false, true]));
    assert_eq!((near, far), (vec![true, false, true, false], vec![false, true, false, true]));
    assert!(field.lines().is_empty());
}

#[test]
fn a_board_is_parted_as_its_fields_and_sides() {
    let field = Field::Board { board: BOARD, side: SIDE };
    let [even, _] = field.interleaved();
    assert!(even[0] && !even[1] && !even[9] && even[10]);
    let [left, right, top, bottom] = field.sides();
    // Nine columns: five to the left.
    assert_eq!([&left, &right, &top, &bottom].map(|half| half.iter().filter(|inside| **inside).count()), [30, 24, 27, 27]);
    assert!(left[4] && right[5] && top[26] && bottom[27]);
    assert_eq!((field.lines().len(), field.object(10)), (15, [SIDE, -SIDE, 0.0]));
}

#[test]
fn a_name_that_control_has_not_is_refused() {
    let expected = Expected::new(as_points(&material("fields", 1, 6, &[0.1])).field, SIZE);
    assert_eq!(expected.name("house r6c9"), Ok(()));
    let why = expected.name("r6c9").unwrap_err();
    assert!(why.contains("none of the 54 targets of --control") && why.contains("from `house r1c1` to `house r6c9`"), "{why}");
}
