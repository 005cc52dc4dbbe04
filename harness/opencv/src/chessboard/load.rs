//! Whether OpenCV's search of an image would end soon.

use calibench_measure::Board;
use opencv::core::{CV_32S, Mat, MatTraitConst, Point, Vec4i, Vector, bitwise_not_def};
use opencv::imgproc::{
    ADAPTIVE_THRESH_MEAN_C, CHAIN_APPROX_SIMPLE, RETR_CCOMP, THRESH_BINARY, adaptive_threshold, approx_poly_dp, bounding_rect,
    connected_components, dilate_def, equalize_hist, find_contours_with_hierarchy, is_contour_convex,
};

/// Most work that a search may have: superfluous quadrangles of a group times the square of all of it. OpenCV drops the superfluous one by one, and for each
/// weighs all that are left of the group. On one core of 3 GHz this much takes about a second.
const MOST_WORK: usize = 1_500_000;
/// What may be spent on all searches in a frame: the square of the quadrangles of each, since each is compared with each, in images of 640 x 480 px and
/// smaller ones; in larger ones as much more as they have pixels. On one core of 3 GHz this much takes half a second.
pub(super) const BUDGET: usize = 270_000;
/// Pixels of an image whose thresholds cost little beside its quadrangles.
const PIXELS: usize = 640 * 480;
/// Sides of the blocks of OpenCV's first adaptive passes, as a share of the image's shorter side.
const BLOCKS: [f64; 2] = [0.2, 0.1];
/// Most dark areas of any form. Counting them is quick; following the outlines of the hundred thousand in noise takes seconds.
const MOST_AREAS: i32 = 20_000;
/// The smallest quadrangle that OpenCV takes up: area of its bounding box, px^2.
const SMALLEST: i32 = 25;
/// Tolerances at which OpenCV tries to see a contour as a quadrangle, px.
const TOLERANCES: [f64; 7] = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];

/// What a search for `board` costs, of [`BUDGET`]; `None` if quadrangles that touch are too many.
///
/// They are counted as findChessboardCorners sees them in its first adaptive passes, where noise shows most, in groups whose corners touch.
pub(super) fn cost(image: &Mat, board: Board) -> opencv::Result<Option<usize>> {
    let mut equal = Mat::default();
    equalize_hist(image, &mut equal)?;
    let mut most = 0;
    for share in BLOCKS {
        let (mut pass, mut dilated) = (Mat::default(), Mat::default());
        let block = (f64::from(image.cols().min(image.rows())) * share).round() as i32 | 1;
        adaptive_threshold(&equal, &mut pass, 255.0, ADAPTIVE_THRESH_MEAN_C, THRESH_BINARY, block.max(3), 0.0)?;
        dilate_def(&pass, &mut dilated, &Mat::default())?;
        for binary in [&pass, &dilated] {
            let Some(found) = quadrangles(binary)? else { return Ok(None) };
            if work(&groups(&found), board) > MOST_WORK {
                return Ok(None);
            }
            most = most.max(found.len());
        }
    }
    let pixels = (image.cols() * image.rows()) as usize;
    Ok(Some(most * most * pixels.div_ceil(PIXELS)))
}

/// What OpenCV has to do with groups of so many quadrangles each.
fn work(groups: &[usize], board: Board) -> usize {
    let dark = ((board.columns + 1) * (board.rows + 1)).div_ceil(2);
    groups.iter().map(|&all| all.saturating_sub(dark).saturating_mul(all.saturating_mul(all))).fold(0, usize::saturating_add)
}

type Quadrangle = [Point; 4];

