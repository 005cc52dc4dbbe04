//! Errors as Python's exceptions, with the texts of the command line.

use calibench_project::ProjectError;
use pyo3::exceptions::{PyException, PyUserWarning};
use pyo3::prelude::*;
use pyo3::{PyErr, PyTypeInfo, create_exception};
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

create_exception!(
    calibench,
    LossWarning,
    PyUserWarning,
    "What a file or a convention has no place for, or what was left out of a file that was read."
);

/// Whatever a crate refuses as bad input.
pub fn input(error: impl std::fmt::Display) -> PyErr {
    InputError::new_err(in_python(&error.to_string()))
}

/// A message of the command line with its options as Python has them: `pitch=` for `--pitch`, `snoop=True` for `--snoop`.
pub fn in_python(message: &str) -> String {
    let message = message.strip_prefix("-m: ").or_else(|| message.strip_prefix("-m ")).unwrap_or(message);
    let mut words = String::with_capacity(message.len());
    let mut rest = message;
    while let Some(at) = rest.find("--") {
        let (before, after) = rest.split_at(at);
        let end = after[2..].find(|c: char| !(c.is_ascii_lowercase() || c == '-')).map_or(after.len(), |end| end + 2);
        let (option, behind) = after.split_at(end);
        words.push_str(before);
        // In the name of a file it is no option.
        let begins = before.chars().next_back().is_none_or(|c| c.is_whitespace() || "(`\"".contains(c)) && option.len() > 2;
        words.push_str(&if begins { keyword(&option[2..]) } else { option.to_owned() });
        rest = behind;
    }
    words.push_str(rest);
    words
}

/// An option of the command line as a keyword.
fn keyword(option: &str) -> String {
    if option == "plain" {
        return "snoop=False".to_owned();
    }
    format!("{}={}", option.replace('-', "_"), if SWITCHES.contains(&option) { "True" } else { "" })
}

/// Options without a value.
const SWITCHES: [&str; 4] = ["snoop", "covariances", "accept", "again"];

/// What a crate refuses of a camera.
pub fn camera(error: impl std::fmt::Display) -> PyErr {
    CameraError::new_err(in_python(&error.to_string()))
}

/// What is wrong with a project.
pub fn project(error: ProjectError) -> PyErr {
    match error {
        ProjectError::Problems(problems) => ScenarioError::new_err(problems.to_string()),
        other => input(other),
    }
}

/// Says what of a camera a file or a convention has no place for.
pub fn lost(py: Python<'_>, text: &str) -> PyResult<()> {
    warn::<LossWarning>(py, text)
}

/// Says something doubtful, as a warning that users can turn into an error.
pub fn doubt(py: Python<'_>, text: &str) -> PyResult<()> {
    warn::<DoubtWarning>(py, text)
}

fn warn<W: PyTypeInfo>(py: Python<'_>, text: &str) -> PyResult<()> {
    // A text of others may hold anything.
    let text = CString::new(in_python(text).replace('\0', " ")).unwrap_or_default();
    PyErr::warn(py, &py.get_type::<W>(), &text, 1)
}
