//! `methods` and `scenarios`: what there is; and how plug-ins are started.

use std::ffi::OsString;
use std::path::PathBuf;

use calibench_plugins::{Confinement, confine_and_execute};
use pyo3::prelude::*;

use crate::error::project;
use crate::session::with_project;

/// All methods: names and what they are.
#[pyfunction]
#[pyo3(signature = (*, root = None))]
pub fn methods(root: Option<PathBuf>) -> PyResult<Vec<(String, String)>> {
    with_project(root, |here| {
        let all = here.registry().map_err(project)?.methods();
        Ok(all.iter().map(|method| (method.name.to_owned(), method.about.to_owned())).collect())
    })
}

/// The names of the project's scenarios; outside of a project there are none.
#[pyfunction]
#[pyo3(signature = (*, root = None))]
pub fn scenarios(root: Option<PathBuf>) -> PyResult<Vec<String>> {
    with_project(root, |here| here.scenario_names().map_err(project))
}

/// Restricts this process, then becomes the command; why not, where it cannot.
#[pyfunction]
pub fn confine(scratch: PathBuf, closed: Option<PathBuf>, open: Vec<PathBuf>, memory: u64, command: Vec<OsString>) -> String {
    let confinement = Confinement { scratch, closed, open, memory };
    confine_and_execute(&confinement, &command).to_string()
}
