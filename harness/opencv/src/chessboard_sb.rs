//! `opencv_chessboard_sb`: OpenCV's findChessboardCornersSB.

use calibench_measure::operator::nearest_detected;
use calibench_measure::registry::{Build, Method};
use calibench_measure::{Operator, Settings};
use calibench_model::{Image, Measurement, PixelPoint, Rejection, Start};
use opencv::calib3d::{CALIB_CB_ACCURACY, CALIB_CB_EXHAUSTIVE, CALIB_CB_NORMALIZE_IMAGE, find_chessboard_corners_sb};
use opencv::core::{Point2f, Size, Vector};

use crate::chessboard::to_8_bit;
use crate::subpix::pixel;

/// OpenCV's findChessboardCornersSB, unchanged, with its flags off unless they are asked for: the board is sought in the whole image, as 8-bit grey values; a start
/// is given the nearest corner of the board within `radius` px.
///
/// It needs the whole board in view, with a bright rim, and its number of inner corners: where the board is not found, every start is rejected. It sees
/// 8 bits, whatever the image has; grey values that are no numbers are black. It gives no covariance. Many starts on one image share one search.
/// The search has no bound of its own: an image of noise of 3 megapixels takes about a third of a second, with `exhaustive=1` some seconds.
///
/// Source: Duda & Frese 2018, Accurate Detection and Localization of Checkerboard Corners for Calibration; OpenCV, findChessboardCornersSB.
pub struct ChessboardSb {
    board: Size,
    flags: i32,
    radius: f64,
}

/// The method's entry.
pub fn method() -> Method {
    let build = Build::With(|settings| Box::new(ChessboardSb::new(settings)));
    calibench_measure::opencv_chessboard_sb::method(build, crate::version())
}

impl ChessboardSb {
    fn new(settings: &Settings) -> Self {
        let flags = [("accuracy", CALIB_CB_ACCURACY), ("exhaustive", CALIB_CB_EXHAUSTIVE), ("normalize", CALIB_CB_NORMALIZE_IMAGE)];
        let flags = flags.into_iter().filter(|(name, _)| settings.get(name) > 0.0).fold(0, |all, (_, flag)| all | flag);
        let board = Size::new(settings.whole("columns") as i32, settings.whole("rows") as i32);
        Self { board, flags, radius: settings.get("radius") }
    }

    /// The corners of the board, px; none if it is not found.
    fn detect(&self, image: &Image) -> opencv::Result<Vec<PixelPoint>> {
        let mut corners = Vector::<Point2f>::new();
        let found = find_chessboard_corners_sb(&to_8_bit(image)?, self.board, &mut corners, self.flags)?;
        let whole = found && corners.len() as i32 == self.board.area();
        Ok(if whole { corners.iter().map(pixel).filter(|corner| corner.is_finite()).collect() } else { Vec::new() })
    }
}

impl Operator for ChessboardSb {
    /// # Errors
    /// [`Rejection::Border`] when the pixels within `radius` of the start, and one more, leave the image; [`Rejection::NotFinite`];
    /// [`Rejection::NoCorner`] when the board is not found, or none of its corners is there.
    fn measure(&self, image: &Image, start: &Start) -> Result<Measurement, Rejection> {
        self.measure_all(image, std::slice::from_ref(start)).pop().unwrap_or(Err(Rejection::NoCorner))
    }

    fn measure_all(&self, image: &Image, starts: &[Start]) -> Vec<Result<Measurement, Rejection>> {
        let reach = self.radius.ceil() as i64 + 1;
        // What OpenCV objects to, an image of a few pixels for one, shows no board.
        nearest_detected((image, starts), (reach, self.radius), || self.detect(image).unwrap_or_default())
    }

    fn is_local(&self) -> bool {
        false
    }
}

#[cfg(test)]
mod tests {
    use calibench_measure::{Registry, conformance};

    use super::*;
    use crate::chessboard::tests::{drawn, photographs};

    fn operator(settings: &str) -> Box<dyn Operator> {
        Registry::default().with(method()).parse(&format!("opencv_chessboard_sb:{settings}")).unwrap().operator.unwrap()
    }

