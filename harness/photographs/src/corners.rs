//! A chessboard's corners as approximate positions.

use calibench_exchange::PointRow;
use calibench_measure::{Board, BoardDetector};
use calibench_model::{Affine, Image, PixelPoint, Start, TargetKind};

/// The corners of a board in the photograph `name`; none if it is not seen whole.
pub(crate) fn corners_of(detector: &dyn BoardDetector, image: &Image, name: &str, board: Board) -> Vec<PointRow> {
    let corners = detector.detect(image, board).unwrap_or_default();
    let row = |(index, position): (usize, &PixelPoint)| PointRow {
        image: name.to_owned(),
        target: board.target(index),
        start: Start { kind: Some(TargetKind::ChessCorner), affine: Some(affine(&corners, board, index)), ..Start::at(*position) },
    };
    corners.iter().enumerate().map(row).collect()
}

/// One square along the rows and one along the columns, px, from the neighbouring corners.
fn affine(corners: &[PixelPoint], board: Board, index: usize) -> Affine {
    let (column, row) = (index % board.columns, index / board.columns);
    let at = |column: usize, row: usize| corners[row * board.columns + column];
    let step = |low: PixelPoint, high: PixelPoint, squares: usize| {
        let n = squares.max(1) as f64;
        ((high.x - low.x) / n, (high.y - low.y) / n)
    };
    let (west, east) = (column.saturating_sub(1), (column + 1).min(board.columns - 1));
    let (north, south) = (row.saturating_sub(1), (row + 1).min(board.rows - 1));
    let (axx, ayx) = step(at(west, row), at(east, row), east - west);
    let (axy, ayy) = step(at(column, north), at(column, south), south - north);
    Affine { axx, axy, ayx, ayy }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_affine_start_is_one_square() {
        let board: Board = "4x3".parse().unwrap();
        let corners: Vec<PixelPoint> = (0..12)
            .map(|i| (f64::from(i % 4), f64::from(i / 4)))
            .map(|(u, v)| PixelPoint::new(20.0 * u - 3.0 * v, 2.0 * u + 18.0 * v))
            .collect();
        for index in 0..12 {
            assert_eq!(affine(&corners, board, index), Affine { axx: 20.0, axy: -3.0, ayx: 2.0, ayy: 18.0 });
        }
    }
}
