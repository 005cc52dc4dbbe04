//! Boards that are photographed for calibration: what is printed on them, and the names and places of their points.
//!
//! A kind of board is a file with a struct of checked parameters and its `layout`, a variant of [`Board`] and a line of [`KINDS`]; the tests of every kind walk [`examples`].

mod aprilgrid;
mod charuco;
mod chessboard;
mod circles;
mod dictionary;
mod dotted;
mod gridboard;
mod layout;
mod marks;
mod puzzle;
mod rings;
mod text;

use std::ops::RangeInclusive;

use thiserror::Error;

pub use aprilgrid::AprilGrid;
pub use charuco::Charuco;
pub use chessboard::Chessboard;
pub use circles::Circles;
pub use dictionary::{Dictionary, Identified};
pub use dotted::Dotted;
pub use gridboard::GridBoard;
pub use layout::{BoardPoint, Layout, Marker, Shape, marker_shapes, square_marker};
pub use marks::{Form, Mark, Marks};
pub use puzzle::{Puzzle, PuzzleCodes};
pub use rings::{Rings, least_rotation, ring_codes};
pub use text::{KINDS, examples};

/// A board with coded or uncoded marks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Board {
    /// A chessboard.
    Chessboard(Chessboard),
    /// A chessboard with markers.
    Charuco(Charuco),
    /// Rows of AprilTags.
    AprilGrid(AprilGrid),
    /// Rows of ArUco markers.
    GridBoard(GridBoard),
    /// Rows of circles, with an origin or without.
    Circles(Circles),
    /// Rows of ring codes.
    Rings(Rings),
    /// A chessboard with dots on the sides of its squares.
    Puzzle(Puzzle),
    /// A chessboard with three dots.
    Dotted(Dotted),
}

impl Board {
    /// What is printed on it.
    ///
    /// # Errors
    /// A parameter out of its range.
    pub fn layout(&self) -> Result<Layout, BoardError> {
        match self {
            Self::Chessboard(board) => board.layout(),
            Self::Charuco(board) => board.layout(),
            Self::AprilGrid(board) => board.layout(),
            Self::GridBoard(board) => board.layout(),
            Self::Circles(board) => board.layout(),
            Self::Rings(board) => board.layout(),
            Self::Puzzle(board) => board.layout(),
            Self::Dotted(board) => board.layout(),
        }
    }

    /// The length by which it is named, object units: the side of a square or of a marker, or the distance of two circles' centres.
    pub const fn step(&self) -> f64 {
        match self {
            Self::Chessboard(board) => board.square,
            Self::Charuco(board) => board.square,
            Self::AprilGrid(board) => board.tag,
            Self::GridBoard(board) => board.marker,
            Self::Circles(board) => board.spacing,
            Self::Rings(board) => board.spacing,
            Self::Puzzle(board) => board.square,
            Self::Dotted(board) => board.square,
        }
    }

    /// Its kind, as in [`KINDS`].
    pub const fn kind(&self) -> &'static str {
        match self {
            Self::Chessboard(_) => "chessboard",
            Self::Charuco(_) => "charuco",
            Self::AprilGrid(_) => "aprilgrid",
            Self::GridBoard(_) => "gridboard",
            Self::Circles(Circles { asymmetric: true, .. }) => "acircles",
            Self::Circles(_) => "circles",
            Self::Rings(_) => "rings",
            Self::Puzzle(_) => "puzzle",
            Self::Dotted(_) => "dotted",
        }
    }

    /// Whether its marks say which they are: a part of it is enough to number its points.
    pub fn is_coded(&self) -> bool {
        match self {
            Self::Charuco(_) | Self::AprilGrid(_) | Self::GridBoard(_) | Self::Rings(_) | Self::Puzzle(_) | Self::Dotted(_) => true,
            Self::Circles(circles) => circles.is_coded(),
            Self::Chessboard(_) => false,
        }
    }

    /// The dictionary of its markers and the width of their frames, cells, if it has markers.
    pub const fn dictionary(&self) -> Option<(&'static Dictionary, usize)> {
        match self {
            Self::Charuco(board) => Some((board.dictionary, 1)),
            Self::AprilGrid(board) => Some((board.dictionary, board.border)),
            Self::GridBoard(board) => Some((board.dictionary, board.border)),
            Self::Chessboard(_) | Self::Circles(_) | Self::Rings(_) | Self::Puzzle(_) | Self::Dotted(_) => None,
        }
    }
}

/// Why a board cannot be.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum BoardError {
    /// A parameter out of its range.
    #[error("`{parameter}` is {value}: expected {expected}")]
    Parameter {
        /// Its name.
        parameter: &'static str,
        /// The value that was given.
        value: f64,
        /// Values that are allowed.
        expected: String,
    },
    /// A text that describes no board.
    #[error("{0}")]
    Text(String),
}

fn within(parameter: &'static str, value: f64, range: RangeInclusive<f64>) -> Result<(), BoardError> {
    if range.contains(&value) {
        return Ok(());
    }
    let expected = format!("a number from {} to {}", range.start(), range.end());
    Err(BoardError::Parameter { parameter, value, expected })
}

fn counted(parameter: &'static str, count: usize, range: RangeInclusive<usize>) -> Result<(), BoardError> {
    if range.contains(&count) {
        return Ok(());
    }
    let expected = format!("a whole number from {} to {}", range.start(), range.end());
    Err(BoardError::Parameter { parameter, value: count as f64, expected })
}

fn length(parameter: &'static str, value: f64) -> Result<(), BoardError> {
    within(parameter, value, 1e-6..=1e6)
}

/// Whether a dictionary has `count` markers from `first` on.
fn ids(dictionary: &Dictionary, first: u32, count: usize) -> Result<(), BoardError> {
    let most = dictionary.codes.len();
    if first as usize + count <= most {
        return Ok(());
    }
    let expected = format!("at most {most}: the board needs {count} markers, and {} has the ids 0 to {}", dictionary.name, most - 1);
    Err(BoardError::Parameter { parameter: "first", value: f64::from(first), expected })
}

#[cfg(test)]
mod tests;
