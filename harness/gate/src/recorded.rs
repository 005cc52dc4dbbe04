//! Records of a run as a table of the gate.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use calibench_records::figures::{Group, Kind};
use calibench_records::names::SCENARIO;
use calibench_records::results::{Calibrated, Figure, MethodInfo, Outcome, Trial};
use calibench_records::stored::{StoredError, Table as Stored, read_adjustments, read_points};

use super::adjusted::CHECKED;
use super::point_entry::Coordinates;
use super::table::{Table, fingerprint, library};

/// The records of a scenario, or of a cell of its sweep, in `folder` as a table called `name`. `unit` is the object unit, in which the errors of
/// check points are.
///
/// # Errors
/// Records that are not there or cannot be read, with their path.
pub fn recorded(folder: &Path, name: &str, unit: &'static str) -> Result<Table, StoredError> {
    let mut table: Option<Table> = None;
    let start = |trial: &Trial, methods: &[MethodInfo]| Table::new(name, 0, Coordinates::of(has_truth(trial)), methods);
    let adjusted = if Stored::Adjustments.is_in(folder)? { Some(adjustments_of(folder, name, unit)?) } else { None };
    let are_adjusted =
        adjusted.as_ref().is_some_and(|(_, trials)| !trials.values().flatten().all(|(_, one)| one.kind() == Some(Kind::Detection)));
    let head = read_points(folder, name, |trial, methods| {
        let table = table.get_or_insert_with(|| start(&trial, methods));
        table.name_methods(methods);
        table.add_points(&trial, are_adjusted);
    })?;
    let mut table = table.unwrap_or_else(|| start(&Trial::default(), &head.methods));
    table.name_methods(&head.methods);
    table.seed = head.run.seed;
    for MethodInfo { label, version, .. } in &head.methods {
        table.describe(label, String::new(), library(label, version, head.run.detector.as_ref()));
    }
    // The cells of a sweep lie below its text.
    let texts = [Some(folder), folder.parent()].into_iter().flatten().map(|folder| folder.join(SCENARIO));
    if let Some(text) = texts.into_iter().find_map(|path| std::fs::read_to_string(path).ok()) {
        table.text = fingerprint(&text);
    }
    let Some((seed, trials)) = adjusted else { return Ok(table) };
    if seed.is_some_and(|seed| seed != head.run.seed) && !head.run.scenario.is_empty() {
        return Err(mistaken(folder, format!("was run with another seed than {} beside it", Stored::Points.file())));
    }
    for (number, trial) in trials {
        let of = |(label, one): (Arc<str>, Calibrated)| {
            let method = head.methods.iter().position(|info| info.label == label);
            let method =
                method.ok_or_else(|| mistaken(folder, format!("has a method `{label}` that {} has not", Stored::Points.file())))?;
            Ok(Calibrated { method, ..one })
        };
        let calibrations = trial.into_iter().map(of).collect::<Result<_, StoredError>>()?;
        table.add(&Trial { number, calibrations, ..Trial::default() });
    }
    Ok(table)
}

