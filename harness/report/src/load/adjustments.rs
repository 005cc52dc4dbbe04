//! The adjustments of a run, read for a report.

use std::collections::{BTreeMap, HashMap};
use std::path::Path;
use std::sync::Arc;

use calibench_records::adjustments::{Numbers, Row};
use calibench_records::description::Sweep;
use calibench_records::figures::{FigureName, Group, Quantity};
use calibench_records::names::cell_folder;
use calibench_records::statistics::running::{Paired, Running};
use calibench_records::stored::{Table, read_adjustments};

use crate::LoadError;

/// A figure over all trials.
#[derive(Clone, Debug, Default)]
pub struct Summary {
    /// In the first trial.
    pub first: Option<Numbers>,
    /// Values.
    pub value: Running,
    /// Reported standard deviations.
    pub sigma: Running,
    /// Squared errors against the truth.
    pub square: Running,
    /// Reported standard deviation over that of the reference method, trial by trial.
    pub sigma_ratio: Running,
    /// Value over that of the reference method, trial by trial.
    pub value_ratio: Running,
    /// Errors beside those of the reference method.
    pub errors: Paired,
    /// Values beside those of the reference method, for figures that are themselves root mean squares.
    pub values: Paired,
}

/// What of a figure is meant: method, set of parameters, figure.
pub type FigureKey = (String, String, FigureName);

/// All adjustments of a run. Its size does not grow with the number of trials.
#[derive(Clone, Debug, Default)]
pub struct Summaries {
    /// The methods, in the order of the file; the first is the reference.
    pub methods: Vec<String>,
    /// The sets, in the order of the file; the first is scored in full.
    pub sets: Vec<String>,
    /// How many trials.
    pub trials: u64,
    /// Every figure.
    pub figures: BTreeMap<FigureKey, Summary>,
    /// Residuals of the first trial in the order of the file: method, image, point, axis, px. Of a cell of a sweep they are not kept: there are many cells.
    pub residuals: Vec<(String, String, f64)>,
    /// The set of each residual.
    pub sets_of_residuals: Vec<String>,
    /// Adjustments that failed, by method and set, with the first reason.
    pub failed: BTreeMap<(String, String, Group), (u64, String)>,
}

/// Reads the adjustments of the scenario `name` in its folder; `None` if it has none.
///
/// # Errors
/// A file that is not whole or not of this version.
pub fn load(folder: &Path, name: &str) -> Result<Option<Summaries>, LoadError> {
    read(folder, name, Reader { keeps_residuals: true, ..Reader::default() }, |_| ())
}

/// A cell of a sweep: the scenario's name, its sweep, the cell's place.
pub type CellOf<'a> = (&'a str, &'a Sweep, usize);

/// Reads the adjustments of a cell of a sweep, which lies in the scenario's `folder`, without their residuals; `None` if it has none.
///
/// # Errors
/// As [`load`].
pub fn load_cell(folder: &Path, cell: CellOf<'_>) -> Result<Option<Summaries>, LoadError> {
    load_cell_with(folder, cell, |_| ())
}

/// As [`load_cell`]; `watch` is shown every row.
///
/// # Errors
/// As [`load`].
pub fn load_cell_with(folder: &Path, (name, sweep, index): CellOf<'_>, watch: impl FnMut(&Row)) -> Result<Option<Summaries>, LoadError> {
    load_with(&cell_folder(folder, index), &sweep.run(name, index), watch)
}

/// The adjustments of the run called `name` in `folder`, without their residuals; `watch` is shown every row.
pub(crate) fn load_with(folder: &Path, name: &str, watch: impl FnMut(&Row)) -> Result<Option<Summaries>, LoadError> {
    read(folder, name, Reader::default(), watch)
}

fn read(folder: &Path, name: &str, mut reader: Reader, mut watch: impl FnMut(&Row)) -> Result<Option<Summaries>, LoadError> {
    if !Table::Adjustments.is_in(folder)? {
        return Ok(None);
    }
    read_adjustments(folder, name, |row| {
        watch(&row);
        reader.add(row);
    })?;
    Ok(Some(reader.found()))
}

/// A figure while trials are read.
struct Kept {
    key: Key,
    summary: Summary,
    /// Its numbers in a trial, and in which.
    now: (u64, Numbers),
    /// The place of the same figure of the reference method, once that has come.
    reference: Option<usize>,
}

/// Method, set and figure, each name kept once.
type Key = (Arc<str>, Arc<str>, FigureName);

#[derive(Default)]
struct Reader {
    found: Summaries,
    keeps_residuals: bool,
    trial: Option<u64>,
    /// In the order in which they came.
    figures: Vec<Kept>,
    places: HashMap<Key, usize>,
    /// The place after that of the row before: trials have their figures in the same order.
    next: usize,
}

