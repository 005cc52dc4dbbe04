//! A board as an option.

use calibench_cameras::read_kalibr_target;
use calibench_model::boards::Board;
use calibench_photographs::UNKNOWN;

/// A board, or none that is known.
#[derive(Clone, Copy, Debug)]
pub enum Asked {
    /// This one.
    Board(Board),
    /// Which one is it?
    Unknown,
}

/// As [`board_of`], or `unknown`.
///
/// # Errors
/// As [`board_of`].
pub fn board_or_unknown(text: &str) -> Result<Asked, String> {
    if text == UNKNOWN { Ok(Asked::Unknown) } else { board_of(text).map(Asked::Board) }
}

/// The board of a text, or of a target file of Kalibr's.
///
/// # Errors
/// As [`calibench_photographs::board_of`].
pub fn board_of(text: &str) -> Result<Board, String> {
    calibench_photographs::board_of(text, read_kalibr_target)
}
