//! `run`, `run_part` and `merge`: scenarios to records.

use std::path::{Component, Path, PathBuf};
use std::{fs, io};

use calibench_measure::registry::notes;
use calibench_project::{Pictured, Project, origin};
use calibench_records::names::SCENARIO;
use calibench_records::parts::Part;
use calibench_records::stored::Table;
use calibench_run::parts::{Wanted, merge as merged};
use calibench_run::store::RecordsFolder;
use calibench_run::{Order, Place, Ran, RunError};
use calibench_scenario::{Scenario, Subject, Transfer};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyBytes, PyDict};
use tempfile::TempDir;

use crate::columns::columns;
use crate::error::{doubt, input, project};
use crate::pickled::{Pickled, Reduced, reduced};
use crate::pool::released;
use crate::session::{methods_of, scenario_of, with_project};
use crate::stopped::Stoppable;

/// What a run left: see `calibench.Records`.
#[pyclass(frozen, module = "calibench", name = "Records")]
pub struct Records {
    folder: PathBuf,
    /// Where nobody asked for a folder it goes with this.
    temporary: Option<TempDir>,
    /// Tables that were asked for.
    points: PyOnceLock<Py<PyDict>>,
    adjustments: PyOnceLock<Py<PyDict>>,
}

impl Records {
    fn in_folder(folder: PathBuf, temporary: Option<TempDir>) -> Self {
        Self { folder, temporary, points: PyOnceLock::new(), adjustments: PyOnceLock::new() }
    }

    fn table<'py>(&self, py: Python<'py>, table: Table) -> PyResult<Bound<'py, PyDict>> {
        let read = match table {
            Table::Points => &self.points,
            Table::Adjustments => &self.adjustments,
        };
        Ok(read.get_or_try_init(py, || Ok::<_, PyErr>(columns(py, &self.folder, table)?.unbind()))?.bind(py).clone())
    }
}

#[pymethods]
impl Records {
    /// The records of a run that are there.
    #[staticmethod]
    fn read(folder: PathBuf) -> PyResult<Self> {
        if folder.join(SCENARIO).is_file() {
            return Ok(Self::in_folder(folder, None));
        }
        Err(input(format!("{}: holds no records; expected the folder of a run", folder.display())))
    }

    /// Where they are; None where they go with this object.
    #[getter]
    fn folder(&self) -> Option<&Path> {
        self.temporary.is_none().then_some(self.folder.as_path())
    }

    /// What was measured, a row a point, as columns.
    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.table(py, Table::Points)
    }

    /// What was adjusted, a row a figure, as columns; empty where nothing was.
    #[getter]
    fn adjustments<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.table(py, Table::Adjustments)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        reduced(py, self)
    }

    fn __repr__(&self) -> String {
        format!("Records({})", self.folder().map_or_else(|| "temporary".to_owned(), |folder| folder.display().to_string()))
    }
}

/// The folder's name or path, and its files where it goes with the object.
type State = (PathBuf, Option<Vec<(PathBuf, Vec<u8>)>>);

impl Pickled for Records {
    const CLASS: &'static str = "Records";

    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let Some(temporary) = &self.temporary else { return (&self.folder, None::<()>).into_bound_py_any(py) };
        let mut files = Vec::new();
        files_in(temporary.path(), Path::new(""), &mut files)?;
        let files: Vec<_> = files.iter().map(|(path, bytes)| (path, PyBytes::new(py, bytes))).collect();
        let name = self.folder.strip_prefix(temporary.path()).map_err(input)?;
        (name, files).into_bound_py_any(py)
    }

    fn of(state: &Bound<'_, PyAny>) -> PyResult<Self> {
        let (folder, files): State = state.extract()?;
        let Some(files) = files else { return Self::read(folder) };
        let temporary = TempDir::new()?;
        for (path, bytes) in files {
            if path.components().any(|part| !matches!(part, Component::Normal(_))) {
                return Err(input(format!("{}: is no file of records", path.display())));
            }
            let path = temporary.path().join(path);
            path.parent().map_or(Ok(()), fs::create_dir_all)?;
            fs::write(path, bytes)?;
        }
        Ok(Self::in_folder(temporary.path().join(folder), Some(temporary)))
    }
}

