//! Which file finds which kind of board.

use calibench_model::Image;
use calibench_model::boards::Board;

use crate::{Found, NotFound, chessboard, circles, codes, dotted, markers, puzzle};

/// The least side of an image, px.
const LEAST_SIDE: usize = 16;

/// The points of `board` that are seen in `image`, to about a pixel.
///
/// Of boards with markers, ring codes and PuzzleBoards a part is enough, of a chessboard with dots one with all three of them. Of grids of circles with an origin a part is enough that shows it. Other grids of circles and chessboards have to be seen whole; few of their points may be left out that are not seen, which is said. Of a chessboard's corners, the ends of the
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
        Board::Charuco(_) | Board::AprilGrid(_) | Board::GridBoard(_) => markers::detect(image, board, &layout),
        Board::Circles(circles) => circles::detect(image, circles, &layout),
        Board::Rings(rings) => codes::detect(image, rings, &layout),
        Board::Dotted(board) => dotted::detect(image, board, &layout),
        Board::Puzzle(board) => puzzle::detect(image, board, &layout),
        Board::Chessboard(board) => chessboard::detect(image, board, &layout),
    }
}

/// The board if it is found in the image, with what is found of it.
pub(crate) fn proved(image: &Image, board: Board) -> Option<(Board, Found)> {
    let found = detect(image, &board).ok()?;
    (!found.points.is_empty()).then_some((board, found))
}
