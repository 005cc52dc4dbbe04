//! Photographs and approximate positions to measured points: what a user's own photographs go through before a calibration.

pub mod chessboard;
pub mod coded;
pub mod corners;
mod error;
mod measured_board;
pub mod names;
pub mod points;
mod turns;

pub use chessboard::{Chessboard, Corners, Photo};
pub use error::PhotographsError;
pub use measured_board::{measured_board, measured_boards, method_info};
pub use turns::turns;