/// All files below `folder` of `root`, by their paths from there.
fn files_in(root: &Path, folder: &Path, files: &mut Vec<(PathBuf, Vec<u8>)>) -> io::Result<()> {
    for entry in fs::read_dir(root.join(folder))? {
        let entry = entry?;
        let path = folder.join(entry.file_name());
        if entry.file_type()?.is_dir() {
            files_in(root, &path, files)?;
        } else {
            files.push((path, fs::read(entry.path())?));
        }
    }
    Ok(())
}

/// What differs from a scenario's file.
struct Changes {
    methods: Vec<String>,
    trials: Option<u64>,
    seed: Option<u64>,
}

impl Changes {
    fn checked(self) -> PyResult<Self> {
        match (self.trials, self.seed) {
            (Some(trials), _) if !(1..=1_000_000).contains(&trials) => Err(input(format!("trials: {trials}; expected 1 to 1000000"))),
            (_, Some(seed)) if seed > i64::MAX as u64 => Err(input(format!("seed: {seed}; expected at most {}", i64::MAX))),
            _ => Ok(self),
        }
    }
}

/// Runs `scenario` into the place that `place` makes, and says what is doubtful of it.
fn ran(
    py: Python<'_>,
    here: &Project<'_>,
    scenario: &Scenario,
    changes: &Changes,
    threads: Option<usize>,
    place: &Place<'_>,
    revision: &str,
) -> PyResult<Ran> {
    let methods = methods_of(py, here, &changes.methods, Pictured::Renders)?;
    let (registry, data, tools) = (here.registry().map_err(project)?, here.data().map_err(project)?, here.tools().map_err(project)?);
    let threads = Stoppable::on(py, threads)?;
    let (trials, seed) = (changes.trials, changes.seed);
    let order = Order { scenario, methods: &methods, trials, seed, tools, data, reuse: None, registry, stop: Some(threads.flag()) };
    order.check().map_err(input)?;
    if let Some(plan) = order.plan() {
        plan.transfer().and_then(Transfer::warning).map_or(Ok(()), |warning| doubt(py, &format!("{}: {warning}", scenario.name)))?;
        plan.missing().map_or(Ok(()), |why| doubt(py, &format!("{}: unavailable: {why}", scenario.name)))?;
        for info in plan.method_infos() {
            info.unavailable.map_or(Ok(()), |why| doubt(py, &format!("{}: {} unavailable: {why}", scenario.name, info.label)))?;
        }
    }
    let done = threads.run(py, || order.run(place, revision, &|| ()).map_err(|error: RunError| input(error)))?;
    for (name, note) in notes(order.measuring()) {
        doubt(py, &format!("{name}: {note}"))?;
    }
    Ok(done)
}

/// Runs a scenario: as `calibench run` does, into `records`, or into a folder that goes with the result.
#[pyfunction]
#[pyo3(signature = (scenario, *, methods = None, trials = None, seed = None, records = None, threads = None, root = None))]
#[expect(clippy::too_many_arguments, reason = "each is a keyword of Python's")]
pub fn run(
    py: Python<'_>,
    scenario: &str,
    methods: Option<Vec<String>>,
    trials: Option<u64>,
    seed: Option<u64>,
    records: Option<PathBuf>,
    threads: Option<usize>,
    root: Option<PathBuf>,
) -> PyResult<Records> {
    let changes = Changes { methods: methods.unwrap_or_default(), trials, seed }.checked()?;
    with_project(root, |here| {
        let named = scenario_of(py, here, scenario)?;
        let temporary = records.is_none().then(TempDir::new).transpose()?;
        let all = records.or_else(|| temporary.as_ref().map(|folder| folder.path().to_owned())).unwrap_or_default();
        let folder = RecordsFolder::open(&all, &named.name, origin(scenario, &named))?;
        let revision = here.revision().map_err(project)?;
        match ran(py, here, &named, &changes, threads, &Place::Records(&folder), &revision)? {
            Ran::Whole(0) => Err(input(format!("{}: nothing was measured", named.name))),
            _ => Ok(Records::in_folder(all.join(&named.name), temporary)),
        }
    })
}

