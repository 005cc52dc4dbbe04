//! Records of a run as a table of the gate.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};

use calibench_records::adjustments::{self, CALIBRATIONS};
use calibench_records::names::{RECORDS, SCENARIO};
use calibench_records::points::read_records;
use calibench_records::results::{Calibrated, Figure, Group, MethodInfo, Outcome, Trial};

use super::point_entry::Coordinates;
use super::table::{Table, fingerprint};

/// Records that cannot be read.
#[derive(Debug, thiserror::Error)]
#[error("{}: {problem}", path.display())]
pub struct RecordedError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong with it.
    pub problem: String,
}

/// The records of a scenario, or of a cell of its sweep, in `folder` as a table called `name`. `unit` is the object unit, in which the errors of
/// check points are.
///
/// # Errors
/// Records that are not there or cannot be read, with their path.
pub fn recorded(folder: &Path, name: &str, unit: &'static str) -> Result<Table, RecordedError> {
    let path = folder.join(RECORDS);
    let file = File::open(&path).map_err(|error| wrong(&path, &error))?;
    let mut table: Option<Table> = None;
    let start = |trial: &Trial, methods: &[MethodInfo]| Table::new(name, 0, Coordinates::of(has_truth(trial)), methods);
    let adjusted = folder.join(CALIBRATIONS).is_file();
    let head = read_records(BufReader::new(file), |trial, methods| {
        let table = table.get_or_insert_with(|| start(&trial, methods));
        table.name_methods(methods);
        if !adjusted {
            table.add(&trial);
        }
    });
    let head = head.map_err(|error| wrong(&path, &error))?;
    let mut table = table.unwrap_or_else(|| start(&Trial::default(), &head.methods));
    table.name_methods(&head.methods);
    table.seed = head.run.seed;
    if let Ok(text) = std::fs::read_to_string(folder.join(SCENARIO)) {
        table.text = fingerprint(&text);
    }
    if adjusted {
        adjustments_of(&folder.join(CALIBRATIONS), &head.methods, unit, &mut table)?;
    }
    Ok(table)
}

fn wrong(path: &Path, error: &dyn std::fmt::Display) -> RecordedError {
    RecordedError { path: path.to_owned(), problem: error.to_string() }
}

/// Whether any point has an error; records without a point count as of a known truth.
fn has_truth(trial: &Trial) -> bool {
    let mut outcomes = trial.points.iter().filter_map(|point| match point.outcome {
        Outcome::Measured { error, .. } => Some(error.is_some()),
        Outcome::Rejected(_) => None,
    });
    outcomes.next().unwrap_or(true)
}

/// Adds the adjustments in the file at `path`, as a run hands them on: by trial, method and set.
fn adjustments_of(path: &Path, methods: &[MethodInfo], unit: &'static str, table: &mut Table) -> Result<(), RecordedError> {
    let file = File::open(path).map_err(|error| wrong(path, &error))?;
    let mut sets: BTreeMap<String, usize> = BTreeMap::new();
    let mut all: BTreeMap<u64, BTreeMap<(usize, usize), Calibrated>> = BTreeMap::new();
    let read = adjustments::read(BufReader::new(file), |row| {
        let next = sets.len();
        let set = *sets.entry(row.set).or_insert(next);
        let Some(method) = methods.iter().position(|info| *info.label == *row.method) else { return };
        let none = Calibrated { method, set, outcome: Ok(Vec::new()), check_failed: None };
        let one = all.entry(row.trial).or_default().entry((method, set)).or_insert(none);
        match (row.figure, &mut one.outcome) {
            (Ok(numbers), Ok(figures)) => {
                let (group, name) = (row.group, row.name.into());
                figures.push(Figure { group, name, value: numbers.value, sigma: numbers.sigma, error: numbers.error, unit });
            }
            (Err(why), _) if row.group == Group::Check => one.check_failed = Some(why),
            (Err(why), _) => one.outcome = Err(why),
            (Ok(_), Err(_)) => {}
        }
    });
    read.map_err(|error| wrong(path, &error))?;
    for (number, calibrated) in all {
        table.add(&Trial { number, calibrations: calibrated.into_values().collect(), ..Trial::default() });
    }
    Ok(())
}
