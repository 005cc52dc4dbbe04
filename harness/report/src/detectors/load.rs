//! Records of detectors over boards.

use std::collections::BTreeMap;
use std::path::Path;

use calibench_records::figures::Quantity;
use calibench_records::names::DETECTION;
use calibench_records::results::{Outcome, Trial};
use calibench_records::statistics::running::Running;

use super::offsets::Offsets;
use crate::LoadError;
use crate::load::adjustments::Summaries;
use crate::sweep::{Gather, LoadedSweep, load_with};

/// A sweep over boards, and perhaps one more key, with detectors among its methods.
pub struct Detectors {
    /// Its records.
    pub sweep: LoadedSweep,
    cells: Vec<BTreeMap<String, Found>>,
    counts: Vec<Option<Summaries>>,
}

/// Points of a method in a cell.
#[derive(Clone, Debug, Default)]
pub struct Found {
    /// Points in view, all trials together.
    pub asked: u64,
    /// Those within a pixel of the truth.
    pub right: u64,
    /// Those further off.
    pub off: u64,
    /// Errors of all that were found, by axis.
    pub errors: [Offsets; 2],
    /// Squared bounds of those in view that have one, px^2.
    pub bounds: Running,
}

impl Gather for BTreeMap<String, Found> {
    fn add(&mut self, trial: &Trial, methods: &[String]) {
        for point in &trial.points {
            if let Some(name) = methods.get(point.method) {
                self.entry(name.clone()).or_default().add(&point.outcome, point.bound);
            }
        }
    }
}

impl Found {
    fn add(&mut self, outcome: &Outcome, bound: Option<f64>) {
        self.asked += 1;
        self.right += u64::from(outcome.kept_error().is_some());
        self.off += u64::from(outcome.is_lost());
        bound.into_iter().for_each(|bound| self.bounds.add(bound * bound));
        if let Outcome::Measured { error: Some((dx, dy)), .. } = outcome {
            self.errors[0].add(*dx);
            self.errors[1].add(*dy);
        }
    }

    /// Median error, px.
    pub fn median(&self) -> Option<[f64; 2]> {
        let [x, y] = &self.errors;
        Some([x.median()?, y.median()?])
    }

    /// Standard deviation of a coordinate about the median, robust, px.
    pub fn scatter(&self) -> Option<f64> {
        let [x, y] = &self.errors;
        Some((0.5 * (x.scatter()?.powi(2) + y.scatter()?.powi(2))).sqrt())
    }

    /// The bound of a coordinate, px.
    pub fn bound(&self) -> Option<f64> {
        self.bounds.mean().map(|square| (0.5 * square).sqrt())
    }
}

/// What is counted of a detector in a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Counted {
    /// Images, all trials together.
    pub images: f64,
    /// Those in which it found the board.
    pub boards: f64,
    /// Points that it named as another one in its place.
    pub wrong: f64,
    /// Points that it named and that lie where none is.
    pub nowhere: f64,
}

impl Detectors {
    /// Whether any method found boards in cells whose figures are these.
    pub fn are_in(cells: &[Option<Summaries>]) -> bool {
        cells.iter().flatten().any(|counts| counts.sets.iter().any(|set| set == DETECTION))
    }

    /// Reads the records of sweep `name`, whose `counts` were read before; `None` if there are none.
    ///
    /// # Errors
    /// Records that are not whole or not of this version.
    pub fn load(records: &Path, name: &str, counts: Vec<Option<Summaries>>) -> Result<Option<Self>, LoadError> {
        Ok(load_with(records, name)?.map(|(sweep, cells)| Self { sweep, cells, counts }))
    }

    /// The words of the boards.
    pub fn boards(&self) -> Vec<&str> {
        self.sweep.sweep.axes[0].values.iter().map(|value| value.text.as_str()).collect()
    }

    /// The values of the other key, in words; one without a name if there is none.
    pub fn values(&self) -> Vec<String> {
        let axis = self.sweep.sweep.axes.get(1);
        axis.map_or_else(|| vec![String::new()], |axis| axis.values.iter().map(|value| value.text.clone()).collect())
    }

    fn cell(&self, board: usize, value: usize) -> usize {
        board * self.values().len() + value
    }

    /// The methods that found or measured anything of a board in a cell, in the order of the scenario.
    pub fn found(&self, board: usize, value: usize) -> Vec<(&str, &Found)> {
        let cell = &self.cells[self.cell(board, value)];
        self.sweep.methods.iter().filter_map(|method| Some((method.name.as_str(), cell.get(&method.name)?))).collect()
    }

    /// The version of a method.
    pub fn version(&self, method: &str) -> Option<&str> {
        self.sweep.methods.iter().find(|known| known.name == method).map(|known| &*known.version)
    }

    /// What is counted of a detector; `None` of other methods.
    pub fn counted(&self, board: usize, value: usize, method: &str) -> Option<Counted> {
        let counts = self.counts[self.cell(board, value)].as_ref()?;
        let sum = |quantity: Quantity| {
            let summary = counts.of_set(method, DETECTION, quantity)?;
            Some(summary.value.mean()? * summary.value.count as f64)
        };
        Some(Counted {
            images: sum(Quantity::BoardImages)?,
            boards: sum(Quantity::BoardGrids)?,
            wrong: sum(Quantity::BoardWrongLabels)?,
            nowhere: sum(Quantity::BoardOff)?,
        })
    }
}
