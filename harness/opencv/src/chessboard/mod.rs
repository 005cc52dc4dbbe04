//! A chessboard detector: OpenCV's findChessboardCorners on reduced images, in bounded time.

mod load;

use calibench_measure::{Board, BoardDetector};
use calibench_model::{CornerPoint, Image, PixelPoint};
use opencv::calib3d::{CALIB_CB_ADAPTIVE_THRESH, CALIB_CB_NORMALIZE_IMAGE, check_chessboard, find_chessboard_corners};
use opencv::core::{CV_8U, Mat, MatTraitConst, Point2f, Size, TermCriteria, TermCriteria_COUNT, TermCriteria_EPS, Vector};
use opencv::imgproc::{INTER_AREA, THRESH_BINARY, THRESH_OTSU, corner_sub_pix, median_blur, resize, threshold};

use crate::subpix::pixel;

/// Longer sides of the images that are searched, px, in this order. Larger ones only add noise that looks like squares, and time.
const LEVELS: [i32; 5] = [320, 480, 640, 960, 1280];
/// Half-widths of the refinement's window, px. A much smaller one is caught by the texture of a blurred large image.
const SMALLEST: f64 = 1.0;
const LARGEST: f64 = 30.0;

/// OpenCV's findChessboardCorners, searched from coarse to fine and refined in the full image.
///
/// OpenCV's search has no bound of its own: the time grows with the third power of the quadrangles seen, and the noise of an empty frame of
/// 12 megapixels holds tens of thousands. So the image is reduced to longer sides of 320 to 1280 px, and a level is searched only if OpenCV's
/// checkChessboard sees black and white quadrangles of one size, those that touch are not too many for the board in question, and a budget for the
/// frame allows it.
/// Corners are then refined by cornerSubPix in the full image, with a window of half-width at most a third of a square.
///
/// Where that fails, all levels are searched once more in black and white, which faint noise does not survive.
///
/// A board whose squares are smaller than about 8 px in a frame reduced to 1280 px is not seen, nor is one among many more quadrangles than its own. How much is searched depends on what is counted, never on time. The order is OpenCV's: along the rows, from a corner that is ambiguous when the board is symmetric.
///
/// Source: OpenCV, findChessboardCorners (V. Vezhnevets), checkChessboard, cornerSubPix.
#[derive(Clone, Copy, Debug, Default)]
pub struct ChessboardDetector;

impl BoardDetector for ChessboardDetector {
    fn name(&self) -> &'static str {
        "opencv_chessboard"
    }

    fn version(&self) -> String {
        crate::version()
    }

    fn detect(&self, image: &Image, board: Board) -> Option<Vec<PixelPoint>> {
        // What OpenCV objects to, an image of a few pixels for one, shows no board.
        detect(image, board).ok().flatten()
    }
}

fn detect(image: &Image, board: Board) -> opencv::Result<Option<Vec<PixelPoint>>> {
    let full = to_8_bit(image)?;
    let longer = longer_side(&full);
    let mut budget = load::BUDGET;
    let own = (longer <= LEVELS[LEVELS.len() - 1]).then_some(longer);
    let levels = LEVELS.into_iter().filter(|&level| level < longer).chain(own).map(|level| reduce(&full, level));
    let levels = levels.collect::<opencv::Result<Vec<Mat>>>()?;
    for two_greys in [false, true] {
        for reduced in &levels {
            let found =
                if two_greys { search(&black_and_white(reduced)?, board, &mut budget)? } else { search(reduced, board, &mut budget)? };
            if let Some(corners) = found {
                return descend(&full, reduced.clone(), board, corners.iter().map(pixel).collect()).map(Some);
            }
        }
    }
    Ok(None)
}

/// Refines the corners in the reduced image and in ever larger ones, each at most twice the last, down to the full one: what a corner lacks
/// is then never more than a few pixels, and texture nearby does not catch it.
fn descend(full: &Mat, mut level: Mat, board: Board, corners: Vec<PixelPoint>) -> opencv::Result<Vec<PixelPoint>> {
    let mut corners = refine(&level, board, corners)?;
    while level.size()? != full.size()? {
        let next = reduce(full, 2 * longer_side(&level))?;
        corners = corners.into_iter().map(|corner| enlarge(corner, &level, &next)).collect();
        corners = refine(&next, board, corners)?;
        level = next;
    }
    Ok(corners)
}

