//! A board as an option.

use calibench_cameras::read_kalibr_target;
use calibench_model::boards::Board;

/// The board of a text, or of a target file of Kalibr's.
///
/// # Errors
/// As [`calibench_photographs::board_of`].
pub fn board_of(text: &str) -> Result<Board, String> {
    calibench_photographs::board_of(text, read_kalibr_target)
}