    fn starts(corners: &[PixelPoint]) -> Vec<Start> {
        corners.iter().map(|corner| Start::at(PixelPoint::new(corner.x.round(), corner.y.round()))).collect()
    }

    #[test]
    fn conforms() {
        // OpenCV's positions on squares of 10 px depend on how the board is turned: they are up to 0.24 px off, in another direction when it is reflected.
        for (flags, tolerance) in [("", 0.5), (",accuracy=1", 0.3), (",accuracy=1,exhaustive=1", 0.3)] {
            conformance::check_on(&*operator(&format!("columns=3,rows=3{flags}")), conformance::chessboard, tolerance);
        }
    }

    #[test]
    fn every_corner_of_a_drawn_board_is_found() {
        for (width, height, side) in [(300, 240, 20.0), (640, 480, 40.0), (1501, 1003, 90.0)] {
            let (image, truth) = drawn(width, height, side);
            for (flags, tolerance) in [("", 0.6), ("accuracy=1", 0.45)] {
                let found = operator(flags).measure_all(&image, &starts(&truth));
                let farthest =
                    found.iter().zip(&truth).map(|(found, truth)| found.as_ref().unwrap().position.distance(*truth)).fold(0.0, f64::max);
                assert!(farthest < tolerance, "{width} x {height}, {side} px, {flags}: {farthest}");
            }
        }
    }

    #[test]
    fn the_whole_board_of_the_right_size_must_be_in_view() {
        let (image, truth) = drawn(640, 480, 40.0);
        let nothing = |operator: &dyn Operator, image: &Image| {
            let found = operator.measure_all(image, &starts(&truth));
            assert!(found.iter().all(|result| matches!(result, Err(Rejection::NoCorner | Rejection::Border))), "{found:?}");
            assert!(found.contains(&Err(Rejection::NoCorner)));
        };
        for wrong in ["columns=8", "rows=7", "columns=20,rows=15"] {
            nothing(&*operator(wrong), &image);
        }
        // A column of corners is cut off.
        nothing(&*operator(""), &Image::from_fn(480, 480, |x, y| image.at(x, y)));
        for side in 12..40 {
            let tiny = Image::from_fn(side, side, |x, y| image.at(x, y));
            let middle = Start::at(PixelPoint::new(side as f64 / 2.0, side as f64 / 2.0));
            assert!(operator("radius=0.5,accuracy=1").measure(&tiny, &middle).is_err());
        }
    }

    #[test]
    fn a_start_has_the_nearest_corner_or_none() {
        let (image, truth) = drawn(640, 480, 40.0);
        let beside = Start::at(PixelPoint::new(truth[20].x + 3.0, truth[20].y - 2.0));
        let found = operator("").measure(&image, &beside).unwrap();
        assert!(found.position.distance(truth[20]) < 0.6 && found.covariance.is_none(), "{found:?}");
        assert_eq!(operator("radius=3").measure(&image, &beside), Err(Rejection::NoCorner));
    }

    /// cornerSubPix as the second method: what the two differ by is in the median 0.10 px, and most corners are there.
    #[test]
    #[cfg_attr(not(photographs), ignore = "needs the photographs opencv-left in the folder CALIBENCH_DATA")]
    fn photographs_are_measured_as_by_corner_sub_pix() {
        use calibench_measure::{Board, BoardDetector};
        let (mut distances, mut corners) = (Vec::new(), 0);
        for (_, photograph) in photographs() {
            let subpix = crate::detector().detect(&photograph, Board { columns: 9, rows: 6 }).unwrap();
            let found = operator("accuracy=1").measure_all(&photograph, &starts(&subpix));
            corners += subpix.len();
            distances.extend(found.iter().zip(&subpix).filter_map(|(found, subpix)| Some(found.as_ref().ok()?.position.distance(*subpix))));
        }
        assert!(distances.len() * 10 > corners * 8, "{} of {corners}", distances.len());
        distances.sort_by(f64::total_cmp);
        assert!(distances[distances.len() / 2] < 0.12, "{}", distances[distances.len() / 2]);
    }
}
