//! Sweeps: a scenario over values of some of its keys. A cell is the scenario with one value of each.

mod axis;
pub mod read;
mod replace;
pub mod wire;

use calibench_diagnostics::Problem;
use calibench_measure::Registry;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

pub use axis::{Axis, Value};

/// More cells than this are not run at one go.
pub const MOST_CELLS: usize = 2000;

/// The swept keys of a scenario.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// In the order of the file; the last changes fastest.
    pub axes: Vec<Axis>,
    /// The file as the user named it.
    pub file: String,
}

impl Sweep {
    /// How many cells.
    pub fn cells(&self) -> usize {
        self.axes.iter().map(|axis| axis.values.len()).product()
    }

    /// The place on each axis of cell `index`.
    ///
    /// # Panics
    /// Never for an index below [`Self::cells`].
    pub fn places(&self, mut index: usize) -> Vec<usize> {
        let mut places: Vec<usize> = Vec::with_capacity(self.axes.len());
        for axis in self.axes.iter().rev() {
            places.push(index % axis.values.len());
            index /= axis.values.len();
        }
        places.reverse();
        places
    }

    /// The value on each axis of cell `index`.
    pub fn values(&self, index: usize) -> Vec<&Value> {
        self.axes.iter().zip(self.places(index)).map(|(axis, place)| &axis.values[place]).collect()
    }

    /// The values of cell `index` in a line, as in `blur=0.3, grey_noise=0.01`.
    pub fn label(&self, index: usize) -> String {
        let pairs = self.axes.iter().zip(self.values(index)).map(|(axis, value)| format!("{}={}", axis.name, value.text));
        pairs.collect::<Vec<_>>().join(", ")
    }

    /// Whether it changes the methods.
    pub fn changes_methods(&self) -> bool {
        self.axes.iter().any(|axis| axis.path.starts_with("method."))
    }

    /// The table of a file with the values of cell `index` in their places.
    pub(super) fn replaced<'i>(
        &'i self,
        root: &DeTable<'i>,
        index: usize,
        registry: &Registry,
        problems: &mut Vec<Problem>,
    ) -> DeTable<'i> {
        let mut table = root.clone();
        for (axis, value) in self.axes.iter().zip(self.values(index)) {
            if let Some(value) = value.toml() {
                replace::replace(&mut table, axis, &value, registry, problems);
            }
        }
        table
    }

    /// The table of a file with a word in the place of each swept value: the same for all cells, and whatever values there are.
    pub(super) fn without_values<'i>(&'i self, root: &DeTable<'i>) -> DeTable<'i> {
        let mut table = root.clone();
        for axis in &self.axes {
            let word = Spanned::new(axis.span.clone(), DeValue::String("swept".into()));
            // Methods have no part in what is drawn, and a key that there is not is told elsewhere.
            if !axis.path.starts_with("method.") {
                replace::replace(&mut table, axis, &word, &Registry::default(), &mut Vec::new());
            }
        }
        table
    }
}
