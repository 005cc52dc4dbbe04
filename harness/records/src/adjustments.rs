//! The adjustments of a run as one tidy CSV beside its records.

use std::collections::HashMap;
use std::io::{Read, Write};
use std::sync::Arc;

use csv::StringRecord;

use crate::cells::{Cells, RecordError, open, write_row};
use crate::figures::{FigureName, FigureNames, Group};
use crate::interned::Names;
use crate::once::{Once, Shared};
use crate::points::RunInfo;
use crate::results::{Calibrated, Figure, MethodInfo};

/// The columns of the file.
pub const COLUMNS: [&str; 13] =
    ["scenario", "trial", "method", "set", "group", "name", "value", "sigma", "error", "unit", "status", "reason", "seed"];

/// Writes adjustments, trial by trial.
pub struct CalibrationWriter<W: Write> {
    csv: csv::Writer<W>,
    run: RunInfo,
    methods: Vec<MethodInfo>,
    sets: Vec<String>,
}

impl<W: Write> CalibrationWriter<W> {
    /// Starts a file with its header. `sets` are the names of the sets of parameters.
    ///
    /// # Errors
    /// What the output refuses.
    pub fn new(output: W, run: RunInfo, methods: Vec<MethodInfo>, sets: Vec<String>) -> Result<Self, csv::Error> {
        let mut csv = csv::Writer::from_writer(output);
        csv.write_record(COLUMNS)?;
        Ok(Self { csv, run, methods, sets })
    }

    /// Adds the adjustments of a trial; what failed is a row with its reason.
    ///
    /// # Errors
    /// What the output refuses.
    pub fn trial(&mut self, number: u64, all: &[Calibrated]) -> Result<(), csv::Error> {
        let trial = number.to_string();
        for one in all {
            match &one.outcome {
                Ok(figures) => figures.iter().try_for_each(|figure| self.figure(&trial, one, figure))?,
                Err(why) => self.failure(&trial, one, Group::Network, why)?,
            }
            if let Some(why) = &one.check_failed {
                self.failure(&trial, one, Group::Check, why)?;
            }
        }
        Ok(())
    }

    /// Ends the file and gives back its output.
    ///
    /// # Errors
    /// What the output refuses.
    pub fn finish(self) -> Result<W, csv::Error> {
        Ok(self.csv.into_inner().map_err(csv::IntoInnerError::into_error)?)
    }

    fn figure(&mut self, trial: &str, one: &Calibrated, figure: &Figure) -> Result<(), csv::Error> {
        let [sigma, error] = [figure.sigma, figure.error].map(|number| number.map_or_else(String::new, spread));
        let value = value(figure.value);
        self.row(trial, one, figure.name.group(), figure.name.text(), [&value, &sigma, &error], figure.unit, ["adjusted", ""])
    }

    fn failure(&mut self, trial: &str, one: &Calibrated, group: Group, why: &str) -> Result<(), csv::Error> {
        self.row(trial, one, group, "", ["", "", ""], "", ["failed", why])
    }

    #[expect(clippy::too_many_arguments, reason = "a row has as many columns")]
    fn row(
        &mut self,
        trial: &str,
        one: &Calibrated,
        group: Group,
        name: &str,
        numbers: [&str; 3],
        unit: &str,
        [status, reason]: [&str; 2],
    ) -> Result<(), csv::Error> {
        let (method, set) = (&*self.methods[one.method].label, self.sets[one.set].as_str());
        let [value, sigma, error] = numbers;
        let seed = self.run.seed.to_string();
        let cells: [&str; 13] =
            [&self.run.scenario, trial, method, set, group.name(), name, value, sigma, error, unit, status, reason, &seed];
        write_row(&mut self.csv, cells)
    }
}

/// Digits of a figure behind its first: well below what any of them is worth, and files stay small.
const VALUE: usize = 8;
/// Digits of standard deviations and errors behind their first, as records of points have them.
const SPREAD: usize = 5;

fn value(number: f64) -> String {
    format!("{number:.VALUE$e}")
}

fn spread(number: f64) -> String {
    format!("{number:.SPREAD$e}")
}