impl Reader {
    fn add(&mut self, row: Row) {
        if self.trial != Some(row.trial) {
            self.trial = Some(row.trial);
            self.found.trials += 1;
        }
        let remember = |list: &mut Vec<String>, name: &str| {
            if !list.iter().any(|known| known == name) {
                list.push(name.to_owned());
            }
        };
        remember(&mut self.found.methods, &row.method);
        remember(&mut self.found.sets, &row.set);
        let text = |name: &Arc<str>| name.to_string();
        match row.figure {
            Err(why) => self.found.failed.entry((text(&row.method), text(&row.set), row.group)).or_insert((0, why)).0 += 1,
            Ok(_) if row.group == Group::Point && !self.keeps_residuals => {}
            Ok((name, numbers)) if row.group == Group::Point => {
                self.found.residuals.push((text(&row.method), name.to_string(), numbers.value));
                self.found.sets_of_residuals.push(text(&row.set));
            }
            Ok((name, numbers)) => self.figure((row.method, row.set, name), numbers),
        }
    }

    fn figure(&mut self, key: Key, numbers: Numbers) {
        let trial = self.found.trials;
        let place = self.place(key);
        self.figures[place].now = (trial, numbers);
        let reference = self.reference(place).map(|reference| self.figures[reference].now).filter(|now| now.0 == trial);
        let summary = &mut self.figures[place].summary;
        summary.first.get_or_insert(numbers);
        summary.value.add(numbers.value);
        numbers.sigma.into_iter().for_each(|sigma| summary.sigma.add(sigma));
        numbers.error.into_iter().for_each(|error| summary.square.add(error * error));
        let Some((_, reference)) = reference else { return };
        if let (Some(own), Some(other)) = (numbers.sigma, reference.sigma.filter(|sigma| *sigma > 0.0)) {
            summary.sigma_ratio.add(own / other);
        }
        if reference.value != 0.0 {
            summary.value_ratio.add(numbers.value / reference.value);
        }
        summary.values.add(numbers.value, reference.value);
        if let (Some(own), Some(other)) = (numbers.error, reference.error) {
            summary.errors.add(own, other);
        }
    }

    fn place(&mut self, key: Key) -> usize {
        let is_it = |kept: &Kept| {
            let same = |a: &Arc<str>, b: &Arc<str>| Arc::ptr_eq(a, b) || a == b;
            kept.key.2 == key.2 && same(&kept.key.1, &key.1) && same(&kept.key.0, &key.0)
        };
        let place = if self.figures.get(self.next).is_some_and(is_it) {
            self.next
        } else if let Some(place) = self.places.get(&key) {
            *place
        } else {
            let none = Numbers { value: f64::NAN, sigma: None, error: None };
            self.places.insert(key.clone(), self.figures.len());
            self.figures.push(Kept { key, summary: Summary::default(), now: (0, none), reference: None });
            self.figures.len() - 1
        };
        self.next = if place + 1 < self.figures.len() { place + 1 } else { 0 };
        place
    }

    /// The place of the same figure of the reference method; of that method it is its own.
    fn reference(&mut self, place: usize) -> Option<usize> {
        if self.figures[place].reference.is_none() {
            let (_, set, name) = self.figures[place].key.clone();
            let first: Arc<str> = self.found.methods.first()?.as_str().into();
            self.figures[place].reference = self.places.get(&(first, set, name)).copied();
        }
        self.figures[place].reference
    }

    fn found(mut self) -> Summaries {
        let text = |(method, set, name): Key| (method.to_string(), set.to_string(), name);
        self.found.figures = self.figures.into_iter().map(|kept| (text(kept.key), kept.summary)).collect();
        self.found
    }
}

impl Summaries {
    /// A figure of the first set.
    pub fn get(&self, method: &str, figure: impl Into<FigureName>) -> Option<&Summary> {
        self.of_set(method, self.sets.first()?, figure)
    }

    /// A parameter of the interior orientation, of the first set.
    pub fn parameter(&self, method: &str, name: &str) -> Option<&Summary> {
        self.get(method, Quantity::Parameter.of(&[name]))
    }

    /// A figure of any set.
    pub fn of_set(&self, method: &str, set: &str, figure: impl Into<FigureName>) -> Option<&Summary> {
        self.figures.get(&(method.to_owned(), set.to_owned(), figure.into()))
    }

    /// Images that were left out of the first set's adjustments of a method, a trial: fewer points than a pose takes were measured in them.
    pub fn left_out(&self, method: &str) -> f64 {
        let all = self.get(method, Quantity::ImagesLeftOut).map_or(0.0, |left| left.value.mean * left.value.count as f64);
        all / self.trials.max(1) as f64
    }

