//! OpenCV's finders of boards, declared here so that builds without OpenCV know their names and parameters, too.

use crate::parameter::Parameter;
use crate::registry::{Build, Method};

/// The entries of all of them: what makes each, or why it is not here, and OpenCV's own version.
pub const ALL: [fn(Build, String) -> Method; 4] = [chessboard, charuco, aprilgrid, circles];

const SB: &[Parameter] =
    &[Parameter::flag("sb", "findChessboardCornersSB in place of findChessboardCorners, without cornerSubPix after it")];

const CORRECTED: Parameter = Parameter::flag("corrected", "what is known of its origin of the pixel is taken out");

const REFINED: &[Parameter] =
    &[Parameter::named("refinement", "cornerRefinementMethod", &["none", "subpix", "contour", "apriltag"], 0), CORRECTED];

/// OpenCV's chessboards.
pub fn chessboard(build: Build, version: String) -> Method {
    Method {
        name: "opencv_find_chessboard",
        about: "OpenCV's findChessboardCorners: a chessboard in the whole image",
        source: "OpenCV, findChessboardCorners; Duda & Frese 2018 (sb)",
        version,
        parameters: SB,
        build,
    }
}

/// OpenCV's ChArUco boards.
pub fn charuco(build: Build, version: String) -> Method {
    Method {
        name: "opencv_find_charuco",
        about: "OpenCV's detectMarkers and interpolateCornersCharuco: a ChArUco board in the whole image",
        source: "OpenCV, aruco",
        version,
        parameters: &[CORRECTED],
        build,
    }
}

/// OpenCV's markers, on AprilGrids.
pub fn aprilgrid(build: Build, version: String) -> Method {
    Method {
        name: "opencv_find_aprilgrid",
        about: "OpenCV's detectMarkers: the corners of an AprilGrid's tags in the whole image",
        source: "Garrido-Jurado et al. 2014; OpenCV, aruco",
        version,
        parameters: REFINED,
        build,
    }
}

/// OpenCV's grids of circles.
pub fn circles(build: Build, version: String) -> Method {
    Method {
        name: "opencv_find_circles",
        about: "OpenCV's findCirclesGrid: a symmetric or asymmetric grid of circles in the whole image",
        source: "OpenCV, findCirclesGrid",
        version,
        parameters: &[],
        build,
    }
}
