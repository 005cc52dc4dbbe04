//! What a call has to work with: this build's methods with those that Python added, and the project around the current folder.

use std::ffi::OsString;
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use calibench_measure::registry::Build;
use calibench_measure::{Method, Registry, opencv_boards, opencv_chessboard_sb, opencv_subpix};
use calibench_plugins::is_name;
use calibench_project::{Project, Toolbox};
use pyo3::prelude::*;

use crate::error::input;

/// Why OpenCV's own methods are none of this build's.
const WHY: &str = "the Python package is without OpenCV; where `cv2` is installed, cv2_subpix is its cornerSubPix";

/// Methods that Python added.
static ADDED: Mutex<Vec<Method>> = Mutex::new(Vec::new());

/// Adds a method for all calls to come, in place of an earlier one of Python's of that name.
///
/// # Errors
/// A name that is none, or that one of calibench's own methods has.
pub fn add(method: Method) -> PyResult<()> {
    if !is_name(method.name) {
        return Err(input(format!("name: `{}`; expected lower-case letters, digits and _, a letter first", method.name)));
    }
    if Registry::builtin().methods().iter().any(|own| own.name == method.name) {
        return Err(input(format!("`{}` is a method of calibench itself; expected another name", method.name)));
    }
    let mut added = ADDED.lock().unwrap_or_else(PoisonError::into_inner);
    added.retain(|earlier| earlier.name != method.name);
    added.push(method);
    Ok(())
}

/// What this package can do.
fn toolbox() -> Toolbox {
    let others = [opencv_subpix::method, opencv_chessboard_sb::method].into_iter().chain(opencv_boards::ALL);
    let absent = others.map(|method| method(Build::Unavailable(WHY), "none".into()));
    let registry = absent.into_iter().fold(Registry::builtin(), Registry::with);
    let added = ADDED.lock().unwrap_or_else(PoisonError::into_inner).clone();
    Toolbox { registry: added.into_iter().fold(registry, Registry::with), ..Toolbox::default() }
}

/// The module that restricts its process and then becomes a plug-in.
const CONFINED: &str = "calibench.confined";

/// Calls `work` with the project: of `root`, or else around the current folder.
///
/// # Errors
/// What `work` refuses.
pub fn with_project<T>(py: Python<'_>, root: Option<PathBuf>, work: impl FnOnce(&Project<'_>) -> PyResult<T>) -> PyResult<T> {
    let toolbox = toolbox();
    let python: Option<OsString> = py.import("sys")?.getattr("executable")?.extract().ok();
    let confiner = python.filter(|python| !python.is_empty()).map(|python| vec![python, "-m".into(), CONFINED.into()]);
    work(&Project { root, confiner, ..Project::new(&toolbox) })
}
