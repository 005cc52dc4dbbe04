//! Photographs and approximate positions to measured points: what a user's own photographs go through before a calibration.

pub mod chessboard;
pub mod coded;
mod copies;
mod error;
mod finder;
mod folders;
pub mod measured;
mod measured_board;
pub mod names;
mod option;
pub mod points;
mod reader;
mod turns;
pub mod unknown;

pub use calibench_detect::Identified;
pub use chessboard::Chessboard;
pub use error::PhotographsError;
pub use finder::{Finder, Sighting};
pub use folders::in_folders;
pub use measured::{Corners, Photo};
pub use measured_board::{MeasuredBoards, measured_board, measured_boards, method_info};
pub use option::{UNKNOWN, board_of};
pub use reader::{Asked, Reader};

/// The example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