/// Adjustments that do not fit their points.
fn mistaken(folder: &Path, problem: String) -> StoredError {
    StoredError::Mistaken { path: folder.join(Stored::Adjustments.file()), problem }
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

/// The adjustments of the run in `folder` by trial, each with the label of its method, as a run hands them on: by method and set; and their seed, if there are any.
fn adjustments_of(folder: &Path, name: &str, unit: &'static str) -> Result<(Option<u64>, ByTrial), StoredError> {
    let mut other = None;
    let mut sets: BTreeMap<Arc<str>, usize> = BTreeMap::new();
    let mut all: BTreeMap<u64, BTreeMap<(Arc<str>, usize), Calibrated>> = BTreeMap::new();
    let run = read_adjustments(folder, name, |row| {
        if let Some((name, _)) = row.figure.as_ref().ok().filter(|(name, _)| CHECKED.contains(&name.quantity()) && *row.unit != *unit) {
            other.get_or_insert_with(|| format!("has `{name}` in `{}`, expected the scenario's `{unit}`", row.unit));
        }
        let next = sets.len();
        let set = *sets.entry(row.set).or_insert(next);
        let none = Calibrated { method: 0, set, outcome: Ok(Vec::new()), check_failed: None };
        let one = all.entry(row.trial).or_default().entry((row.method, set)).or_insert(none);
        match (row.figure, &mut one.outcome) {
            (Ok((name, numbers)), Ok(figures)) => {
                figures.push(Figure { name, value: numbers.value, sigma: numbers.sigma, error: numbers.error, unit });
            }
            (Err(why), _) if row.group == Group::Check => one.check_failed = Some(why),
            (Err(why), _) => one.outcome = Err(why),
            (Ok(_), Err(_)) => {}
        }
    })?;
    let trial = |(number, all): (u64, BTreeMap<(Arc<str>, usize), Calibrated>)| {
        (number, all.into_iter().map(|((label, _), one)| (label, one)).collect())
    };
    other.map_or(Ok(()), |problem| Err(mistaken(folder, problem)))?;
    Ok(((!run.scenario.is_empty()).then_some(run.seed), all.into_iter().map(trial).collect()))
}

#[cfg(test)]
mod tests {
    use calibench_records::adjustments::CalibrationWriter;
    use calibench_records::compressor::Compressor;
    use calibench_records::figures::Quantity;
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
            let figures = [(Quantity::OverFrame, rms, "px"), (Quantity::RmseXy, 0.25, "m"), (Quantity::RmseZ, 0.5, "m")];
            let figures = figures.map(|(quantity, value, unit)| Figure::plain(quantity, value, unit));
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
        let rms = &b.figures[&(0, Quantity::OverFrame.into())];
        assert!(rms.len() == 2 && rms.values().all(|numbers| numbers.value == 2.0));
    }

    /// Writes a run with one trial of image points, and their adjustments.
    fn put(folder: &Path, points: [&RunInfo; 2], adjusted: &str, unit: &'static str) {
        let table = |table: Stored| Compressor::new(std::fs::File::create(folder.join(table.file())).unwrap());
        let info = |label: &str, version: &str| MethodInfo { label: label.into(), version: version.into(), unavailable: None };
        let mut records =
            RecordWriter::new(table(Stored::Points), points[0].clone(), vec![info("opencv_subpix", "4.10"), info("b", "1")]).unwrap();
        let point = |method, target: &str, dx| {
            let position = calibench_model::PixelPoint::new(10.0 + dx, 20.0);
            calibench_records::results::PointResult::new("v", target, method, Outcome::Measured { position, error: Some((dx, 0.0)) })
        };
        records.trial(&Trial { points: vec![point(0, "t", 0.25), point(1, "t", 0.5)], ..Trial::default() }).unwrap();
        records.finish().unwrap().finish().unwrap();
        let methods = vec![info("opencv_subpix", "4.10"), info(adjusted, "1")];
        let mut adjustments = CalibrationWriter::new(table(Stored::Adjustments), points[1].clone(), methods, vec!["held".into()]).unwrap();
        let figures = [(Quantity::OverFrame, "px"), (Quantity::RmseXy, unit)].map(|(quantity, unit)| Figure::plain(quantity, 2.0, unit));
        let one = |method| Calibrated { method, set: 0, outcome: Ok(figures.to_vec()), check_failed: None };
        adjustments.trial(0, &[one(0), one(1)]).unwrap();
        adjustments.finish().unwrap().finish().unwrap();
    }

    #[test]
    fn tables_that_do_not_belong_together_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let run = |scenario: &str, seed| RunInfo { scenario: scenario.into(), seed, revision: "r".into(), detector: None };
        let own = run("f/s", 9);
        let read = |name: &str| recorded(folder.path(), name, "m").map_err(|error| error.to_string());
        put(folder.path(), [&own; 2], "b", "m");
        let table = read("f/s").unwrap();
        let [opencv, b] = ["opencv_subpix", "b"].map(|label| table.method(label).unwrap());
        assert_eq!((opencv.images.len(), b.images.len(), opencv.points.len()), (1, 1, 1), "its image point, and its camera");
        assert_eq!((&*opencv.library, &*b.library), ("OpenCV 4.10", ""));
        assert!(read("f/z").unwrap_err().contains("holds records of `f/s`, expected those of `f/z`"));
        for (points, adjusted, method, unit, expected) in [
            (&own, &run("f/z", 9), "b", "m", "calibrations.csv.gz: holds records of `f/z`"),
            (&run("f/z", 9), &own, "b", "m", "records.csv.gz: holds records of `f/z`"),
            (&own, &run("f/s", 8), "b", "m", "was run with another seed"),
            (&own, &own, "c", "m", "has a method `c` that records.csv.gz has not"),
            (&own, &own, "b", "mm", "has `rmse_xy` in `mm`, expected the scenario's `m`"),
        ] {
            put(folder.path(), [points, adjusted], method, unit);
            let error = read("f/s").unwrap_err();
            assert!(error.contains(expected), "{expected}: {error}");
        }
    }
}
