//! Whether OpenCV's search of an image would end soon.

use calibench_measure::Board;
use opencv::core::{CV_32S, Mat, MatTraitConst, Point, Vec4i, Vector, bitwise_not_def};
use opencv::imgproc::{
    ADAPTIVE_THRESH_MEAN_C, CHAIN_APPROX_SIMPLE, RETR_CCOMP, THRESH_BINARY, adaptive_threshold, approx_poly_dp, bounding_rect,
    connected_components, dilate_def, equalize_hist, find_contours_with_hierarchy, is_contour_convex,
};

/// Most work that a search may have: superfluous quadrangles times the square of all. OpenCV drops the superfluous one by one, and for each
/// weighs all that are left. On one core of 3 GHz this much takes about a second.
const MOST_WORK: usize = 1_500_000;
/// Most dark areas of any form. Counting them is quick; following the outlines of the hundred thousand in noise takes seconds.
const MOST_AREAS: i32 = 20_000;
/// The smallest quadrangle that OpenCV takes up: area of its bounding box, px^2.
const SMALLEST: i32 = 25;
/// Tolerances at which OpenCV tries to see a contour as a quadrangle, px.
const TOLERANCES: [f64; 7] = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];

/// Whether the quadrangles in `image` are few enough for a search for `board`.
///
/// They are counted as findChessboardCorners sees them in its first adaptive passes, where noise shows most.
pub(super) fn is_bearable(image: &Mat, board: Board) -> opencv::Result<bool> {
    let mut equal = Mat::default();
    equalize_hist(image, &mut equal)?;
    let mut pass = Mat::default();
    let block = (f64::from(image.cols().min(image.rows())) * 0.2).round() as i32 | 1;
    adaptive_threshold(&equal, &mut pass, 255.0, ADAPTIVE_THRESH_MEAN_C, THRESH_BINARY, block.max(3), 0.0)?;
    let mut dilated = Mat::default();
    dilate_def(&pass, &mut dilated, &Mat::default())?;
    let most = most_quadrangles(board);
    Ok(!exceeds(&pass, most)? && !exceeds(&dilated, most)?)
}

/// The most quadrangles that keep within [`MOST_WORK`]: at least the dark squares of the board.
fn most_quadrangles(board: Board) -> usize {
    let dark = ((board.columns + 1) * (board.rows + 1)).div_ceil(2);
    let bearable = |superfluous: usize| superfluous * (dark + superfluous).pow(2) <= MOST_WORK;
    dark + (1..MOST_WORK).take_while(|&superfluous| bearable(superfluous)).count()
}

fn exceeds(binary: &Mat, most: usize) -> opencv::Result<bool> {
    let (mut dark, mut labels) = (Mat::default(), Mat::default());
    bitwise_not_def(binary, &mut dark)?;
    if connected_components(&dark, &mut labels, 8, CV_32S)? > MOST_AREAS {
        return Ok(true);
    }
    let (mut contours, mut hierarchy) = (Vector::<Vector<Point>>::new(), Vector::<Vec4i>::new());
    find_contours_with_hierarchy(binary, &mut contours, &mut hierarchy, RETR_CCOMP, CHAIN_APPROX_SIMPLE, Point::new(0, 0))?;
    let mut count = 0;
    for (contour, relation) in contours.iter().zip(&hierarchy) {
        // Dark areas are holes: they have a parent.
        if relation[3] >= 0 && is_quadrangle(&contour)? {
            count += 1;
        }
        if count > most {
            return Ok(true);
        }
    }
    Ok(false)
}

fn is_quadrangle(contour: &Vector<Point>) -> opencv::Result<bool> {
    if bounding_rect(contour)?.area() < SMALLEST {
        return Ok(false);
    }
    for tolerance in TOLERANCES {
        let mut polygon = Vector::<Point>::new();
        approx_poly_dp(contour, &mut polygon, tolerance, true)?;
        if polygon.len() <= 4 {
            return Ok(polygon.len() == 4 && is_contour_convex(&polygon)?);
        }
    }
    Ok(false)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_board_is_always_allowed_its_own_squares() {
        assert_eq!(most_quadrangles(Board { columns: 9, rows: 6 }), 127);
        assert_eq!(most_quadrangles(Board { columns: 100, rows: 100 }), 5101);
    }
}
