//! The chessboard.

use super::layout::{BoardPoint, Layout, Shape};
use super::{BoardError, counted, length};
use crate::TargetKind;
use crate::testfield::{Outline, PlatePoint};

/// A chessboard, counted in inner corners; `r1c1`, the first, is the origin. The square at the upper left is dark.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chessboard {
    /// Inner corners in a row, 3 to 100.
    pub columns: usize,
    /// Rows of inner corners, 3 to 100.
    pub rows: usize,
    /// The side of a square, object units.
    pub square: f64,
}

impl Chessboard {
    /// What is printed.
    ///
    /// # Errors
    /// A parameter out of its range.
    pub fn layout(&self) -> Result<Layout, BoardError> {
        counted("columns", self.columns, 3..=100)?;
        counted("rows", self.rows, 3..=100)?;
        length("square", self.square)?;
        let squares = (0..=self.rows).flat_map(|row| (0..=self.columns).map(move |column| (row, column)));
        let dark = squares.filter(|(row, column)| (row + column).is_multiple_of(2));
        let shape = |(row, column)| {
            let corners = [(row, column), (row + 1, column), (row + 1, column + 1), (row, column + 1)];
            Shape::dark(Outline::polygon(&corners.map(|(row, column)| self.at(row, column))))
        };
        let inner = (1..=self.rows).flat_map(|row| (1..=self.columns).map(move |column| (row, column)));
        let point = |(row, column)| BoardPoint {
            id: format!("r{row}c{column}"),
            kind: TargetKind::ChessCorner,
            at: self.at(row, column),
            size: self.square,
            turns: ((row + column) % 2) as u32,
            room: self.square,
        };
        let ([u0, v1], [u1, v0]) = (self.at(0, 0), self.at(self.rows + 1, self.columns + 1));
        Ok(Layout {
            points: inner.map(point).collect(),
            markers: Vec::new(),
            shapes: dark.map(shape).collect(),
            printed: [[u0, v0], [u1, v1]],
        })
    }

    /// A corner of squares; (0, 0) is the outermost at the upper left.
    fn at(&self, row: usize, column: usize) -> PlatePoint {
        // Plus zero: a zero without a sign.
        [(column as f64 - 1.0) * self.square, (1.0 - row as f64) * self.square + 0.0]
    }
}