    /// How many adjustments of a method failed, in one set or in all.
    pub fn failures(&self, method: &str, set: Option<&str>) -> u64 {
        let meant = |(m, s, _): &(String, String, Group)| m == method && set.is_none_or(|set| s == set);
        self.failed.iter().filter(|(key, _)| meant(key)).map(|(_, (count, _))| count).sum()
    }

    /// The parameters of a set.
    pub fn parameters(set: &str) -> impl Iterator<Item = &str> {
        set.split(',')
    }

    /// The parameters that are scored.
    pub fn scored(&self) -> Vec<&str> {
        self.sets.first().map(|set| Self::parameters(set).collect()).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A residual is kept where it is asked for, and is no figure in either case.
    #[test]
    fn a_cell_has_no_residuals() {
        for keeps_residuals in [false, true] {
            let mut reader = Reader { keeps_residuals, ..Reader::default() };
            reader.add(row(0, "good", "c", Ok((3.0, 1.0, 1.0))));
            reader.add(residual(0));
            let found = reader.found();
            let kept = usize::from(keeps_residuals);
            assert_eq!((found.figures.len(), found.residuals.len(), found.sets_of_residuals.len()), (1, kept, kept));
        }
    }

    fn row(trial: u64, method: &str, name: &str, figure: Result<(f64, f64, f64), &str>) -> Row {
        let numbers = |(value, sigma, error)| Numbers { value, sigma: Some(sigma), error: Some(error) };
        let figure = figure.map(|all| (Quantity::Parameter.of(&[name]), numbers(all))).map_err(str::to_owned);
        Row { trial, method: method.into(), set: "c,b1".into(), group: Group::Iop, figure, unit: "mm".into(), seed: 7 }
    }

    fn residual(trial: u64) -> Row {
        let numbers = Numbers { value: 0.5, sigma: None, error: None };
        let figure = Ok((Quantity::ResidualX.of(&["6", "left/3"]), numbers));
        Row { group: Group::Point, figure, unit: "px".into(), ..row(trial, "good", "c", Err("")) }
    }

    fn close(found: Option<f64>, expected: f64) {
        assert!((found.unwrap() - expected).abs() < 1e-12, "{found:?} is not {expected}");
    }

    /// The reference has no sigma in the second trial, no value in the third, and failed in the fourth.
    #[test]
    fn ratios_leave_out_trials_whose_reference_is_nothing() {
        let mut reader = Reader { keeps_residuals: true, ..Reader::default() };
        let reference = [Ok((2.0, 0.5, 1.0)), Ok((4.0, 0.0, -2.0)), Ok((0.0, 0.25, 2.0)), Err("no convergence")];
        let own = [(3.0, 1.5, 3.0), (2.0, 7.0, 1.0), (5.0, 0.75, -1.0), (9.0, 9.0, 9.0)];
        for ((trial, reference), own) in (0..).zip(reference).zip(own) {
            reader.add(row(trial, "pixel", "c", reference));
            reader.add(row(trial, "good", "c", Ok(own)));
        }
        reader.add(row(3, "good", "c", Err("one")));
        reader.add(row(4, "good", "c", Err("two")));
        reader.add(residual(4));
        let found = reader.found();
        assert_eq!((found.trials, found.methods.len(), found.sets.len(), found.scored()), (5, 2, 1, vec!["c", "b1"]));
        let c = found.parameter("good", "c").unwrap();
        assert_eq!(c.first, Some(Numbers { value: 3.0, sigma: Some(1.5), error: Some(3.0) }));
        assert_eq!((c.value.count, c.sigma_ratio.count, c.value_ratio.count), (4, 2, 2));
        close(c.value.mean(), 19.0 / 4.0);
        close(c.sigma.mean(), 18.25 / 4.0);
        close(c.square.mean(), 92.0 / 4.0);
        close(c.sigma_ratio.mean(), 3.0);
        close(c.value_ratio.mean(), 1.0);
        // Squares 9, 1, 1 against 1, 4, 4; values 9, 4, 25 against 4, 16, 0.
        close(c.errors.ratio().map(|ratio| ratio.0), (11.0_f64 / 9.0).sqrt());
        close(c.values.ratio().map(|ratio| ratio.0), (38.0_f64 / 20.0).sqrt());
        let failed = |method: &str| found.failed.get(&(method.to_owned(), "c,b1".to_owned(), Group::Iop)).cloned();
        assert_eq!((found.failures("good", None), found.failures("good", Some("c,b1")), found.failures("good", Some("c"))), (2, 2, 0));
        assert_eq!((failed("good"), failed("pixel")), (Some((2, "one".into())), Some((1, "no convergence".into()))));
        assert_eq!(found.residuals, [("good".to_owned(), "6/left/3/x".to_owned(), 0.5)]);
    }
}
