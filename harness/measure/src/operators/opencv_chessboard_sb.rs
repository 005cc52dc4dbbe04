//! `opencv_chessboard_sb`: OpenCV's findChessboardCornersSB, declared here so that builds without OpenCV know its name and parameters, too.

use crate::parameter::{Domain, Parameter};
use crate::registry::{Build, Method};

/// A flag of OpenCV, off as in OpenCV.
const fn flag(name: &'static str, about: &'static str) -> Parameter {
    Parameter { name, about, domain: Domain::Whole { min: 0, max: 1 }, default: 0.0, always_shown: false }
}

const fn side(name: &'static str, about: &'static str, default: f64) -> Parameter {
    Parameter { name, about, domain: Domain::Whole { min: 3, max: 100 }, default, always_shown: true }
}

const PARAMETERS: &[Parameter] = &[
    side("columns", "inner corners in a row of the board", 9.0),
    side("rows", "rows of inner corners of the board", 6.0),
    flag("accuracy", "1: CALIB_CB_ACCURACY, the image is enlarged"),
    flag("exhaustive", "1: CALIB_CB_EXHAUSTIVE, the search tries more"),
    flag("normalize", "1: CALIB_CB_NORMALIZE_IMAGE, grey values are equalised first"),
    Parameter {
        name: "radius",
        about: "how far a corner of the board may be from the start, px",
        domain: Domain::Real { min: 0.5, max: 30.0 },
        default: 5.0,
        always_shown: false,
    },
];

/// OpenCV's findChessboardCornersSB. `build` makes it or says why it is not here, `version` is OpenCV's own.
pub fn method(build: Build, version: String) -> Method {
    Method {
        name: "opencv_chessboard_sb",
        about: "OpenCV's findChessboardCornersSB: the whole board is sought by its corners' sectors, the nearest corner to the start",
        source: "Duda & Frese 2018; OpenCV, findChessboardCornersSB",
        version,
        parameters: PARAMETERS,
        build,
    }
}
