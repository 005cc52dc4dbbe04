//! `opencv_subpix`: OpenCV's cornerSubPix, declared here so that builds without OpenCV know its name and parameters, too.

use crate::parameter::Parameter;
use crate::registry::{Build, Method};

const OPENCV_SUBPIX: &[Parameter] = &[
    Parameter::odd("window", "side of the window, px (OpenCV's winSize is half of it, rounded down)", [3, 31], 11.0).always_shown(),
    Parameter::whole("iterations", "most steps (OpenCV does no more than 100)", [1, 100], 40.0),
    Parameter::real("epsilon", "step at which iteration ends, px", [0.0, 1.0], 1e-3),
];

/// OpenCV's cornerSubPix. `build` makes it or says why it is not here, `version` is OpenCV's own.
pub fn method(build: Build, version: String) -> Method {
    Method {
        name: "opencv_subpix",
        about: "OpenCV's cornerSubPix: point orthogonal to all gradients of a weighted window, iterated",
        source: "Bradski 2000, OpenCV, cornerSubPix (its documentation cites no paper)",
        version,
        parameters: OPENCV_SUBPIX,
        build,
    }
}
