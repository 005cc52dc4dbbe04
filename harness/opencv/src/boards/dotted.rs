//! findChessboardCornersSB with marks: chessboards with three dots, also in part.

use std::collections::BTreeMap;

use calibench_measure::BoardPointFound;
use calibench_model::PixelPoint;
use calibench_model::boards::Dotted;
use opencv::calib3d::{CALIB_CB_LARGER, CALIB_CB_MARKER, find_chessboard_corners_sb_with_meta};
use opencv::core::{Mat, MatTraitConst, Point2f, Size, Vector};

use crate::subpix::pixel;

/// What OpenCV says of the square after a corner: a dark one with a light dot, a light one with a dark dot.
const LIGHT_DOT: u8 = 3;
const DARK_DOT: u8 = 4;
/// The least pattern that is looked for: it may be larger.
const LEAST: i32 = 3;

/// A corner in the grid that OpenCV found: row, column.
type Place = [i32; 2];

/// Why OpenCV does not read a board as it is drawn.
pub(super) fn unfit(board: &Dotted) -> Option<String> {
    let [column, row] = board.place;
    (column + row).is_multiple_of(2).then(|| "OpenCV takes the one dark dot for the first: its square has to be light".into())
}

/// The corners of such a board, counted from its dots; none where these are not seen.
pub(super) fn corners(grey: &Mat, board: &Dotted) -> opencv::Result<Option<Vec<BoardPointFound>>> {
    let (mut corners, mut meta) = (Vector::<Point2f>::new(), Mat::default());
    let flags = CALIB_CB_LARGER | CALIB_CB_MARKER;
    if !find_chessboard_corners_sb_with_meta(grey, Size::new(LEAST, LEAST), &mut corners, flags, &mut meta)? {
        return Ok(None);
    }
    let (rows, columns) = (meta.rows(), meta.cols());
    if rows * columns != corners.len() as i32 {
        return Ok(None);
    }
    let places = || (0..rows).flat_map(|row| (0..columns).map(move |column| [row, column]));
    let at: BTreeMap<Place, PixelPoint> = places().zip(corners.iter().map(pixel)).filter(|(_, at)| at.is_finite()).collect();
    let marked = |mark: u8| -> opencv::Result<Vec<Place>> {
        let all = places().map(|place| Ok((place, *meta.at_2d::<u8>(place[0], place[1])?)));
        let all: Vec<(Place, u8)> = all.collect::<opencv::Result<_>>()?;
        Ok(all.into_iter().filter(|(_, own)| *own == mark).map(|(place, _)| place).collect())
    };
    Ok(numbered(&at, &marked(DARK_DOT)?, &marked(LIGHT_DOT)?, board))
}

fn numbered(at: &BTreeMap<Place, PixelPoint>, dark: &[Place], light: &[Place], board: &Dotted) -> Option<Vec<BoardPointFound>> {
    let (&[first], &[one, other]) = (dark, light) else { return None };
    let way = |to: Place| [to[0] - first[0], to[1] - first[1]];
    let seen = |to: Place| {
        let (from, to) = (at.get(&first)?, at.get(&to)?);
        Some([to.x - from.x, to.y - from.y])
    };
    let (a, b) = (seen(one)?, seen(other)?);
    // The way down lies clockwise of the way to the right in the image.
    let (right, down) = if a[0] * b[1] - a[1] * b[0] > 0.0 { (way(one), way(other)) } else { (way(other), way(one)) };
    let is_step = |way: Place| way[0].abs() + way[1].abs() == 1;
    if !is_step(right) || !is_step(down) || right[0] * down[0] + right[1] * down[1] != 0 {
        return None;
    }
    let point = |(place, position): (&Place, &PixelPoint)| {
        // Twice the way from the middle of the first square, which is after its corner in rows and columns.
        let way = [0, 1].map(|i| 2 * (place[i] - first[i]) - 1);
        let along = |axis: Place| way[0] * axis[0] + way[1] * axis[1];
        let index = board.index(board.corner([along(right), along(down)]))?;
        Some(BoardPointFound { index, position: *position })
    };
    let mut points: Vec<BoardPointFound> = at.iter().filter_map(point).collect();
    points.sort_by_key(|point| point.index);
    Some(points)
}
