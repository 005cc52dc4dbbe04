//! Boards with coded or uncoded marks in an image: which of their points are seen, and where to about a pixel.
//!
//! [`detect`] takes an image and a [`Board`], and says which points it sees or, by name, why it sees no such board. It never numbers what contradicts the
//! board. No pose, no camera, no truth. One thread, the same bytes every time.
//!
//! Markers are looked for as dark quadrangles whose sides are adjusted to the edges of the image, discs as round dark areas, the corners of chessboards and PuzzleBoards as saddles. What is decoded has to stand as the board
//! has it, each mark to its neighbours; so lens distortion does no harm.

mod arrange;
mod cells;
mod chessboard;
mod circles;
mod codes;
mod corners;
mod dotted;
mod error;
mod found;
mod ground;
mod instead;
mod lattice;
mod markers;
mod meeting;
mod parts;
mod patches;
mod plane;
mod puzzle;
mod quads;
mod reasons;
mod round;
mod saddle;
mod sectors;

use calibench_model::Image;
use calibench_model::boards::Board;

pub use error::NotFound;
pub use found::{Doubt, Found, FoundPoint};

/// The version of what finds boards, in records.
pub const VERSION: &str = "2";

/// The least side of an image, px.
const LEAST_SIDE: usize = 16;

/// The points of `board` that are seen in `image`, to about a pixel.
///
/// Of boards with markers, ring codes and PuzzleBoards a part is enough, of a chessboard with dots one with all three of them. Chessboards and grids of circles have to be seen whole; of a chessboard's corners few may be left out that are not seen, which is said. Of a chessboard's corners, the ends of the
/// board with a dark square at its corner are where `r1c1` can be, where there are such; circles may be dark on light or light on dark. Where a half turn leaves a
/// board as it was (every symmetric one; an asymmetric one with an even number of rows) `r1c1` is the corner nearest to the upper left of the image, and so is it
/// among the four quarter turns of a symmetric grid with as many rows as columns.
///
/// # Errors
/// [`NotFound`]: what was seen instead.
pub fn detect(image: &Image, board: &Board) -> Result<Found, NotFound> {
    let layout = board.layout()?;
    let (width, height) = (image.width(), image.height());
    if width.min(height) < LEAST_SIDE {
        return Err(NotFound::TooSmall { width, height, least: LEAST_SIDE });
    }
    match board {
        Board::Charuco(_) | Board::AprilGrid(_) => markers::detect(image, board, &layout),
        Board::Circles(circles) => circles::detect(image, circles, &layout),
        Board::Rings(rings) => codes::detect(image, rings, &layout),
        Board::Dotted(board) => dotted::detect(image, board, &layout),
        Board::Puzzle(board) => puzzle::detect(image, board, &layout),
        Board::Chessboard(board) => chessboard::detect(image, board, &layout),
    }
}

/// The example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
