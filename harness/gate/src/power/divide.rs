//! False alarms: the stored trials of a run divided at random into a baseline and a run that are alike.

use std::collections::BTreeMap;
use std::sync::Arc;

use calibench_random::{Key, Purpose, stream};
use rand::seq::SliceRandom;
use rayon::prelude::*;

use crate::entry::Entry;
use crate::finding::Finding;
use crate::judge::{self, Family, Test};
use crate::pairs::{Item, Pairs};
use crate::table::{MethodTable, Table};
use crate::{LEAST_PAIRS, decide};

/// The false alarms of many divisions.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Alarms {
    /// How many divisions.
    pub divisions: usize,
    /// How many of them the tests fail.
    pub failed: usize,
    /// How many of them leave a target, found by both halves together, in too few trials for a test. A check would name that; it is no statement of chance: with
    /// the same seed the trials are not shuffled, and no target loses its pair.
    pub lacking: usize,
    /// How many methods take part in each division.
    pub methods: usize,
    /// How many tests share the error budget of a division.
    pub tests: usize,
    /// How many methods have too few trials for two halves.
    pub too_few: usize,
}

/// The points of a method by trial and target.
struct Stored<'a> {
    scenario: &'a str,
    label: &'a str,
    targets: Vec<String>,
    trials: Vec<Vec<(usize, Entry)>>,
}

impl<'a> Stored<'a> {
    fn of(scenario: &'a str, label: &'a str, method: &MethodTable) -> Self {
        let mut names: BTreeMap<(Arc<str>, Arc<str>), usize> = BTreeMap::new();
        let (mut targets, mut trials, mut last) = (Vec::new(), Vec::new(), None);
        for (place, entry) in &method.points {
            if last != Some(place.trial) {
                trials.push(Vec::new());
                last = Some(place.trial);
            }
            let next = targets.len();
            let target = *names.entry((place.view.clone(), place.target.clone())).or_insert(next);
            if target == next {
                targets.push(format!("{}/{}", place.view, place.target));
            }
            if let Some(trial) = trials.last_mut() {
                trial.push((target, *entry));
            }
        }
        Self { scenario, label, targets, trials }
    }

    /// The trials of `order` in pairs: each first one is blessed, each second one is now.
    fn pairs(&self, order: &[usize]) -> Pairs {
        let mut pairs = Pairs { trials: order.len() / 2, targets: self.targets.clone(), items: Vec::new() };
        let mut entries: Vec<Option<Entry>> = vec![None; self.targets.len()];
        for (trial, both) in order.chunks_exact(2).enumerate() {
            entries.fill(None);
            for (target, entry) in &self.trials[both[0]] {
                entries[*target] = Some(*entry);
            }
            for (target, new) in &self.trials[both[1]] {
                if let Some(old) = entries[*target] {
                    pairs.items.push(Item { trial, target: *target, old, new: *new });
                }
            }
        }
        pairs
    }
}

/// Divides the trials of every method of `tables` `divisions` times, all methods of a scenario alike, and decides each division as one check.
///
/// `tables` are of scenarios with random trials and known truth; a method with fewer than two halves of [`LEAST_PAIRS`] is left out and counted.
pub fn alarms(tables: &[&Table], divisions: usize) -> Alarms {
    let all: Vec<Stored<'_>> =
        tables.iter().flat_map(|table| table.methods().map(|(label, method)| Stored::of(&table.scenario, label, method))).collect();
    let (enough, few): (Vec<Stored<'_>>, Vec<Stored<'_>>) = all.into_iter().partition(|stored| stored.trials.len() >= 2 * LEAST_PAIRS);
    let divided: Vec<Division> = (0..divisions).into_par_iter().map(|number| one(&enough, number as u64)).collect();
    Alarms {
        divisions,
        failed: divided.iter().filter(|division| division.failed).count(),
        lacking: divided.iter().filter(|division| division.lacking).count(),
        methods: enough.len(),
        tests: divided.first().map_or(0, |division| division.tests),
        too_few: few.len(),
    }
}

/// What a check makes of one division.
struct Division {
    failed: bool,
    lacking: bool,
    tests: usize,
}

fn one(stored: &[Stored<'_>], number: u64) -> Division {
    let (mut tests, mut lacking): (Vec<Test>, bool) = (Vec::new(), false);
    for method in stored {
        let mut order: Vec<usize> = (0..method.trials.len()).collect();
        let key = Key { seed: 0, scenario: method.scenario, trial: number, view: "", target: "" };
        order.shuffle(&mut stream(key, Purpose::Split));
        let (found, missing) = judge::tests(method.scenario, method.label, &method.pairs(&order));
        tests.extend(found);
        lacking |= !missing.is_empty();
    }
    let worse = |family| decide(tests.iter().filter(|test| test.family == family).collect()).iter().any(Finding::fails);
    Division { failed: Family::ALL.into_iter().any(worse), lacking, tests: tests.len() }
}
