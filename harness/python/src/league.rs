//! `league`: calibrators beside each other on the same trials, callables of Python's among them.

use std::path::PathBuf;
use std::time::Instant;

use calibench_calibrate::MODELS;
use calibench_calibrators::{Answer, Calibrated, Calibrator, Listed, Status, Task};
use calibench_plugins::is_name;
use calibench_project::{Project, answered_camera};
use calibench_records::league::Answered;
use calibench_run::Plan;
use calibench_run::league::{Bout, Class};
use calibench_scenario::Scenario;
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::error::{doubt, input, project};
use crate::session::{scenario_of, with_project};
use crate::stopped::Stoppable;

/// One name or several.
#[derive(FromPyObject)]
pub enum Names {
    One(String),
    Several(Vec<String>),
}

/// A calibrator as a call names it.
#[derive(FromPyObject)]
pub enum Entrant {
    Named(String),
    Callable(Py<PyAny>),
}

/// A callable as a calibrator.
struct Called {
    callable: Py<PyAny>,
    version: String,
}

/// The function of the package that hands a task to a callable, and its answer back.
const ANSWER: (&str, &str) = ("calibench._league", "answer");

impl Calibrator for Called {
    fn version(&self) -> Result<String, String> {
        Ok(self.version.clone())
    }

    fn calibrate(&self, task: &Task) -> Result<Calibrated, String> {
        let begun = Instant::now();
        let said = Python::attach(|py| {
            let answer = py.import(ANSWER.0)?.getattr(ANSWER.1)?;
            answer.call1((self.callable.bind(py), PyBytes::new(py, &task.request(0))))?.extract::<String>()
        });
        let answer = match said {
            Ok(line) => Answer::read(&line, 0, task, answered_camera),
            Err(error) => Answer::without(Status::Failed, error.to_string().split_whitespace().collect::<Vec<_>>().join(" ")),
        };
        Ok(Calibrated { answer, seconds: begun.elapsed().as_secs_f64(), peak_mb: None })
    }
}

/// The callable as those of the project are listed.
fn listed(py: Python<'_>, callable: Py<PyAny>) -> PyResult<Listed> {
    let own = callable.bind(py);
    if !own.is_callable() {
        return Err(input(format!("calibrators: {}; expected names and callables", own.repr()?)));
    }
    let text = |key: &str| own.getattr_opt(key).map(|value| value.map(|value| value.to_string()));
    let name = text("__name__")?.unwrap_or_default();
    if !is_name(&name) {
        return Err(input(format!(
            "calibrators: `{name}`; expected a callable whose name has small letters, digits and _, a letter first"
        )));
    }
    let version = text("__version__")?.unwrap_or_else(|| "?".to_owned());
    Ok(Listed {
        system: name.clone(),
        about: String::new(),
        source: String::new(),
        identity: String::new(),
        models: MODELS.map(str::to_owned).to_vec(),
        start: true,
        calibrator: Box::new(Called { callable, version }),
        name,
    })
}

/// Those that are meant: of the project, and callables.
struct Entered<'a> {
    known: Vec<&'a Listed>,
    called: Vec<Listed>,
}

impl<'a> Entered<'a> {
    fn of(py: Python<'_>, here: &'a Project<'_>, entrants: Vec<Entrant>) -> PyResult<Self> {
        let mut entered = Self { known: Vec::new(), called: Vec::new() };
        let all = here.calibrators().map_err(project)?;
        for entrant in entrants {
            match entrant {
                Entrant::Named(name) => {
                    let known = || all.iter().map(|listed| listed.name.as_str()).collect::<Vec<_>>().join(", ");
                    let listed = all.iter().find(|listed| listed.name == name);
                    entered
                        .known
                        .push(listed.ok_or_else(|| input(format!("no calibrator is called `{name}`: expected some of {}", known())))?);
                }
                Entrant::Callable(callable) => entered.called.push(listed(py, callable)?),
            }
        }
        let names: Vec<&str> = entered.all().map(|listed| listed.name.as_str()).collect();
        if names.is_empty() {
            return Err(input("calibrators: none; expected names and callables"));
        }
        if let Some((_, twice)) = names.iter().enumerate().find(|(place, name)| names[..*place].contains(name)) {
            return Err(input(format!("calibrators: `{twice}` is there twice")));
        }
        Ok(entered)
    }

