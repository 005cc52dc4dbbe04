//! The records of the atlas: figures by cell, and losses by trial for paired comparisons.

use std::collections::BTreeMap;
use std::path::Path;

use calibench_records::results::{LOST, Outcome, Trial};

use crate::LoadError;
use crate::sweep::{Gather, LoadedSweep, load_with};

/// The mean squared error of the points of one trial, px^2, with every lost or rejected point as one of [`LOST`] px; by trial.
pub type Losses = BTreeMap<u64, f64>;

/// One sweep of the atlas.
pub struct Part {
    /// Its figures.
    pub sweep: LoadedSweep,
    /// By cell.
    cells: Vec<Cell>,
}

/// What the atlas asks of one cell, by name of the method.
#[derive(Default)]
struct Cell {
    losses: BTreeMap<String, Losses>,
    /// Points that were measured wrong, by more than `is_wrong` allows.
    wrong: BTreeMap<String, u64>,
}

impl Gather for Cell {
    fn add(&mut self, trial: &Trial, methods: &[String]) {
        for (method, loss) in losses(trial) {
            if let Some(name) = methods.get(method) {
                self.losses.entry(name.clone()).or_default().insert(trial.number, loss);
            }
        }
        for name in trial.points.iter().filter(|point| is_wrong(&point.outcome)).filter_map(|point| methods.get(point.method)) {
            *self.wrong.entry(name.clone()).or_default() += 1;
        }
    }
}

/// A measured point further off is wrong without a word, px: beyond any noise of the atlas, and near enough that nobody notices.
pub const WRONG: f64 = 0.25;

impl Part {
    /// Reads the records of sweep `name`; `None` if there are none.
    ///
    /// # Errors
    /// Records that are not whole or not of this version.
    pub fn load(records: &Path, name: &str) -> Result<Option<Self>, LoadError> {
        Ok(load_with(records, name)?.map(|(sweep, cells)| Self { sweep, cells }))
    }

    /// How many points of a cell method `method` measured wrong, by more than `is_wrong` allows.
    pub fn wrong(&self, cell: usize, method: usize) -> u64 {
        self.cells.get(cell).and_then(|cell| cell.wrong.get(&self.sweep.methods[method].name)).copied().unwrap_or(0)
    }

    /// The losses of method `method` over `cells`: for each trial the mean over these cells, each of which has the same points.
    pub fn losses(&self, cells: &[usize], method: usize) -> Vec<f64> {
        let name = &self.sweep.methods[method].name;
        let of = |cell: &usize| self.cells.get(*cell)?.losses.get(name);
        let all: Vec<&Losses> = cells.iter().filter_map(of).collect();
        let Some(first) = all.first().filter(|_| all.len() == cells.len()) else { return Vec::new() };
        let sum = |trial: &u64| all.iter().map(|losses| losses.get(trial).copied()).sum::<Option<f64>>();
        first.keys().filter_map(sum).map(|sum| sum / cells.len() as f64).collect()
    }

    /// The cells whose values on the axis called `key` pass `test`, for all of `tests`.
    pub fn cells(&self, tests: &[(&str, &dyn Fn(f64) -> bool)]) -> Vec<usize> {
        let axes = &self.sweep.sweep.axes;
        let passes = |cell: &usize| {
            let values = self.sweep.sweep.values(*cell);
            tests.iter().all(|(key, test)| {
                let place = axes.iter().position(|axis| axis.path == *key);
                place.and_then(|place| values[place].number).is_some_and(test)
            })
        };
        (0..self.sweep.cells.len()).filter(passes).collect()
    }
}

fn is_wrong(outcome: &Outcome) -> bool {
    matches!(outcome, Outcome::Measured { error: Some((dx, dy)), .. } if dx.hypot(*dy) > WRONG)
}

/// The loss of each method in a trial.
fn losses(trial: &Trial) -> BTreeMap<usize, f64> {
    let mut sums: BTreeMap<usize, (f64, f64)> = BTreeMap::new();
    for point in &trial.points {
        let square = match point.outcome {
            Outcome::Measured { error: Some((dx, dy)), .. } => (dx * dx + dy * dy).min(LOST * LOST),
            _ => LOST * LOST,
        };
        let sum = sums.entry(point.method).or_default();
        *sum = (sum.0 + square, sum.1 + 1.0);
    }
    sums.into_iter().map(|(method, (sum, count))| (method, sum / count)).collect()
}
