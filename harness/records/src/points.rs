//! Records of points: one tidy CSV a run, a row a point. What measuring leaves for scoring and reporting.

use std::io::{Read, Write};

use calibench_model::{PixelPoint, Rejection};

use csv::StringRecord;

use crate::cells::{Cells, RecordError, open, write_row};
use crate::digits::{coordinates, deviation, difference};
use crate::interned::Names;
use crate::once::{Once, Shared};
use crate::order::Order;
use crate::results::{LOST, MethodInfo, Outcome, PointResult, Trial};

/// The columns of a records file.
pub const COLUMNS: [&str; 17] = [
    "scenario",
    "trial",
    "view",
    "target",
    "method",
    "version",
    "x",
    "y",
    "x_true",
    "y_true",
    "bound",
    "predicted",
    "unit",
    "status",
    "reason",
    "seed",
    "revision",
];

const SCENARIO: usize = 0;
const TRIAL: usize = 1;
const VIEW: usize = 2;
const TARGET: usize = 3;
const METHOD: usize = 4;
const VERSION: usize = 5;
const X: usize = 6;
const Y: usize = 7;
const X_TRUE: usize = 8;
const Y_TRUE: usize = 9;
const BOUND: usize = 10;
const PREDICTED: usize = 11;
const UNIT: usize = 12;
const STATUS: usize = 13;
const REASON: usize = 14;
const SEED: usize = 15;
const REVISION: usize = 16;

/// What all rows of a file share.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RunInfo {
    /// The scenario's name.
    pub scenario: String,
    /// The seed of the run.
    pub seed: u64,
    /// The code's revision.
    pub revision: String,
    /// Name and version of the detector that gave the approximate positions, where one did.
    pub detector: Option<(String, String)>,
}

/// Writes records, trial by trial.
pub struct RecordWriter<W: Write> {
    csv: csv::Writer<W>,
    run: RunInfo,
    seed: String,
    methods: Vec<MethodInfo>,
    order: Order,
}

/// Where and of which method a row is: trial, view, target, method, version.
type Place<'a> = [&'a str; 5];

/// What rounding to the file's decimals may change of a distance, px.
const DIGITS: f64 = 1e-8;

/// The numbers of a point that was not measured.
const NONE: [String; 6] = [const { String::new() }; 6];

impl<W: Write> RecordWriter<W> {
    /// Starts a file with its header and a row for each unavailable method.
    ///
    /// # Errors
    /// What the output refuses.
    pub fn new(output: W, run: RunInfo, methods: Vec<MethodInfo>) -> Result<Self, csv::Error> {
        let mut csv = csv::Writer::from_writer(output);
        csv.write_record(COLUMNS)?;
        let mut writer = Self { csv, seed: run.seed.to_string(), run, methods: Vec::new(), order: Order::default() };
        if let Some((name, version)) = writer.run.detector.clone() {
            writer.row(["", "", "", &name, &version], &NONE, "", "detector", "gave the approximate positions")?;
        }
        for MethodInfo { label, version, unavailable } in &methods {
            if let Some(why) = unavailable {
                writer.row(["", "", "", label, version], &NONE, "", "unavailable", why)?;
            }
        }
        writer.methods = methods;
        Ok(writer)
    }

    /// Says of every available method that it is adjusted and measures no point: a row each, before all trials, so that records name their methods.
    ///
    /// # Errors
    /// What the output refuses.
    pub fn adjusted_alone(&mut self) -> Result<(), csv::Error> {
        let methods = std::mem::take(&mut self.methods);
        for MethodInfo { label, version, .. } in methods.iter().filter(|method| method.unavailable.is_none()) {
            self.row(["", "", "", label, version], &NONE, "", "adjusted", "measures no point")?;
        }
        self.methods = methods;
        Ok(())
    }

