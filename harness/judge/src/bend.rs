//! A board that may be bent, or whose corners are where photographs show them.

use std::collections::HashMap;

use calibench_calibrate::Board;
use nalgebra::Point3;

/// How far the corners of a board are out of its plane.
#[derive(Clone, Debug, Default)]
pub struct Bend {
    board: Option<Board>,
    coefficients: [f64; 3],
    /// Of corners that were freed: where they are, object units.
    freed: HashMap<usize, Point3<f64>>,
}

impl Bend {
    /// Of a board, flat yet.
    pub fn of(board: Board) -> Self {
        Self { board: Some(board), ..Self::default() }
    }

    /// The same board with other coefficients, object units.
    #[must_use]
    pub fn with(self, coefficients: [f64; 3]) -> Self {
        Self { coefficients, ..self }
    }

    /// The same board with corners, by their places in the field, where they were found; object units.
    #[must_use]
    pub fn freed(self, corners: impl Iterator<Item = (usize, Point3<f64>)>) -> Self {
        Self { freed: corners.collect(), ..self }
    }

    /// Where a corner is, by its place in the field, that would lie at `flat` if the board were as it is said to be; object units.
    pub fn at(&self, corner: usize, flat: Point3<f64>) -> Point3<f64> {
        if let Some(found) = self.freed.get(&corner) {
            return *found;
        }
        match &self.board {
            Some(board) => flat + board.axes[2] * Board::lift(self.coefficients, board.place(&flat)),
            None => flat,
        }
    }

    /// The greatest difference of height that the bend makes, object units; `None` where none was solved for.
    pub fn deflection(&self) -> Option<f64> {
        self.board.is_some().then(|| Board::deflection(self.coefficients))
    }
}
