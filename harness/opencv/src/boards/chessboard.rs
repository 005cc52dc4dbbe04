//! `opencv_find_chessboard`: findChessboardCorners and findChessboardCornersSB.

use calibench_measure::{BoardFinder, BoardPointFound, Settings, Sought};
use calibench_model::boards::Board;
use calibench_model::{Image, Rejection};
use opencv::calib3d::{find_chessboard_corners_def, find_chessboard_corners_sb_def};
use opencv::core::{Point2f, Size, Vector};

use super::{dotted, in_order};
use crate::chessboard::to_8_bit;

/// OpenCV's chessboards, with its own default flags: the whole board is found or none of it. Time has no bound: in an image of noise of 12 megapixels it takes minutes.
///
/// Source: OpenCV, findChessboardCorners (V. Vezhnevets), findChessboardCornersSB (Duda & Frese 2018).
pub struct Chessboards {
    sb: bool,
}

impl Chessboards {
    pub fn new(settings: &Settings) -> Self {
        Self { sb: settings.get("sb") > 0.0 }
    }

    fn corners(&self, image: &Image, size: Size) -> opencv::Result<Option<Vector<Point2f>>> {
        let (grey, mut corners) = (to_8_bit(image)?, Vector::<Point2f>::new());
        let found = if self.sb {
            find_chessboard_corners_sb_def(&grey, size, &mut corners)?
        } else {
            find_chessboard_corners_def(&grey, size, &mut corners)?
        };
        Ok((found && corners.len() as i32 == size.area()).then_some(corners))
    }
}

impl BoardFinder for Chessboards {
    fn unfit(&self, board: &Board) -> Option<String> {
        match board {
            Board::Chessboard(board) if board.columns.min(board.rows) > 2 => None,
            Board::Chessboard(_) => Some("OpenCV finds chessboards from 3 x 3 inner corners on".into()),
            Board::Dotted(board) if self.sb => dotted::unfit(board),
            _ => Some("it finds chessboards, with `sb = 1` also those with three dots".into()),
        }
    }

    fn find(&self, image: &Image, sought: &Sought) -> Result<Vec<BoardPointFound>, Rejection> {
        let found = match &sought.board {
            Board::Chessboard(board) => {
                let size = Size::new(board.columns as i32, board.rows as i32);
                self.corners(image, size).map(|corners| corners.map(|corners| in_order(&corners)))
            }
            Board::Dotted(board) => to_8_bit(image).and_then(|grey| dotted::corners(&grey, board)),
            _ => Ok(None),
        };
        // What OpenCV objects to, an image of a few pixels for one, shows no board.
        found.ok().flatten().ok_or(Rejection::NotDetected)
    }
}