    fn all(&self) -> impl Iterator<Item = &Listed> {
        self.known.iter().copied().chain(&self.called)
    }
}

/// Rows as columns.
fn columns<'py>(py: Python<'py>, rows: &[(String, Answered)]) -> PyResult<Bound<'py, PyDict>> {
    type Number = fn(&Answered) -> Option<f64>;
    type Text = fn(&Answered) -> &str;
    let table = PyDict::new(py);
    table.set_item("calibrator", rows.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>())?;
    let texts: [(&str, Text); 5] = [
        ("system", |row| &row.system),
        ("version", |row| &row.version),
        ("scenario", |row| &row.class),
        ("status", |row| &row.status),
        ("message", |row| &row.message),
    ];
    for (name, of) in texts {
        table.set_item(name, rows.iter().map(|(_, row)| of(row)).collect::<Vec<_>>())?;
    }
    table.set_item("trial", PyArray1::from_iter(py, rows.iter().map(|(_, row)| row.trial as i64)))?;
    table.set_item("left_out", PyArray1::from_iter(py, rows.iter().map(|(_, row)| row.left_out as i64)))?;
    table.set_item("silent", PyArray1::from_iter(py, rows.iter().map(|(_, row)| row.silent)))?;
    let numbers: [(&str, Number); 8] = [
        ("frame", |row| row.frame),
        ("covered", |row| row.covered),
        ("length", |row| row.length),
        ("stated", |row| row.stated),
        ("z2", |row| row.z2),
        ("z2_parameters", |row| row.z2_parameters),
        ("rms", |row| row.rms),
        ("seconds", |row| row.seconds),
    ];
    for (name, of) in numbers {
        table.set_item(name, PyArray1::from_iter(py, rows.iter().map(|(_, row)| of(row).unwrap_or(f64::NAN))))?;
    }
    Ok(table)
}

/// Asks calibrators about the same trials: as `calibench league` does, and nothing is kept.
#[pyfunction]
#[pyo3(signature = (scenarios, calibrators, *, trials = None, seed = None, threads = None, root = None))]
pub fn league(
    py: Python<'_>,
    scenarios: Names,
    calibrators: Vec<Entrant>,
    trials: Option<u64>,
    seed: Option<u64>,
    threads: Option<usize>,
    root: Option<PathBuf>,
) -> PyResult<Bound<'_, PyDict>> {
    if trials == Some(0) {
        return Err(input("trials: 0; expected 1 and more"));
    }
    let names = match scenarios {
        Names::One(name) => vec![name],
        Names::Several(names) => names,
    };
    let rows = with_project(root, |here| {
        let entered = Entered::of(py, here, calibrators)?;
        let all: Vec<Scenario> = names.iter().map(|name| scenario_of(py, here, name)).collect::<PyResult<_>>()?;
        let (tools, data) = (here.tools().map_err(project)?, here.data().map_err(project)?);
        let threads = Stoppable::on(py, threads)?;
        let mut rows = Vec::new();
        for scenario in &all {
            let mut plan = Plan { stop: Some(threads.flag()), ..Plan::new(scenario, tools, data.clone()) };
            (plan.trials, plan.seed) = (trials.unwrap_or(plan.trials), seed.unwrap_or(plan.seed));
            let class = Class::new(&plan).map_err(input)?;
            let class = class.ok_or_else(|| input(format!("{}: expected a scenario with [calibrators]", scenario.name)))?;
            for listed in entered.all() {
                let version = match listed.calibrator.version() {
                    Ok(version) => version,
                    Err(why) => {
                        doubt(py, &format!("{}: unavailable: {why}", listed.name))?;
                        continue;
                    }
                };
                let found = threads.run(py, || class.rows(Bout { listed, version: &version }, "", &|| ()).map_err(input))?;
                rows.extend(found.into_iter().map(|row| (listed.name.clone(), row)));
            }
        }
        Ok(rows)
    })?;
    columns(py, &rows)
}
