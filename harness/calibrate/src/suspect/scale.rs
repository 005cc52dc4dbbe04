//! A board among other control: its points, by their names, and whether it is as large as it is said to be beside the others.

use std::collections::HashMap;

use calibench_adjust::approximate::similarity;
use calibench_diagnostics::plain;
use calibench_model::{ControlRow, Points};
use nalgebra::Point3;

use crate::{BoardShape, GrossErrors, Settings, prepare};

/// A share by which the scale must differ from one to be another.
const OTHER: f64 = 5e-3;

/// Share of the misfit of the board as it is stated, wherever it is, that is left with another scale, at most.
const EXPLAINS: f64 = 0.5;

/// Whether a control point has the name of a board's corner: `r1c2`, or `t7c0` of a tag.
fn is_of_board(name: &str) -> bool {
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    name.strip_prefix(['r', 't']).and_then(|rest| rest.split_once('c')).is_some_and(|(line, place)| is_number(line) && is_number(place))
}

/// Words and control with the board as large, and where, as the images show it; `None` where it is as it is stated, or there is no other control.
pub(super) fn other(control: &[ControlRow], settings: &Settings, points: &Points) -> Option<(String, Vec<ControlRow>)> {
    let (board, others): (Vec<&ControlRow>, Vec<&ControlRow>) = control.iter().partition(|row| is_of_board(&row.target));
    if board.len() < 4 || others.len() < 3 {
        return None;
    }
    let free = Settings { shape: BoardShape::Free, gross: GrossErrors::Kept, ..settings.clone() };
    let prepared = prepare(points.clone(), control, &free).ok()?;
    let (solution, ..) = prepared.solution().ok()?;
    let names = prepared.network.points.iter().map(|point| point.name.as_str());
    let found: HashMap<&str, Point3<f64>> = names.zip(solution.points().iter().copied()).collect();
    let pairs = |rows: &[&ControlRow]| -> (Vec<Point3<f64>>, Vec<Point3<f64>>) {
        rows.iter().filter_map(|row| Some((Point3::from(row.position), *found.get(row.target.as_str())?))).unzip()
    };
    let ((stated, there), (stated_board, board_there)) = (pairs(&others), pairs(&board));
    let to_others = similarity(&there, &stated, true).ok()?;
    let in_place: Vec<Point3<f64>> = board_there.iter().map(|at| to_others.apply(at)).collect();
    let of_board = similarity(&stated_board, &in_place, true).ok()?;
    let as_stated = similarity(&stated_board, &in_place, false).ok()?;
    if (of_board.scale - 1.0).abs() < OTHER || of_board.rms > EXPLAINS * as_stated.rms {
        return None;
    }
    let side = stated_board[1..].iter().map(|at| (at - stated_board[0]).norm()).fold(f64::INFINITY, f64::min);
    let what = format!(
        "the board (`{}` and others) is {} times as large beside the other control as is stated: {} from one corner to the next in place of {}",
        board[0].target,
        plain(of_board.scale),
        plain(of_board.scale * side),
        plain(side)
    );
    let moved = |row: &ControlRow| {
        let at = if is_of_board(&row.target) { of_board.apply(&Point3::from(row.position)).into() } else { row.position };
        ControlRow { position: at, ..row.clone() }
    };
    Some((what, control.iter().map(moved).collect()))
}
