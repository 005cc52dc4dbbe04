//! Photographs and approximate positions to measured points: what a user's own photographs go through before a calibration.

pub mod chessboard;
pub mod corners;
mod error;
pub mod names;
pub mod points;
mod trial;

pub use chessboard::{Chessboard, Corners, Photo};
pub use error::PhotographsError;
pub use trial::measured_board;
