//! Errors as Python's exceptions, with the texts of the command line.

use calibench_project::ProjectError;
use pyo3::exceptions::{PyException, PyUserWarning};
use pyo3::prelude::*;
use pyo3::{PyErr, create_exception};
use std::ffi::CString;

create_exception!(calibench, Error, PyException, "What calibench cannot do, in the words of the command line.");
create_exception!(calibench, InputError, Error, "What was given cannot be used: the message says what was expected, and what to do.");
create_exception!(calibench, ScenarioError, InputError, "A scenario or a plug-in's file with mistakes, each with its line and column.");
create_exception!(
    calibench,
    CameraError,
    InputError,
    "A camera file that cannot be read or written, or a camera that cannot be converted."
);
create_exception!(calibench, CalibrationError, Error, "No calibration: too few points, unknowns that nothing determines, no convergence.");
create_exception!(calibench, UnavailableError, Error, "What this build or machine cannot do.");
create_exception!(
    calibench,
    DoubtWarning,
    PyUserWarning,
    "A result that is doubtful, and why: what the command line says on standard error, or ends with exit code 3 for."
);

/// Whatever a crate refuses as bad input.
pub fn input(error: impl std::fmt::Display) -> PyErr {
    InputError::new_err(error.to_string())
}

/// What a crate refuses of a camera.
pub fn camera(error: impl std::fmt::Display) -> PyErr {
    CameraError::new_err(error.to_string())
}

/// What is wrong with a project.
pub fn project(error: ProjectError) -> PyErr {
    match error {
        ProjectError::Problems(problems) => ScenarioError::new_err(problems.to_string()),
        other => input(other),
    }
}

/// Says something doubtful, as a warning that users can turn into an error.
pub fn doubt(py: Python<'_>, text: &str) -> PyResult<()> {
    // A text of others may hold anything.
    let text = CString::new(text.replace('\0', " ")).unwrap_or_default();
    PyErr::warn(py, &py.get_type::<DoubtWarning>(), &text, 1)
}
