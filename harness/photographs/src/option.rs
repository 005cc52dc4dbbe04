//! A board as options write it: in words, or as a file.

use std::fmt::Display;
use std::path::Path;

use calibench_model::boards::{Board, KINDS};

use crate::Chessboard;

/// What is asked for where nothing is known.
pub const UNKNOWN: &str = "unknown";

/// The board of a text: `9x6:25` for a chessboard, a kind with its counts and lengths, or a target file of Kalibr's (`.yaml`), which `of_file` reads.
///
/// # Errors
/// A text that describes no board, with the kinds that there are; a file that cannot be read.
pub fn board_of<E: Display>(text: &str, of_file: impl Fn(&Path) -> Result<Board, E>) -> Result<Board, String> {
    let ending = Path::new(text).extension().map(std::ffi::OsStr::to_ascii_lowercase);
    if ending.is_some_and(|ending| ending == "yaml" || ending == "yml") {
        return of_file(Path::new(text)).map_err(|error| format!("{text}: {error}"));
    }
    if text.starts_with(|first: char| first.is_ascii_digit()) {
        return text.parse::<Chessboard>().map(Board::from);
    }
    if text == UNKNOWN {
        return Err(format!("`{UNKNOWN}`: `detect --board {UNKNOWN}` names the board that is there; expected a board"));
    }
    text.parse::<Board>().map_err(|error| {
        let kinds = KINDS.map(|(kind, form, _)| format!("{kind}:{form}")).join(", ");
        format!("{error} ({kinds}, or a target file of Kalibr's)")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boards_are_written_in_three_ways() {
        let grid: Board = "aprilgrid:6x6:0.088:0.3".parse().unwrap();
        let of_file = |path: &Path| if path == Path::new("target.yaml") { Ok(grid) } else { Err("no such file") };
        let board_of = |text: &str| board_of(text, of_file);
        assert_eq!(board_of("9x6:25"), Ok("chessboard:9x6:25".parse().unwrap()));
        assert_eq!(board_of("charuco:8x5:30:21:DICT_4X4_50"), Ok("charuco:8x5:30:21:DICT_4X4_50".parse().unwrap()));
        assert_eq!(board_of("target.yaml"), Ok(grid));
        for (text, said) in [
            ("9x6", "is no chessboard"),
            ("mine", "is no kind of board: expected one of chessboard"),
            ("rings:12", "no count"),
            ("unknown", "`detect --board unknown` names the board that is there"),
            ("missing.yaml", "missing.yaml: no such file"),
        ] {
            let error = board_of(text).unwrap_err();
            assert!(error.contains(said), "{error}");
        }
    }
}
