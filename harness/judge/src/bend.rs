//! A board that may be bent.

use calibench_calibrate::Board;
use nalgebra::Point3;

/// How far the corners of a board are out of its plane.
#[derive(Clone, Debug, Default)]
pub struct Bend {
    board: Option<Board>,
    coefficients: [f64; 3],
}

impl Bend {
    /// Of a board, flat yet.
    pub fn of(board: Board) -> Self {
        Self { board: Some(board), coefficients: [0.0; 3] }
    }

    /// The same board with other coefficients, object units.
    #[must_use]
    pub fn with(self, coefficients: [f64; 3]) -> Self {
        Self { coefficients, ..self }
    }

    /// Where a corner is that would lie at `flat` if the board were flat; object units.
    pub fn at(&self, flat: Point3<f64>) -> Point3<f64> {
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
