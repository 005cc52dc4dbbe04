//! OpenCV's own finders of boards, unchanged: with the parameters that they have by default, on grey values of 8 bits.

mod chessboard;
mod circles;
mod dotted;
#[cfg(aruco_contrib)]
mod markers;

use calibench_measure::opencv_boards;
use calibench_measure::registry::{Build, Method};
use calibench_measure::{BoardPointFound, Finds};
use calibench_model::PixelPoint;
use opencv::core::{Point2f, Vector};

use crate::subpix::pixel;
use crate::version;

/// All of them.
pub fn methods() -> [Method; 4] {
    [
        opencv_boards::chessboard(Build::With(|settings| Box::new(Finds(chessboard::Chessboards::new(settings)))), version()),
        opencv_boards::charuco(charuco(), version()),
        opencv_boards::aprilgrid(aprilgrid(), version()),
        opencv_boards::circles(Build::With(|_| Box::new(Finds(circles::CirclesGrid))), version()),
    ]
}

#[cfg(aruco_contrib)]
fn charuco() -> Build {
    Build::With(|settings| Box::new(Finds(markers::CharucoCorners::new(settings))))
}

#[cfg(aruco_contrib)]
fn aprilgrid() -> Build {
    Build::With(|settings| Box::new(Finds(markers::TagCorners::new(settings))))
}

/// Why boards with markers are not found by this build's OpenCV.
#[cfg(not(aruco_contrib))]
const ELSEWHERE: &str =
    "this build knows the module `aruco` of OpenCV 4.5 and 4.6 with contrib; for others there is a plug-in (examples/plugins/boards.toml)";

#[cfg(not(aruco_contrib))]
fn charuco() -> Build {
    Build::Unavailable(ELSEWHERE)
}

#[cfg(not(aruco_contrib))]
fn aprilgrid() -> Build {
    Build::Unavailable(ELSEWHERE)
}

/// Points that OpenCV lists in the order of the layout.
fn in_order(points: &Vector<Point2f>) -> Vec<BoardPointFound> {
    let point = |(index, at): (usize, Point2f)| BoardPointFound { index, position: pixel(at) };
    points.iter().enumerate().map(point).filter(|point| is_place(point.position)).collect()
}

fn is_place(at: PixelPoint) -> bool {
    at.is_finite()
}
