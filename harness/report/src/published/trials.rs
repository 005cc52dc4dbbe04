//! Figures of adjustments behind printed cells, trial by trial.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use calibench_records::adjustments::Numbers;
use calibench_records::stored::read_adjustments;

use crate::load::LoadError;
use crate::load::adjustments::FigureKey;

/// Some figures of a run in every trial in which they were found.
#[derive(Debug, Default)]
pub struct Trials(BTreeMap<FigureKey, BTreeMap<u64, Numbers>>);

impl Trials {
    /// Those that are `wanted`, or all, from the records of the scenario `name` in its folder.
    ///
    /// # Errors
    /// Records that cannot be read.
    pub fn of_folder(folder: &Path, name: &str, wanted: Option<&BTreeSet<FigureKey>>) -> Result<Self, LoadError> {
        let mut found = Self::default();
        read_adjustments(folder, name, |row| {
            let Ok((name, numbers)) = row.figure else { return };
            let key = (row.method.to_string(), row.set.to_string(), name);
            if wanted.is_none_or(|wanted| wanted.contains(&key)) {
                found.add(key, row.trial, numbers);
            }
        })?;
        Ok(found)
    }

    /// Adds a figure of a trial.
    pub fn add(&mut self, key: FigureKey, trial: u64, numbers: Numbers) {
        self.0.entry(key).or_default().insert(trial, numbers);
    }

    /// One number of a figure in each trial that has it.
    pub fn of(&self, key: &FigureKey, number: impl Fn(&Numbers) -> Option<f64>) -> BTreeMap<u64, f64> {
        let trials = self.0.get(key).into_iter().flatten();
        trials.filter_map(|(trial, numbers)| Some((*trial, number(numbers)?))).collect()
    }
}

/// `above` over `below` in each trial that has both and no zero below.
pub fn ratio(above: &BTreeMap<u64, f64>, below: &BTreeMap<u64, f64>) -> BTreeMap<u64, f64> {
    let over = |(trial, value): (&u64, &f64)| {
        let below = below.get(trial).filter(|below| **below != 0.0)?;
        Some((*trial, value / below))
    };
    above.iter().filter_map(over).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ratios_are_of_the_same_trial() {
        let [above, below] = [[(0, 2.0), (1, 9.0), (2, 5.0)], [(0, 4.0), (2, 0.0), (3, 1.0)]].map(BTreeMap::from);
        assert_eq!(ratio(&above, &below), BTreeMap::from([(0, 0.5)]));
    }
}
