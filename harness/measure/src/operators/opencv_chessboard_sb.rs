//! `opencv_chessboard_sb`: OpenCV's findChessboardCornersSB, declared here so that builds without OpenCV know its name and parameters, too.

use crate::parameter::Parameter;
use crate::registry::{Build, Method};

const fn side(name: &'static str, about: &'static str, default: f64) -> Parameter {
    Parameter::whole(name, about, [3, 100], default).always_shown()
}

const PARAMETERS: &[Parameter] = &[
    side("columns", "inner corners in a row of the board", 9.0),
    side("rows", "rows of inner corners of the board", 6.0),
    Parameter::flag("accuracy", "CALIB_CB_ACCURACY, the image is enlarged"),
    Parameter::flag("exhaustive", "CALIB_CB_EXHAUSTIVE, the search tries more"),
    Parameter::flag("normalize", "CALIB_CB_NORMALIZE_IMAGE, grey values are equalised first"),
    Parameter::real("radius", "how far a corner of the board may be from the start, px", [0.5, 30.0], 5.0),
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