fn longer_side(image: &Mat) -> i32 {
    image.cols().max(image.rows())
}

/// Full scale becomes 255; NaN becomes black.
pub(crate) fn to_8_bit(image: &Image) -> opencv::Result<Mat> {
    let header = Mat::new_rows_cols_with_data(image.height() as i32, image.width() as i32, image.grey())?;
    let mut bytes = Mat::default();
    header.convert_to(&mut bytes, CV_8U, 255.0, 0.0)?;
    Ok(bytes)
}

/// The image reduced to a longer side of `longer` px, or itself if it is no larger.
fn reduce(full: &Mat, longer: i32) -> opencv::Result<Mat> {
    let factor = (f64::from(longer) / f64::from(longer_side(full))).min(1.0);
    let side = |px: i32| ((f64::from(px) * factor).round() as i32).max(1);
    let mut reduced = Mat::default();
    resize(full, &mut reduced, Size::new(side(full.cols()), side(full.rows())), 0.0, 0.0, INTER_AREA)?;
    Ok(reduced)
}

/// The corners in an image, if it is worth a search that the budget allows, and that finds them.
fn search(image: &Mat, board: Board, budget: &mut usize) -> opencv::Result<Option<Vector<Point2f>>> {
    let size = Size::new(board.columns as i32, board.rows as i32);
    if !check_chessboard(image, size)? {
        return Ok(None);
    }
    match load::cost(image, board)?.and_then(|cost| budget.checked_sub(cost)) {
        Some(rest) => *budget = rest,
        None => return Ok(None),
    }
    let mut corners = Vector::<Point2f>::new();
    let found = find_chessboard_corners(image, size, &mut corners, CALIB_CB_ADAPTIVE_THRESH | CALIB_CB_NORMALIZE_IMAGE)?;
    Ok((found && corners.len() == board.corners()).then_some(corners))
}

/// The image in two grey values, split by Otsu's threshold. OpenCV's search stretches the contrast, and faint noise in a wide plain background then
/// looks like thousands of quadrangles; here it is gone.
fn black_and_white(image: &Mat) -> opencv::Result<Mat> {
    let (mut calm, mut binary) = (Mat::default(), Mat::default());
    median_blur(image, &mut calm, 3)?;
    threshold(&calm, &mut binary, 0.0, 255.0, THRESH_BINARY | THRESH_OTSU)?;
    Ok(binary)
}

/// The same place in a larger version of the image: outer corners of pixels scale, their centres do not.
fn enlarge(point: PixelPoint, from: &Mat, to: &Mat) -> PixelPoint {
    let corner = point.to_corner();
    let (sx, sy) = (ratio(to.cols(), from.cols()), ratio(to.rows(), from.rows()));
    CornerPoint { x: corner.x * sx, y: corner.y * sy }.to_pixel()
}

fn ratio(to: i32, from: i32) -> f64 {
    f64::from(to) / f64::from(from)
}

/// Refines by cornerSubPix, with a window of half-width at most a third of the shortest square's side.
fn refine(image: &Mat, board: Board, corners: Vec<PixelPoint>) -> opencv::Result<Vec<PixelPoint>> {
    let half = (spacing(board, &corners) / 3.0).clamp(SMALLEST, LARGEST) as i32;
    // OpenCV refuses images that do not exceed the window by four pixels.
    if image.cols().min(image.rows()) < 2 * half + 5 {
        return Ok(corners);
    }
    let mut points: Vec<Point2f> = corners.iter().map(|corner| Point2f::new(corner.x as f32, corner.y as f32)).collect();
    let criteria = TermCriteria::new(TermCriteria_COUNT | TermCriteria_EPS, 40, 1e-3)?;
    corner_sub_pix(image, &mut Mat::from_slice_mut(&mut points)?, Size::new(half, half), Size::new(-1, -1), criteria)?;
    Ok(points.into_iter().map(pixel).collect())
}

/// The shortest side of a square, px.
fn spacing(board: Board, corners: &[PixelPoint]) -> f64 {
    let along = corners.chunks(board.columns).flat_map(|row| row.windows(2).map(|pair| pair[0].distance(pair[1])));
    let across = corners.iter().zip(corners.iter().skip(board.columns)).map(|(a, b)| a.distance(*b));
    along.chain(across).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
pub(crate) mod tests;
