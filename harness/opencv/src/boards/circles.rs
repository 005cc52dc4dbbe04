//! `opencv_find_circles`: findCirclesGrid.

use calibench_measure::{BoardFinder, BoardPointFound, Sought};
use calibench_model::boards::Board;
use calibench_model::{Image, Rejection};
use opencv::calib3d::{CALIB_CB_ASYMMETRIC_GRID, CALIB_CB_SYMMETRIC_GRID, find_circles_grid};
use opencv::core::{Point2f, Ptr, Size, Vector};
use opencv::features2d::{Feature2D, SimpleBlobDetector, SimpleBlobDetector_Params};

use super::in_order;
use crate::chessboard::to_8_bit;

/// OpenCV's grids of dark circles, found by its SimpleBlobDetector with its own default parameters: circles of more than 5000 square pixels are none to it.
///
/// Source: OpenCV, findCirclesGrid.
pub struct CirclesGrid;

fn circles(image: &Image, size: Size, flag: i32) -> opencv::Result<Option<Vector<Point2f>>> {
    let (grey, mut centres) = (to_8_bit(image)?, Vector::<Point2f>::new());
    let blobs: Ptr<Feature2D> = SimpleBlobDetector::create(SimpleBlobDetector_Params::default()?)?.into();
    let found = find_circles_grid(&grey, size, &mut centres, flag, Some(&blobs))?;
    Ok((found && centres.len() as i32 == size.area()).then_some(centres))
}

impl BoardFinder for CirclesGrid {
    fn unfit(&self, board: &Board) -> Option<String> {
        match board {
            Board::Circles(circles) if circles.marks.is_empty() => None,
            Board::Circles(_) => Some("it does not read which circles are unlike the others".into()),
            _ => Some("it finds grids of circles alone".into()),
        }
    }

    fn find(&self, image: &Image, sought: &Sought) -> Result<Vec<BoardPointFound>, Rejection> {
        let Board::Circles(board) = sought.board else { return Err(Rejection::NotDetected) };
        let flag = if board.asymmetric { CALIB_CB_ASYMMETRIC_GRID } else { CALIB_CB_SYMMETRIC_GRID };
        let size = Size::new(board.columns as i32, board.rows as i32);
        circles(image, size, flag).ok().flatten().map(|centres| in_order(&centres)).ok_or(Rejection::NotDetected)
    }
}
