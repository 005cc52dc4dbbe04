//! A board as an option.

use calibench_cameras::read_kalibr_target;
use calibench_measure::Board as Counts;
use calibench_model::boards::Board;
use calibench_photographs::{Chessboard, UNKNOWN};

/// What the option says of itself, in every command that has it.
pub const HELP: &str = "The board: 9x6:25 (a chessboard: inner corners, side of a square), charuco:8x5:30:21:DICT_4X4_50, \
    aprilgrid:6x6:0.088:0.3, gridboard:5x7:40:10:DICT_6X6_250, circles:7x5:20, circles:10x10:20:10:20@r10c1, acircles:4x11:20, \
    rings:12:6x5:50:8, puzzle:23x16:30:50,100, dotted:9x6:25, or a target file of Kalibr's (.yaml); lengths in object units";

/// The same, where it may be unknown.
pub const HELP_OR_UNKNOWN: &str = "The board: 9x6 or 9x6:25 (a chessboard: inner corners, side of a square), charuco:8x5:30:21:DICT_4X4_50, aprilgrid:6x6:0.088:0.3, gridboard:5x7:40:10:DICT_6X6_250, circles:7x5:20, \
    circles:10x10:20:10:20@r10c1, acircles:4x11:20, rings:12:6x5:50:8, puzzle:23x16:30:50,100, dotted:9x6:25, or a target file of \
    Kalibr's (.yaml); or `unknown`: what board is there, and by which words is it found?";

/// A board, or none that is known.
#[derive(Clone, Copy, Debug)]
pub enum Asked {
    /// This one.
    Board(Board),
    /// Which one is it?
    Unknown,
}

/// As [`board_to_find`], or `unknown`.
///
/// # Errors
/// As [`board_of`].
pub fn board_or_unknown(text: &str) -> Result<Asked, String> {
    if text == UNKNOWN { Ok(Asked::Unknown) } else { board_to_find(text).map(Asked::Board) }
}

/// As [`board_of`], or a chessboard by its inner corners alone, whose squares then have sides of 1: no length is needed to find it.
///
/// # Errors
/// As [`board_of`].
pub fn board_to_find(text: &str) -> Result<Board, String> {
    if text.starts_with(|first: char| first.is_ascii_digit()) && !text.contains([':', '.']) {
        let board = text.parse::<Counts>().map_err(|error| error.to_string())?;
        return Ok(Chessboard { board, side: 1.0 }.into());
    }
    board_of(text)
}

/// The board of a text, or of a target file of Kalibr's.
///
/// # Errors
/// As [`calibench_photographs::board_of`].
pub fn board_of(text: &str) -> Result<Board, String> {
    calibench_photographs::board_of(text, read_kalibr_target)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn to_be_found_a_chessboard_needs_no_length() {
        let board = |text: &str| match board_or_unknown(text) {
            Ok(Asked::Board(board)) => board.to_string(),
            Ok(Asked::Unknown) => UNKNOWN.to_owned(),
            Err(why) => why,
        };
        assert_eq!(board("9x6"), "chessboard:9x6:1");
        assert_eq!(board("9x6:25"), "chessboard:9x6:25");
        assert_eq!(board("unknown"), UNKNOWN);
        assert!(board("9by6").contains("expected inner corners as COLUMNSxROWS"), "{}", board("9by6"));
        assert!(board("9x6:").contains("COLUMNSxROWS:SIDE"), "{}", board("9x6:"));
        // A file's name may begin with a digit.
        assert!(board("6x6.yaml").starts_with("6x6.yaml: "), "{}", board("6x6.yaml"));
    }
}
