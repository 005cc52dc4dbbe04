//! `calib_targets`: the detectors of the crates of that name, unchanged.

use calib_targets_charuco::{CharucoBoardSpec, CharucoDetector, CharucoParams, GrayImageView, resolve_dictionary};
use calib_targets_chessboard::{ChessboardDetector, ChessboardParams, default_chess_config, detect_corner_frame};
use calibench_model::boards::{Board, Charuco, Chessboard};
use calibench_model::{Image, PixelPoint, Rejection};

use crate::finder::{BoardFinder, BoardPointFound, Sought};
use crate::operator::Finds;
use crate::registry::{Build, Method};

/// The crates' version, as locked.
const VERSION: &str = "0.16.1";

/// The crates `calib-targets-chessboard` and `calib-targets-charuco` (V. Vorobyev; MIT or Apache-2.0): the boards in the whole image, as 8-bit grey values, with the
/// crates' own presets. Nothing of them is tuned or changed.
///
/// Source: the crates; ChESS: Bennett & Lasenby 2014.
pub struct CalibTargets;

/// The method's entry.
pub fn method() -> Method {
    Method {
        name: "calib_targets",
        about: "the crates calib-targets: a chessboard or ChArUco board in the whole image",
        source: "crates calib-targets-chessboard, calib-targets-charuco",
        version: VERSION.into(),
        parameters: &[],
        build: Build::With(|_| Box::new(Finds(CalibTargets))),
    }
}

fn chessboard(view: &GrayImageView<'_>, board: &Chessboard) -> Option<Vec<BoardPointFound>> {
    let frame = detect_corner_frame(view, &default_chess_config());
    let found = ChessboardDetector::new(ChessboardParams::default()).ok()?.detect(&frame.corners)?;
    // It finds any chessboard and numbers what it sees from (0, 0), along the image: a board on its side has its columns downwards.
    let lies = |columns: usize, rows: usize| {
        found.corners.iter().all(|corner| (corner.grid.u as usize) < columns && (corner.grid.v as usize) < rows)
    };
    let is_on_its_side = !lies(board.columns, board.rows) && lies(board.rows, board.columns);
    let point = |corner: &calib_targets_chessboard::ChessboardCorner| {
        let (u, v) = (usize::try_from(corner.grid.u).ok()?, usize::try_from(corner.grid.v).ok()?);
        let (column, row) = if is_on_its_side { (v, u) } else { (u, v) };
        // What is more than the board has no place.
        let index = (column < board.columns && row < board.rows).then_some(row * board.columns + column)?;
        Some(BoardPointFound { index, position: place(corner.position.x, corner.position.y) })
    };
    Some(found.corners.iter().filter_map(point).collect())
}

fn charuco(view: &GrayImageView<'_>, board: &Charuco) -> Option<Vec<BoardPointFound>> {
    let dictionary = resolve_dictionary(board.dictionary.name)?;
    let scale = (board.marker / board.square) as f32;
    let spec = CharucoBoardSpec::new(board.rows as u32, board.columns as u32, board.square as f32, scale, dictionary);
    let found = CharucoDetector::new(CharucoParams::for_board(spec)).ok()?.detect(view).ok()?;
    let point = |corner: &calib_targets_charuco::CharucoCorner| BoardPointFound {
        index: corner.id as usize,
        position: place(corner.position.x, corner.position.y),
    };
    Some(found.corners.iter().map(point).collect())
}

fn place(x: f32, y: f32) -> PixelPoint {
    PixelPoint::new(f64::from(x), f64::from(y))
}

impl BoardFinder for CalibTargets {
    fn unfit(&self, board: &Board) -> Option<String> {
        match board {
            Board::Charuco(board) if board.legacy && board.rows.is_multiple_of(2) => {
                Some("the crate knows ChArUco boards as OpenCV makes them since 4.6 alone".into())
            }
            Board::Charuco(board) if board.first > 0 => Some("its ChArUco boards begin with marker 0".into()),
            Board::Charuco(board) if resolve_dictionary(board.dictionary.name).is_none() => {
                Some(format!("the crate has no {}", board.dictionary.name))
            }
            Board::Chessboard(_) | Board::Charuco(_) => None,
            _ => Some("it finds chessboards and ChArUco boards alone".into()),
        }
    }

    fn find(&self, image: &Image, sought: &Sought) -> Result<Vec<BoardPointFound>, Rejection> {
        let grey = image.to_u8();
        let view = GrayImageView { width: image.width(), height: image.height(), data: &grey };
        let found = match &sought.board {
            Board::Chessboard(board) => chessboard(&view, board),
            Board::Charuco(board) => charuco(&view, board),
            _ => None,
        };
        found.map(|found| found.into_iter().filter(|point| point.position.is_finite()).collect()).ok_or(Rejection::NotDetected)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_version_is_the_one_that_is_locked() {
        let mut above = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).ancestors();
        let lock = above.find_map(|folder| std::fs::read_to_string(folder.join("Cargo.lock")).ok()).expect("a lock file");
        for name in ["calib-targets-chessboard", "calib-targets-charuco"] {
            assert!(lock.contains(&format!("name = \"{name}\"\nversion = \"{VERSION}\"")), "{name}");
        }
    }
}
