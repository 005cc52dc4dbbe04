//! Whether each corner lies where the others around it have it.

use super::board::Board;
use crate::plane::{Homography, Point, distance};

/// How far a corner may be from where the eight around it have it, as a share of the shorter step, and px more.
const BENT: f64 = 0.08;
const BENT_PX: f64 = 1.0;
/// Farther off than this it is put there.
const OFF: f64 = 0.025;
const OFF_PX: f64 = 0.75;
/// So large a share of the corners may be put elsewhere.
const MOVED: f64 = 0.06;
/// By how much an error of a point exceeds one of the others: in the middle, on a side and in a corner of nine, of which eight determine an affine map and its twist.
const EXTRAPOLATION: [f64; 3] = [1.06, 1.18, 1.81];

/// Where the eight others of the 3 x 3 around a corner have it, and how much worse they know than in their middle.
fn foreseen(board: &Board, index: usize) -> Option<(Point, f64)> {
    let start = |at: usize, size: usize| at.saturating_sub(1).min(size.saturating_sub(3));
    let [column, row] = board.place(index);
    let (left, top) = (start(column, board.columns), start(row, board.rows));
    let around = (top..top + 3).flat_map(|row| (left..left + 3).map(move |column| [column, row]));
    let local = |[u, v]: [usize; 2]| [u as f64 - column as f64, v as f64 - row as f64];
    let others = around.filter(|place| *place != [column, row]);
    let pairs: Vec<(Point, Point)> = others.map(|place| (local(place), board.corners[place[1] * board.columns + place[0]])).collect();
    let outside = usize::from(column != left + 1) + usize::from(row != top + 1);
    Some((Homography::fitted(&pairs)?.at([0.0, 0.0]), EXTRAPOLATION[outside]))
}

/// How far each corner is off, relative to what its neighbours know, px.
fn off(board: &Board, index: usize) -> f64 {
    foreseen(board, index).map_or(f64::INFINITY, |(at, factor)| distance(at, board.corners[index]) / factor)
}

/// Puts few corners that are off, by the edge of a shadow for instance, to where the others have them; whether there were any.
pub(super) fn straighten(board: &mut Board) -> bool {
    let count = board.corners.len();
    let mut offs: Vec<f64> = (0..count).map(|index| off(board, index)).collect();
    for moved in 0..(MOVED * count as f64) as usize {
        let Some(worst) = (0..count).max_by(|a, b| offs[*a].total_cmp(&offs[*b])) else { return false };
        let limit = OFF * board.step(worst) + OFF_PX;
        let Some((at, _)) = foreseen(board, worst).filter(|_| offs[worst] > limit) else { return moved > 0 };
        board.corners[worst] = at;
        let [column, row] = board.place(worst);
        for (index, own) in offs.iter_mut().enumerate() {
            let [u, v] = board.place(index);
            if u.abs_diff(column) <= 2 && v.abs_diff(row) <= 2 {
                *own = off(board, index);
            }
        }
    }
    true
}

/// Whether no corner is far off.
pub(super) fn is_flat(board: &Board) -> bool {
    (0..board.corners.len()).all(|index| off(board, index) < BENT * board.step(index) + BENT_PX)
}
