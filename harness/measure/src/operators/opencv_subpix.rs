//! `opencv_subpix`: OpenCV's cornerSubPix, declared here so that builds without OpenCV know its name and parameters, too.

use crate::parameter::{Domain, Parameter};
use crate::registry::{Build, Method};

const OPENCV_SUBPIX: &[Parameter] = &[
    Parameter {
        name: "window",
        about: "side of the window, px (OpenCV's winSize is half of it, rounded down)",
        domain: Domain::Odd { min: 3, max: 31 },
        default: 11.0,
        always_shown: true,
    },
    Parameter {
        name: "iterations",
        about: "most steps (OpenCV does no more than 100)",
        domain: Domain::Whole { min: 1, max: 100 },
        default: 40.0,
        always_shown: false,
    },
    Parameter {
        name: "epsilon",
        about: "step at which iteration ends, px",
        domain: Domain::Real { min: 0.0, max: 1.0 },
        default: 1e-3,
        always_shown: false,
    },
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
