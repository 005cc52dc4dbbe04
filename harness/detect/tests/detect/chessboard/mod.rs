//! Chessboards in pictures that are drawn, and in photographs.

mod drawn;
mod photographs;
mod refusals;

use calibench_detect::detect;
use calibench_model::boards::{Board, Chessboard};
use calibench_model::{Image, PixelPoint};

/// The inner corners of a board, row by row.
fn chessboard(image: &Image, columns: usize, rows: usize) -> Option<Vec<PixelPoint>> {
    let found = detect(image, &Board::Chessboard(Chessboard { columns, rows, square: 1.0 })).ok()?;
    assert_eq!(found.points.len(), columns * rows);
    Some(found.points.iter().map(|point| point.position).collect())
}