    /// Adds a trial: a row for each point, what the methods say of one target one after the other, with its true position where that is known, its bound and
    /// the method's own standard deviation where there are such, or with the reason why it was rejected. Coordinates have nine decimals, and so has the
    /// error that is their difference; standard deviations have six significant digits.
    ///
    /// # Errors
    /// What the output refuses.
    pub fn trial(&mut self, trial: &Trial) -> Result<(), csv::Error> {
        let number = trial.number.to_string();
        let methods = std::mem::take(&mut self.methods);
        for (view, why) in &trial.missed_views {
            for method in methods.iter().filter(|method| method.unavailable.is_none()) {
                self.row([&number, view, "", &method.label, &method.version], &NONE, "", "missed", why)?;
            }
        }
        for point in self.order.of(&trial.points) {
            let (label, version) = methods.get(point.method).map_or(("", ""), |m| (&*m.label, &*m.version));
            let place = [&*number, &*point.view, &*point.target, label, version];
            match point.outcome {
                Outcome::Rejected(why) => self.row(place, &NONE, "px", "rejected", why.name())?,
                Outcome::Measured { position, error } => {
                    let status = if point.outcome.is_lost() { "lost" } else { "measured" };
                    let [x, y, x_true, y_true] = coordinates(position, error);
                    let [bound, predicted] = [point.bound, point.predicted].map(|sigma| sigma.map_or_else(String::new, deviation));
                    self.row(place, &[x, y, x_true, y_true, bound, predicted], "px", status, "")?;
                }
            }
        }
        self.methods = methods;
        Ok(())
    }

    /// Ends the file and gives back its output.
    ///
    /// # Errors
    /// What the output refuses.
    pub fn finish(self) -> Result<W, csv::Error> {
        Ok(self.csv.into_inner().map_err(csv::IntoInnerError::into_error)?)
    }

    fn row(&mut self, place: Place<'_>, numbers: &[String; 6], unit: &str, status: &str, reason: &str) -> Result<(), csv::Error> {
        let head = [&*self.run.scenario].into_iter().chain(place);
        let tail = [unit, status, reason, &self.seed, &self.run.revision];
        write_row(&mut self.csv, head.chain(numbers.iter().map(String::as_str)).chain(tail))
    }
}

/// What a records file holds besides its trials.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RecordHead {
    /// What all rows share.
    pub run: RunInfo,
    /// The methods, in the order of their first row.
    pub methods: Vec<MethodInfo>,
}

/// Reads records and hands on one trial after the other with the methods met so far, which the trial's points index.
///
/// # Errors
/// A file that was not written by [`RecordWriter`]: among others one whose rows are of several runs, whose trials do not rise, or in which a method says twice
/// what it made of a target in an image of a trial.
pub fn read_records(input: impl Read, mut sink: impl FnMut(Trial, &[MethodInfo])) -> Result<RecordHead, RecordError> {
    let mut csv = open(input, &COLUMNS)?;
    let mut head = RecordHead { run: RunInfo::default(), methods: Vec::new() };
    let (mut trial, mut names, mut last, mut record) = (None::<Trial>, Known::default(), 0, StringRecord::new());
    let mut shared = Shared::new([SCENARIO, SEED, REVISION]);
    while csv.read_record(&mut record)? {
        let row = Cells { record: &record, columns: &COLUMNS };
        shared.check(&row)?;
        if head.run.scenario.is_empty() {
            head.run = RunInfo {
                scenario: row.text(SCENARIO).into(),
                seed: row.parse(SEED)?,
                revision: row.text(REVISION).into(),
                detector: None,
            };
        }
        if row.text(STATUS) == "detector" {
            head.run.detector = Some((row.text(METHOD).into(), row.text(VERSION).into()));
            continue;
        }
        let method = method_index(&mut head.methods, &row, last)?;
        last = method;
        if row.text(STATUS) == "unavailable" {
            head.methods[method].unavailable = Some(row.text(REASON).to_owned());
            continue;
        }
        if row.text(STATUS) == "adjusted" {
            continue;
        }
        let number = row.parse(TRIAL)?;
        if names.once.trial(&row, TRIAL, number)? {
            trial.take().into_iter().for_each(|trial| sink(by_method(trial), &head.methods));
        }
        add(trial.get_or_insert_with(|| Trial { number, ..Trial::default() }), &row, (method, &head.methods[method]), &mut names)?;
    }
    trial.into_iter().for_each(|trial| sink(by_method(trial), &head.methods));
    Ok(head)
}

