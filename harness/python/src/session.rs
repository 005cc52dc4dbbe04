//! What a call has to work with: this build's methods with those that Python added, and the project around the current folder.

use std::ffi::OsString;
use std::path::PathBuf;
use std::sync::{LazyLock, Mutex, PoisonError};

use calibench_measure::registry::Build;
use calibench_measure::{Configured, Method, Registry, opencv_boards, opencv_chessboard_sb, opencv_subpix};
use calibench_model::TargetKind;
use calibench_plugins::is_name;
use calibench_project::{Pictured, Project, ProjectError, Toolbox};
use calibench_scenario::Scenario;
use pyo3::prelude::*;

use crate::error::{input, project};
use crate::stopped::interruptible;

/// Why OpenCV's own methods are none of this build's.
const WHY: &str = "the Python package is without OpenCV; where `cv2` is installed, cv2_subpix is its cornerSubPix";

/// What makes a method that Python added: anew for each call, since it tells what came of it in that call.
type Declare = Box<dyn Fn() -> Method + Send>;

/// Methods that Python added, by name.
static ADDED: Mutex<Vec<(&'static str, Declare)>> = Mutex::new(Vec::new());

/// This package's own methods, which no call and no file changes.
static OWN: LazyLock<Toolbox> = LazyLock::new(|| Toolbox { registry: Registry::builtin(), ..Toolbox::default() });

/// Adds a method for all calls to come, in place of an earlier one of Python's of that name.
///
/// # Errors
/// A name that is none, or that one of calibench's own methods has.
pub fn add(name: &'static str, declare: impl Fn() -> Method + Send + 'static) -> PyResult<()> {
    if !is_name(name) {
        return Err(input(format!("name: `{name}`; expected lower-case letters, digits and _, a letter first")));
    }
    if OWN.registry.has(name) {
        return Err(input(format!("`{name}` is a method of calibench itself; expected another name")));
    }
    let mut added = ADDED.lock().unwrap_or_else(PoisonError::into_inner);
    added.retain(|(earlier, _)| *earlier != name);
    added.push((name, Box::new(declare)));
    Ok(())
}

/// What this package can do.
fn toolbox() -> Toolbox {
    let others = [opencv_subpix::method, opencv_chessboard_sb::method].into_iter().chain(opencv_boards::ALL);
    let absent = others.map(|method| method(Build::Unavailable(WHY), "none".into()));
    let registry = absent.into_iter().fold(OWN.registry.clone(), Registry::with);
    let added = ADDED.lock().unwrap_or_else(PoisonError::into_inner);
    Toolbox { registry: added.iter().map(|(_, declare)| declare()).fold(registry, Registry::with), ..Toolbox::default() }
}

/// The module that restricts its process and then becomes a plug-in.
const CONFINED: &str = "calibench.confined";

/// How this Python starts that module.
fn confiner() -> Option<Vec<OsString>> {
    let python: Option<OsString> = Python::attach(|py| py.import("sys")?.getattr("executable")?.extract()).ok();
    python.filter(|python| !python.is_empty()).map(|python| vec![python, "-m".into(), CONFINED.into()])
}

/// Calls `work` with the project: of `root`, or else around the current folder.
///
/// # Errors
/// What `work` refuses.
pub fn with_project<T>(root: Option<PathBuf>, work: impl FnOnce(&Project<'_>) -> PyResult<T>) -> PyResult<T> {
    work(&Project { root, confiner, ..Project::new(&toolbox()) })
}

/// As [`with_project`], for the one method that `method` names: where that is one of this package, nothing else is looked for.
///
/// # Errors
/// What `work` refuses.
pub fn with_project_of<T>(method: &str, work: impl FnOnce(&Project<'_>) -> PyResult<T>) -> PyResult<T> {
    if OWN.registry.has(method) { work(&Project::new(&OWN)) } else { with_project(None, work) }
}

/// What `look_up` finds in the project. A plug-in that is named is started, and may be long in saying that it is there: Ctrl-C ends that, too.
///
/// # Errors
/// What `look_up` refuses; the interruption.
fn found<T: Send>(py: Python<'_>, look_up: impl FnOnce() -> Result<T, ProjectError> + Send) -> PyResult<T> {
    interruptible(py, look_up)?.map_err(project)
}

/// The scenario called `name`, or of the file `name`.
///
/// # Errors
/// As [`Project::scenario`]; the interruption.
pub fn scenario_of(py: Python<'_>, here: &Project<'_>, name: &str) -> PyResult<Scenario> {
    found(py, || here.scenario(name))
}

/// The methods of these names.
///
/// # Errors
/// As [`Project::methods`]; the interruption.
pub fn methods_of(py: Python<'_>, here: &Project<'_>, names: &[String], pictured: Pictured) -> PyResult<Vec<Configured>> {
    by_names(py, names, || here.methods(names, pictured))
}

/// The methods of these names, which measure the points of boards, of the kind `kind`.
///
/// # Errors
/// As [`Project::methods_of_boards`]; the interruption.
pub fn methods_of_boards(py: Python<'_>, here: &Project<'_>, names: &[String], kind: TargetKind) -> PyResult<Vec<Configured>> {
    by_names(py, names, || here.methods_of_boards(names, kind))
}

/// Nothing is started for this package's own methods, and other threads need not be woken.
fn by_names<T: Send>(py: Python<'_>, names: &[String], look_up: impl FnOnce() -> Result<T, ProjectError> + Send) -> PyResult<T> {
    if names.iter().all(|name| OWN.registry.has(name)) { look_up().map_err(project) } else { found(py, look_up) }
}
