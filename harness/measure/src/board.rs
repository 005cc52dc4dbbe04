//! Chessboards: what a detector is asked for and what it finds.

use std::str::FromStr;

use calibench_model::{Image, PixelPoint};
use thiserror::Error;

/// A chessboard, counted in inner corners.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Board {
    /// Inner corners in a row.
    pub columns: usize,
    /// Rows of inner corners.
    pub rows: usize,
}

/// Text that is no board.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("`{0}` is no chessboard: expected inner corners as COLUMNSxROWS, each from 3 to 100, as in 9x6")]
pub struct BoardError(String);

impl Board {
    /// Inner corners in all.
    pub fn corners(self) -> usize {
        self.columns * self.rows
    }

    /// The name of inner corner `index`, counted along the rows: `r1c1` is the first.
    pub fn target(self, index: usize) -> String {
        format!("r{}c{}", index / self.columns + 1, index % self.columns + 1)
    }
}

impl FromStr for Board {
    type Err = BoardError;

    fn from_str(text: &str) -> Result<Self, BoardError> {
        let side = |text: &str| text.parse().ok().filter(|n| (3..=100).contains(n));
        let board = text.split_once(['x', 'X']).and_then(|(columns, rows)| Some(Self { columns: side(columns)?, rows: side(rows)? }));
        board.ok_or_else(|| BoardError(text.to_owned()))
    }
}

/// A way of finding a chessboard in an image.
pub trait BoardDetector: Send + Sync {
    /// Its name in records.
    fn name(&self) -> &'static str;

    /// Its version.
    fn version(&self) -> String;

    /// The inner corners of `board`, along its rows, to about a pixel; `None` when it is not seen whole.
    ///
    /// Takes bounded time on any image, also on one without a board.
    fn detect(&self, image: &Image, board: Board) -> Option<Vec<PixelPoint>>;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boards_are_counted_in_inner_corners() {
        let board: Board = "9x6".parse().unwrap();
        assert_eq!((board.columns, board.rows, board.corners()), (9, 6, 54));
        assert_eq!((board.target(0), board.target(8), board.target(9)), ("r1c1".into(), "r1c9".into(), "r2c1".into()));
        for bad in ["9", "9x", "2x6", "9x6x3", "-9x6", "9x1000", "nine x six"] {
            assert!(bad.parse::<Board>().is_err(), "{bad}");
        }
    }
}
