//! The Python package `calibench`: arrays in, results out. What is computed here is what the command line computes; this crate only hands it over.

#![allow(clippy::needless_pass_by_value, reason = "Python hands values over")]

mod accepting;
mod answered;
mod arrays;
mod asking;
mod boards;
mod calibrating;
mod camera;
mod columns;
mod detecting;
mod difference;
mod error;
mod grey;
mod image_size;
mod judging;
mod league;
mod listing;
mod measuring;
mod method;
mod pickled;
mod points;
mod pool;
mod pose;
mod reframing;
mod rendering;
mod reporting;
mod restored;
mod running;
mod session;
mod stopped;
mod tasking;
mod undistorting;

use pyo3::prelude::*;

#[pymodule]
mod _calibench {
    #[pymodule_export]
    #[expect(non_upper_case_globals, reason = "as Python calls it")]
    const __version__: &str = env!("CARGO_PKG_VERSION");
    #[pymodule_export]
    use super::accepting::{accept_lengths, accept_points};
    #[pymodule_export]
    use super::boards::board;
    #[pymodule_export]
    use super::calibrating::{Calibration, calibrate};
    #[pymodule_export]
    use super::camera::Camera;
    #[pymodule_export]
    use super::detecting::{Identified, detect, identify};
    #[pymodule_export]
    use super::difference::{Difference, diff};
    #[pymodule_export]
    use super::error::{CalibrationError, CameraError, DoubtWarning, Error, InputError, LossWarning, ScenarioError, UnavailableError};
    #[pymodule_export]
    use super::judging::{Judgement, judge};
    #[pymodule_export]
    use super::league::league;
    #[pymodule_export]
    use super::listing::{confine, methods, scenarios};
    #[pymodule_export]
    use super::measuring::{Measured, measure};
    #[pymodule_export]
    use super::method::add_method;
    #[pymodule_export]
    use super::pose::Pose;
    #[pymodule_export]
    use super::rendering::{Shot, Targets, render};
    #[pymodule_export]
    use super::reporting::report;
    #[pymodule_export]
    use super::restored::restored;
    #[pymodule_export]
    use super::running::{Records, merge, run, run_part, shipped};
    #[pymodule_export]
    use super::tasking::task;
    #[pymodule_export]
    use super::undistorting::{undistort, undistort_points};
}
