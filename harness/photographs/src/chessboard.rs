//! A chessboard as options write it.

use std::str::FromStr;

use calibench_measure::Board;

/// A chessboard and the side of its squares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chessboard {
    /// Its inner corners.
    pub board: Board,
    /// Side of a square, object units.
    pub side: f64,
}

impl FromStr for Chessboard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong =
            || format!("`{text}` is no chessboard: expected inner corners and the side of a square as COLUMNSxROWS:SIDE, as in 9x6:25");
        let (board, side) = text.split_once(':').ok_or_else(wrong)?;
        let board = board.parse().map_err(|_| wrong())?;
        let side = side.parse().ok().filter(|side: &f64| side.is_finite() && *side > 0.0).ok_or_else(wrong)?;
        Ok(Self { board, side })
    }
}

impl From<Chessboard> for calibench_model::boards::Board {
    fn from(Chessboard { board, side }: Chessboard) -> Self {
        Self::Chessboard(calibench_model::boards::Chessboard { columns: board.columns, rows: board.rows, square: side })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_chessboard_is_seen_from_its_front() {
        let board: Chessboard = "3x4:2.5".parse().unwrap();
        let control = crate::Finder::new(board.into()).unwrap().control();
        assert_eq!(control.len(), 12);
        assert_eq!((control[4].target.as_str(), control[4].position), ("r2c2", [2.5, -2.5, 0.0]));
        for wrong in ["9x6", "9x6:", "9x6:0", "9x6:-1", "9x6:NaN", "9:25", "2x2:1"] {
            assert!(wrong.parse::<Chessboard>().is_err(), "{wrong}");
        }
    }
}
