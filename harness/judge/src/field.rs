//! What was photographed: points whose object coordinates are known.

use std::borrow::Cow;
use std::cmp::Ordering;

use calibench_calibrate::{OtherBoard, with_corners};
use calibench_diagnostics::nearest;
use calibench_measure::Board;
use calibench_model::boards::{self, BoardError};
use calibench_model::{BoardCorner, ControlRow, escape};

/// A chessboard, or any points of known coordinates: marks on a house, a wall of targets.
#[derive(Clone, Debug, PartialEq)]
pub enum Field {
    /// The inner corners of a chessboard, row by row.
    Board {
        /// How many corners.
        board: Board,
        /// Side of the squares, object units.
        side: f64,
    },
    /// Points by their names.
    Points(Vec<ControlRow>),
    /// Either, with coordinates that were measured in the place of nominal ones.
    Measured {
        /// What it is nominally.
        nominal: Box<Field>,
        /// Of each point X, Y, Z, object units.
        at: Vec<[f64; 3]>,
    },
}

/// A board as what was photographed: a chessboard, or points of known coordinates.
///
/// # Errors
/// A board that cannot be.
pub fn field_of(board: &boards::Board) -> Result<Field, BoardError> {
    if let boards::Board::Chessboard(boards::Chessboard { columns, rows, square }) = *board {
        return Ok(Field::Board { board: Board { columns, rows }, side: square });
    }
    let point = |point: boards::BoardPoint| ControlRow::new(point.id, [point.at[0], point.at[1], 0.0]);
    Ok(Field::Points(board.layout()?.points.into_iter().map(point).collect()))
}

impl Field {
    /// How many points there are.
    pub fn count(&self) -> usize {
        match self {
            Self::Board { board, .. } => board.corners(),
            Self::Points(points) => points.len(),
            Self::Measured { nominal, .. } => nominal.count(),
        }
    }

    /// The name of a point.
    pub fn name(&self, point: usize) -> Cow<'_, str> {
        match self {
            Self::Board { board, .. } => board.target(point).into(),
            Self::Points(points) => points[point].target.as_str().into(),
            Self::Measured { nominal, .. } => nominal.name(point),
        }
    }

    /// Object coordinates of a point. Those of a board, object units from the first corner: X along the rows, Y upwards, Z towards the viewer.
    pub fn object(&self, point: usize) -> [f64; 3] {
        match self {
            Self::Board { board, side } => [(point % board.columns) as f64 * side, -((point / board.columns) as f64 * side), 0.0],
            Self::Points(points) => points[point].position,
            Self::Measured { at, .. } => at[point],
        }
    }

    /// The points as control.
    pub fn control(&self) -> Vec<ControlRow> {
        match self {
            Self::Board { .. } | Self::Measured { .. } => {
                (0..self.count()).map(|point| ControlRow::new(self.name(point), self.object(point))).collect()
            }
            Self::Points(points) => points.clone(),
        }
    }

    /// The same field with the coordinates that a file of measured corners has; their standard deviations are not used.
    ///
    /// # Errors
    /// A file of another board.
    pub fn measured(self, corners: &[BoardCorner]) -> Result<Self, OtherBoard> {
        let at = with_corners(&self.control(), corners)?.into_iter().map(|row| row.position).collect();
        Ok(Self::Measured { nominal: self.into(), at })
    }

    /// Lines of points that are straight in object space: rows and columns of a board. Of other points none is known, and measured ones are on none.
    pub fn lines(&self) -> Vec<Vec<usize>> {
        let Self::Board { board: Board { columns, rows }, .. } = *self else { return Vec::new() };
        let by_row = (0..rows).map(|row| (0..columns).map(|column| row * columns + column).collect());
        let by_column = (0..columns).map(|column| (0..rows).map(|row| row * columns + column).collect());
        by_row.chain(by_column).collect()
    }

    /// Every other point, as the fields of a chessboard, and the rest: of other points every other one along their longest extent.
    pub fn interleaved(&self) -> [Vec<bool>; 2] {
        let first: Vec<bool> = match *self {
            Self::Board { board: Board { columns, .. }, .. } => {
                (0..self.count()).map(|point| (point % columns + point / columns).is_multiple_of(2)).collect()
            }
            Self::Measured { ref nominal, .. } => return nominal.interleaved(),
            Self::Points(_) => self.ranks(0).into_iter().map(|rank| rank.is_multiple_of(2)).collect(),
        };
        let second = first.iter().map(|inside| !inside).collect();
        [first, second]
    }

    /// One side and the other, left, right, top and bottom of a board: of other points, halves along their longest extent and the next.
    pub fn sides(&self) -> [Vec<bool>; 4] {
        let count = self.count();
        let halves: [Vec<bool>; 2] = match *self {
            Self::Board { board: Board { columns, rows }, .. } => [
                (0..count).map(|point| 2 * (point % columns) < columns).collect(),
                (0..count).map(|point| 2 * (point / columns) < rows).collect(),
            ],
            Self::Measured { ref nominal, .. } => return nominal.sides(),
            Self::Points(_) => [0, 1].map(|extent| self.ranks(extent).into_iter().map(|rank| 2 * rank < count).collect()),
        };
        let other = |half: &Vec<bool>| half.iter().map(|inside| !inside).collect();
        let [first, second] = halves;
        [first.clone(), other(&first), second.clone(), other(&second)]
    }

    /// The place of each point in their order along the axis of their `extent`-longest extent; points of one coordinate stand as they are given.
    fn ranks(&self, extent: usize) -> Vec<usize> {
        let at: Vec<[f64; 3]> = (0..self.count()).map(|point| self.object(point)).collect();
        let width = |axis: usize| {
            let (low, high) = at.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| (low.min(at[axis]), high.max(at[axis])));
            high - low
        };
        let mut axes = [0, 1, 2];
        axes.sort_by(|a, b| width(*b).partial_cmp(&width(*a)).unwrap_or(Ordering::Equal));
        let axis = axes[extent];
        let mut order: Vec<usize> = (0..at.len()).collect();
        order.sort_by(|a, b| at[*a][axis].total_cmp(&at[*b][axis]));
        let mut ranks = vec![0; at.len()];
        order.into_iter().enumerate().for_each(|(rank, point)| ranks[point] = rank);
        ranks
    }

    /// What is expected in place of a name that none of the points has, and what to do.
    pub fn stranger(&self, target: &str) -> String {
        if let Self::Measured { nominal, .. } = self {
            return nominal.stranger(target);
        }
        let names: Vec<Cow<'_, str>> = (0..self.count()).map(|point| self.name(point)).collect();
        let mut known: Vec<&str> = names.iter().map(AsRef::as_ref).collect();
        known.sort_unstable();
        let near = nearest(target, known).map_or_else(String::new, |near| format!("; is it `{}`?", escape::name(near)));
        let (first, last) = (&names[0], &names[names.len() - 1]);
        match self {
            Self::Board { board: Board { columns, rows }, .. } => format!(
                "`{target}` is no inner corner of a board of {columns} x {rows}: expected `{first}` (row 1, column 1) to `{last}`, as `calibench control \
                 {columns}x{rows}:SIDE` lists them{near}"
            ),
            Self::Points(points) => format!(
                "`{}` is none of the {} targets of --control: expected one of them, from `{}` to `{}`; add it there, or leave its rows out{near}",
                escape::name(target),
                points.len(),
                escape::name(first),
                escape::name(last)
            ),
            Self::Measured { .. } => String::new(),
        }
    }
}
