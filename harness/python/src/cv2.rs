//! OpenCV's detector of chessboards, where the package `cv2` is installed.

use calibench_measure::{Board, BoardDetector};
use calibench_model::{Image, PixelPoint};
use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;

use crate::arrays::positions;

/// The module that calls `cv2`.
const MODULE: &str = "calibench._cv2";

/// OpenCV's detector, in Python.
pub struct Cv2Detector;

impl Cv2Detector {
    /// It, if there is a `cv2`.
    pub fn installed(py: Python<'_>) -> Option<Self> {
        let installed = py.import(MODULE).and_then(|module| module.call_method0("installed")?.extract());
        installed.unwrap_or(false).then_some(Self)
    }
}

impl BoardDetector for Cv2Detector {
    fn name(&self) -> &'static str {
        "cv2_chessboard"
    }

    fn version(&self) -> String {
        let asked = |py: Python<'_>| py.import(MODULE)?.call_method0("version")?.extract::<String>();
        Python::attach(asked).unwrap_or_else(|error| error.to_string())
    }

    fn detect(&self, image: &Image, board: Board) -> Option<Vec<PixelPoint>> {
        Python::attach(|py| {
            let bytes = PyArray1::from_vec(py, image.to_u8()).reshape([image.height(), image.width()]).ok()?;
            let found = py.import(MODULE).ok()?.call_method1("find_chessboard", (bytes, board.columns, board.rows)).ok()?;
            if found.is_none() { None } else { positions(&found, "corners").ok() }
        })
    }
}