/// The dark quadrangles; `None` if they are too many.
fn quadrangles(binary: &Mat) -> opencv::Result<Option<Vec<Quadrangle>>> {
    let (mut dark, mut labels) = (Mat::default(), Mat::default());
    bitwise_not_def(binary, &mut dark)?;
    if connected_components(&dark, &mut labels, 8, CV_32S)? > MOST_AREAS {
        return Ok(None);
    }
    let (mut contours, mut hierarchy) = (Vector::<Vector<Point>>::new(), Vector::<Vec4i>::new());
    find_contours_with_hierarchy(binary, &mut contours, &mut hierarchy, RETR_CCOMP, CHAIN_APPROX_SIMPLE, Point::new(0, 0))?;
    let mut found = Vec::new();
    for (contour, relation) in contours.iter().zip(&hierarchy) {
        // Dark areas are holes: they have a parent.
        if relation[3] >= 0 {
            found.extend(quadrangle(&contour)?);
        }
        if found.len().pow(2) > BUDGET {
            return Ok(None);
        }
    }
    Ok(Some(found))
}

/// A contour with four convex corners at some tolerance.
fn quadrangle(contour: &Vector<Point>) -> opencv::Result<Option<Quadrangle>> {
    if bounding_rect(contour)?.area() < SMALLEST {
        return Ok(None);
    }
    for tolerance in TOLERANCES {
        let mut polygon = Vector::<Point>::new();
        approx_poly_dp(contour, &mut polygon, tolerance, true)?;
        if polygon.len() <= 4 {
            let corners: Option<Quadrangle> = polygon.iter().collect::<Vec<_>>().try_into().ok();
            return Ok(if is_contour_convex(&polygon)? { corners } else { None });
        }
    }
    Ok(None)
}

/// The sizes of the groups of quadrangles that OpenCV may join: corners no farther apart than the shortest side of either.
fn groups(quadrangles: &[Quadrangle]) -> Vec<usize> {
    let square = |a: Point, b: Point| (i64::from(a.x - b.x)).pow(2) + (i64::from(a.y - b.y)).pow(2);
    let side = |q: &Quadrangle| (0..4).map(|i| square(q[i], q[(i + 1) % 4])).min().unwrap_or(0);
    let sides: Vec<i64> = quadrangles.iter().map(side).collect();
    let touch = |i: usize, k: usize| {
        let reach = sides[i].min(sides[k]);
        quadrangles[i].iter().any(|a| quadrangles[k].iter().any(|b| square(*a, *b) <= reach))
    };
    let (mut left, mut found): (Vec<usize>, _) = ((0..quadrangles.len()).collect(), Vec::new());
    while let Some(first) = left.pop() {
        let (mut open, mut count) = (vec![first], 0);
        while let Some(next) = open.pop() {
            count += 1;
            let joined = left.extract_if(.., |other| touch(next, *other));
            open.extend(joined);
        }
        found.push(count);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(x: i32, y: i32, side: i32) -> Quadrangle {
        [(0, 0), (side, 0), (side, side), (0, side)].map(|(dx, dy)| Point::new(x + dx, y + dy))
    }

    #[test]
    fn squares_that_touch_are_a_group_and_others_are_not() {
        // The dark squares of a board of 6 x 4, corner to corner, and dirt beside it.
        let dark = (0..24).filter(|i| (i % 6 + i / 6) % 2 == 0).map(|i| square(20 * (i % 6), 20 * (i / 6), 18));
        let dirt = (0..5).map(|i| square(200 + 40 * i, 7, 6));
        let mut found = groups(&dark.chain(dirt).collect::<Vec<_>>());
        found.sort_unstable();
        assert_eq!(found, [1, 1, 1, 1, 1, 12]);
        assert!(groups(&[]).is_empty());
    }

    #[test]
    fn a_board_is_always_allowed_its_own_squares_and_what_does_not_touch_it() {
        let work = |groups: &[usize]| work(groups, Board { columns: 9, rows: 6 });
        assert_eq!(work(&[35]), 0);
        assert_eq!(work(&[&[35][..], &[1; 1400]].concat()), 0);
        assert_eq!(work(&[36, 40]), 36 * 36 + 5 * 40 * 40);
        assert!(work(&[usize::MAX]) > MOST_WORK);
    }
}