/// Runs one part of a run into a folder of parts: as `calibench run --part` does. Where it is.
#[pyfunction]
#[pyo3(signature = (scenario, part, folder, *, methods = None, trials = None, seed = None, again = false, threads = None, root = None,
    revision = None))]
#[expect(clippy::too_many_arguments, reason = "each is a keyword of Python's")]
pub fn run_part(
    py: Python<'_>,
    scenario: &str,
    part: &str,
    folder: PathBuf,
    methods: Option<Vec<String>>,
    trials: Option<u64>,
    seed: Option<u64>,
    again: bool,
    threads: Option<usize>,
    root: Option<PathBuf>,
    revision: Option<String>,
) -> PyResult<PathBuf> {
    let changes = Changes { methods: methods.unwrap_or_default(), trials, seed }.checked()?;
    let part: Part = part.parse().map_err(|error| input(format!("part: {error}")))?;
    with_project(root, |here| {
        let named = scenario_of(py, here, scenario)?;
        let revision = revision.map_or_else(|| here.revision().map_err(project), Ok)?;
        let wanted = Wanted { folder: &folder, part, origin: origin(scenario, &named), again, revision: &revision };
        match ran(py, here, &named, &changes, threads, &Place::Part(wanted), &revision)? {
            Ran::Part(done) => Ok(done.folder),
            Ran::Whole(_) => Err(input("a part was asked for")),
        }
    })
}

/// Puts parts together, byte for byte to what one run would have written: as `calibench merge` does.
#[pyfunction]
pub fn merge(py: Python<'_>, folders: Vec<PathBuf>, records: PathBuf) -> PyResult<Vec<Records>> {
    let all = released(py, || merged(&folders, &records))?.map_err(input)?;
    for (name, note) in all.iter().flat_map(|one| &one.notes) {
        doubt(py, &format!("{name}: {note}"))?;
    }
    Ok(all.into_iter().map(|one| Records::in_folder(records.join(one.scenario), None)).collect())
}

/// A file beside a scenario: its path from the scenario's folder, and where it is.
type Beside = (PathBuf, PathBuf);

/// What a part needs on another machine: a scenario's name, its text, the files of its camera and its board if it has them, and the revision of the code.
#[pyfunction]
#[pyo3(signature = (scenario, *, root = None))]
pub fn shipped(py: Python<'_>, scenario: &str, root: Option<PathBuf>) -> PyResult<(String, String, Vec<Beside>, String)> {
    with_project(root, |here| {
        let named = scenario_of(py, here, scenario)?;
        let files: Vec<PathBuf> = match &named.subject {
            Subject::Views(views) => views.files().map(Path::to_owned).collect(),
            Subject::Photographs(_) | Subject::Scene(_) | Subject::Printed(_) => Vec::new(),
        };
        let folder = here.root().map_err(project)?.join("scenarios").join(&named.name);
        let beside = |path: PathBuf| {
            let own = folder.parent().and_then(|folder| path.strip_prefix(folder).ok()).map(Path::to_owned);
            own.map(|own| (own, path.clone())).ok_or_else(|| input(format!("{}: the file is not in the scenario's folder", path.display())))
        };
        Ok((
            named.name.clone(),
            named.text.clone(),
            files.into_iter().map(beside).collect::<PyResult<_>>()?,
            here.revision().map_err(project)?,
        ))
    })
}