/// The numbers of `figure` as they are read again from the file that holds it.
pub fn recorded(figure: &Figure) -> Numbers {
    let read = |text: String| text.parse().unwrap_or(f64::NAN);
    let [sigma, error] = [figure.sigma, figure.error].map(|number| number.map(|number| read(spread(number))));
    Numbers { value: read(value(figure.value)), sigma, error }
}

/// A row of the file.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The trial.
    pub trial: u64,
    /// The method's label.
    pub method: Arc<str>,
    /// The set's name.
    pub set: Arc<str>,
    /// The group.
    pub group: Group,
    /// The figure with value, sigma and error, where they are; the reason of a failure otherwise.
    pub figure: Result<(FigureName, Numbers), String>,
    /// The unit of the three; empty for what has none.
    pub unit: Arc<str>,
    /// The seed of the run.
    pub seed: u64,
}

/// The numbers of a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Numbers {
    /// The value, in [`Row::unit`].
    pub value: f64,
    /// Its standard deviation, in the same unit.
    pub sigma: Option<f64>,
    /// Value less truth, in the same unit.
    pub error: Option<f64>,
}

/// Reads a file row by row; what all its rows share. A file without a row says nothing of its run.
///
/// # Errors
/// A file that is not one of these, with its line: among others one whose rows are of several runs, whose trials do not rise, or in which a figure of a trial
/// stands twice, or in two units.
pub fn read(input: impl Read, mut sink: impl FnMut(Row)) -> Result<RunInfo, RecordError> {
    let (mut reader, mut record, mut known) = (open(input, &COLUMNS)?, StringRecord::new(), Known::default());
    let (mut shared, mut run) = (Shared::new([0, 12]), RunInfo::default());
    while reader.read_record(&mut record)? {
        let cells = Cells { record: &record, columns: &COLUMNS };
        shared.check(&cells)?;
        let row = known.row(&cells)?;
        if run.scenario.is_empty() {
            run = RunInfo { scenario: cells.text(0).into(), seed: row.seed, ..run };
        }
        sink(row);
    }
    Ok(run)
}

/// What was read before: names of methods, sets, figures and units, what the trial has said, the figures' units.
#[derive(Default)]
struct Known {
    methods: Names,
    sets: Names,
    figures: FigureNames,
    units: Names,
    once: Once<4>,
    unit_of: HashMap<usize, Arc<str>>,
}

impl Known {
    fn row(&mut self, cells: &Cells<'_>) -> Result<Row, RecordError> {
        let group = Group::named(cells.text(4)).ok_or_else(|| cells.bad(4))?;
        let (place, figure) = match cells.text(10) {
            "adjusted" => {
                let numbers = Numbers { value: cells.number(6)?, sigma: cells.optional_number(7)?, error: cells.optional_number(8)? };
                let (place, name) = self.figures.get(group, cells.text(5)).map_err(|unknown| cells.wrong(&unknown.to_string()))?;
                (place, Ok((name, numbers)))
            }
            // What failed is no figure: one place for each group.
            "failed" => (usize::MAX - group as usize, Err(cells.text(11).to_owned())),
            _ => return Err(cells.bad(10)),
        };
        let (method, set) = (self.methods.get(cells.text(2)), self.sets.get(cells.text(3)));
        let (trial, unit) = (cells.parse(1)?, self.units.get(cells.text(9)));
        self.once.trial(cells, 1, trial)?;
        let address = |name: &Arc<str>| name.as_ptr().addr();
        if !self.once.is_new([address(&method), address(&set), group as usize, place]) {
            let (group, name) = (group.name(), cells.text(5));
            return Err(cells.wrong(&format!("`{method}` says twice what {group} `{name}` of set `{set}` is in trial {trial}")));
        }
        if let Ok((name, _)) = &figure {
            let units = name.quantity().entry().units;
            if !units.have(&unit) {
                return Err(cells.other(9, &units.text()));
            }
            let first = self.unit_of.entry(place).or_insert_with(|| unit.clone());
            if *first != unit {
                return Err(cells.other(9, first));
            }
        }
        Ok(Row { trial, method, set, group, figure, unit, seed: cells.parse(12)? })
    }
}