/// A trial whose points are in the order in which they were measured: method by method.
fn by_method(mut trial: Trial) -> Trial {
    trial.points.sort_by_key(|point| point.method);
    trial
}

/// `last` is the place of the method of the row before: mostly it is the same.
fn method_index(methods: &mut Vec<MethodInfo>, row: &Cells<'_>, last: usize) -> Result<usize, RecordError> {
    let (label, version) = (row.text(METHOD), row.text(VERSION));
    if label.is_empty() {
        return Err(row.wrong("a row without a method"));
    }
    let is_it = |method: &MethodInfo| &*method.label == label;
    let place = Some(last).filter(|last| methods.get(*last).is_some_and(is_it)).or_else(|| methods.iter().position(is_it));
    let Some(place) = place else {
        methods.push(MethodInfo { label: label.into(), version: version.into(), unavailable: None });
        return Ok(methods.len() - 1);
    };
    if *methods[place].version == *version { Ok(place) } else { Err(row.other(VERSION, &methods[place].version)) }
}

/// Names of views and targets, each of which is kept once, and which of them a trial has had.
#[derive(Default)]
struct Known {
    views: Names,
    targets: Names,
    once: Once<3>,
}

/// Adds a row to its trial.
fn add(trial: &mut Trial, row: &Cells<'_>, (method, head): (usize, &MethodInfo), names: &mut Known) -> Result<(), RecordError> {
    let (view, target) = (names.views.get(row.text(VIEW)), names.targets.get(row.text(TARGET)));
    if head.unavailable.is_some() {
        return Err(row.wrong(&format!("`{}` is unavailable and says what it made of `{view}/{target}`", head.label)));
    }
    if !names.once.is_new([view.as_ptr().addr(), target.as_ptr().addr(), method]) {
        return Err(row.wrong(&format!("`{}` says twice what it made of `{view}/{target}` in trial {}", head.label, trial.number)));
    }
    let outcome = match row.text(STATUS) {
        "missed" => {
            // One row a method: the view is missed once.
            let missed = (view, row.text(REASON).to_owned());
            if !trial.missed_views.contains(&missed) {
                trial.missed_views.push(missed);
            }
            return Ok(());
        }
        "rejected" => {
            let why = Rejection::ALL.into_iter().find(|why| why.name() == row.text(REASON));
            if let Some(column) = (X..=PREDICTED).find(|column| !row.text(*column).is_empty()) {
                return Err(row.bad(column));
            }
            Outcome::Rejected(why.ok_or_else(|| row.wrong("unknown reason"))?)
        }
        status @ ("measured" | "lost") => {
            let position = PixelPoint::new(row.number(X)?, row.number(Y)?);
            let error = match (row.optional_number(X_TRUE)?, row.optional_number(Y_TRUE)?) {
                (Some(x), Some(y)) => Some((difference(position.x, x), difference(position.y, y))),
                (None, None) => None,
                _ => return Err(row.wrong("one of `x_true` and `y_true` without the other")),
            };
            let distance = error.map_or(0.0, |(dx, dy)| dx.hypot(dy));
            if (distance - LOST).abs() > DIGITS && (distance > LOST) != (status == "lost") {
                return Err(row.wrong(&format!("column `status` holds `{status}` {distance:.6} px from the truth")));
            }
            Outcome::Measured { position, error }
        }
        _ => return Err(row.bad(STATUS)),
    };
    if row.text(UNIT) != "px" {
        return Err(row.other(UNIT, "px"));
    }
    let (bound, predicted) = (row.optional_number(BOUND)?, row.optional_number(PREDICTED)?);
    trial.points.push(PointResult { bound, predicted, ..PointResult::new(view, target, method, outcome) });
    Ok(())
}

#[cfg(test)]
mod tests;
