//! Records of a run as a table of the gate.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use calibench_records::names::SCENARIO;
use calibench_records::results::{Calibrated, Figure, Group, MethodInfo, Outcome, Trial};
use calibench_records::stored::{StoredError, Table as Stored, read_adjustments, read_points};

use super::point_entry::Coordinates;
use super::table::{Table, fingerprint};

/// The records of a scenario, or of a cell of its sweep, in `folder` as a table called `name`. `unit` is the object unit, in which the errors of
/// check points are.
///
/// # Errors
/// Records that are not there or cannot be read, with their path.
pub fn recorded(folder: &Path, name: &str, unit: &'static str) -> Result<Table, StoredError> {
    let mut table: Option<Table> = None;
    let start = |trial: &Trial, methods: &[MethodInfo]| Table::new(name, 0, Coordinates::of(has_truth(trial)), methods);
    let adjusted = if Stored::Adjustments.is_in(folder)? { Some(adjustments_of(folder, unit)?) } else { None };
    // Of adjustments the points are those of the first trial alone.
    let has_points = adjusted.as_ref().is_none_or(|trials| trials.values().flatten().all(|(_, one)| one.is_count()));
    let head = read_points(folder, |trial, methods| {
        let table = table.get_or_insert_with(|| start(&trial, methods));
        table.name_methods(methods);
        if has_points {
            table.add(&trial);
        }
    })?;
    let mut table = table.unwrap_or_else(|| start(&Trial::default(), &head.methods));
    table.name_methods(&head.methods);
    table.seed = head.run.seed;
    if let Ok(text) = std::fs::read_to_string(folder.join(SCENARIO)) {
        table.text = fingerprint(&text);
    }
    for (number, trial) in adjusted.into_iter().flatten() {
        let of = |(label, one)| Some(Calibrated { method: head.methods.iter().position(|info| info.label == label)?, ..one });
        table.add(&Trial { number, calibrations: trial.into_iter().filter_map(of).collect(), ..Trial::default() });
    }
    Ok(table)
}

/// Whether any point has an error; records without a point count as of a known truth.
fn has_truth(trial: &Trial) -> bool {
    let mut outcomes = trial.points.iter().filter_map(|point| match point.outcome {
        Outcome::Measured { error, .. } => Some(error.is_some()),
        Outcome::Rejected(_) => None,
    });
    outcomes.next().unwrap_or(true)
}

/// Adjustments by trial, each with the label of its method.
type ByTrial = BTreeMap<u64, Vec<(Arc<str>, Calibrated)>>;

/// The adjustments of the run in `folder` by trial, each with the label of its method, as a run hands them on: by method and set.
fn adjustments_of(folder: &Path, unit: &'static str) -> Result<ByTrial, StoredError> {
    let mut sets: BTreeMap<Arc<str>, usize> = BTreeMap::new();
    let mut all: BTreeMap<u64, BTreeMap<(Arc<str>, usize), Calibrated>> = BTreeMap::new();
    read_adjustments(folder, |row| {
        let next = sets.len();
        let set = *sets.entry(row.set).or_insert(next);
        let none = Calibrated { method: 0, set, outcome: Ok(Vec::new()), check_failed: None };
        let one = all.entry(row.trial).or_default().entry((row.method, set)).or_insert(none);
        match (row.figure, &mut one.outcome) {
            (Ok(numbers), Ok(figures)) => {
                let (group, name) = (row.group, row.name);
                figures.push(Figure { group, name, value: numbers.value, sigma: numbers.sigma, error: numbers.error, unit });
            }
            (Err(why), _) if row.group == Group::Check => one.check_failed = Some(why),
            (Err(why), _) => one.outcome = Err(why),
            (Ok(_), Err(_)) => {}
        }
    })?;
    let trial = |(number, all): (u64, BTreeMap<(Arc<str>, usize), Calibrated>)| {
        (number, all.into_iter().map(|((label, _), one)| (label, one)).collect())
    };
    Ok(all.into_iter().map(trial).collect())
}

#[cfg(test)]
mod tests {
    use calibench_records::adjustments::CalibrationWriter;
    use calibench_records::compressor::Compressor;
    use calibench_records::points::{RecordWriter, RunInfo};

    use super::*;

    /// What is adjusted alone, as from coordinates that are drawn, has figures and no points.
    #[test]
    fn figures_of_methods_without_points_are_read() {
        let folder = tempfile::tempdir().unwrap();
        let table = |table: Stored| Compressor::new(std::fs::File::create(folder.path().join(table.file())).unwrap());
        let run = RunInfo { scenario: "f/s".into(), seed: 9, revision: "r".into(), detector: None };
        let methods = ["a", "b"].map(|label| MethodInfo { label: label.into(), version: "3".into(), unavailable: None }).to_vec();
        let mut records = RecordWriter::new(table(Stored::Points), run.clone(), methods.clone()).unwrap();
        records.adjusted_alone().unwrap();
        records.finish().unwrap().finish().unwrap();
        let mut adjustments = CalibrationWriter::new(table(Stored::Adjustments), run, methods, vec!["held".into()]).unwrap();
        let calibrated = |method: usize, rms: f64| {
            let figures = [(Group::Frame, "rms", rms), (Group::Check, "rmse_xy", 0.25), (Group::Check, "rmse_z", 0.5)];
            let figures = figures.map(|(group, name, value)| Figure::plain(group, name, value, "m"));
            Calibrated { method, set: 0, outcome: Ok(figures.to_vec()), check_failed: None }
        };
        for trial in 0..2 {
            adjustments.trial(trial, &[calibrated(0, 1.0), calibrated(1, 2.0)]).unwrap();
        }
        adjustments.finish().unwrap().finish().unwrap();

        let table = recorded(folder.path(), "f/s", "m").unwrap();
        assert_eq!((table.seed, table.trials(), table.methods().count()), (9, 2, 2));
        let b = table.method("b").unwrap();
        assert_eq!((&*b.version, b.points.len()), ("3", 4), "the camera and the check points of two trials");
        let rms = &b.figures[&(0, Group::Frame, "rms".into())];
        assert!(rms.len() == 2 && rms.values().all(|numbers| numbers.value == 2.0));
    }
}
