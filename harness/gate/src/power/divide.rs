//! False alarms: the stored trials of a run divided at random into a baseline and a run that are alike.

use std::collections::BTreeMap;
use std::sync::Arc;

use calibench_random::{Key, Purpose, stream};
use rand::seq::SliceRandom;
use rayon::prelude::*;

use crate::finding::Finding;
use crate::judge::{self, Family, Test};
use crate::pairs::{Item, Pairs};
use crate::point_entry::Entry;
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
        let key = Key { seed: 0, of: method.scenario, trial: number, view: "", target: "" };
        order.shuffle(&mut stream(key, Purpose::Split));
        let (found, missing) = judge::tests(method.scenario, method.label, &method.pairs(&order));
        tests.extend(found);
        lacking |= !missing.is_empty();
    }
    let worse = |family| decide(tests.iter().filter(|test| test.family == family).collect()).iter().any(Finding::fails);
    Division { failed: Family::ALL.into_iter().any(worse), lacking, tests: tests.len() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Coordinates;
    use crate::tests::{NO_CORNER, holding, measured, method};

    /// `trials` trials of two targets, of which the second is found in the first `found` of them.
    fn points(trials: u64, found: u64) -> MethodTable {
        let error = |trial: u64, axis: f64| 0.1 * (1.7 * trial as f64 + axis).sin();
        let entry = move |trial: u64, axis: f64| measured([error(trial, axis), error(trial, axis + 1.0)], None);
        let both = (0..trials).flat_map(move |trial| [(trial, "a", entry(trial, 0.0)), (trial, "b", entry(trial, 2.0))]);
        method(both.map(move |(trial, name, entry)| (trial, name, if name == "b" && trial >= found { NO_CORNER } else { entry })))
    }

    #[test]
    fn trials_are_stored_in_their_order() {
        let [x, y, z] = [0.1, 0.2, 0.3].map(|dx| measured([dx, 0.0], None));
        let table = method([(3, "b", x), (3, "c", y), (8, "a", z), (8, "b", x)]);
        let stored = Stored::of("f/s", "m", &table);
        assert_eq!(stored.targets, ["image/b", "image/c", "image/a"]);
        assert_eq!(stored.trials, [vec![(0, x), (1, y)], vec![(2, z), (0, x)]]);
    }

    #[test]
    fn trials_are_paired_in_turn() {
        let entry = |trial: u64| measured([0.1 * trial as f64, 0.0], None);
        // Target b is missing in trial 1.
        let all = (0..5).flat_map(|trial| [(trial, "a", entry(trial)), (trial, "b", entry(trial))]);
        let table = method(all.filter(|(trial, name, _)| (*trial, *name) != (1, "b")));
        let pairs = Stored::of("f/s", "m", &table).pairs(&[2, 0, 1, 4, 3]);
        let items: Vec<_> = pairs.items.iter().map(|item| (item.trial, item.target, item.old, item.new)).collect();
        let expected = [(0, 0, entry(2), entry(0)), (0, 1, entry(2), entry(0)), (1, 0, entry(1), entry(4))];
        assert_eq!((pairs.trials, items), (2, expected.to_vec()), "the fifth trial has no partner");
    }

    #[test]
    fn divisions_are_counted_with_their_methods_and_tests() {
        let mut first = holding(Coordinates::Errors, points(20, 20));
        *first.method_mut(&"n".into(), &"1".into()) = points(19, 19);
        let second = holding(Coordinates::Errors, points(40, 40));
        // Lost, rejected, two means of each target and of all, root mean square, scatter: ten tests, twice.
        let expected = Alarms { divisions: 5, failed: 0, lacking: 0, methods: 2, tests: 20, too_few: 1 };
        assert_eq!(alarms(&[&first, &second], 5), expected);
        assert_eq!(alarms(&[], 3), Alarms { divisions: 3, ..Alarms::default() });
    }

    #[test]
    fn a_target_that_is_seldom_found_is_lacking() {
        // Of 40 trials 28: about 14 of 20 pairs have a first one, about 10 have both.
        let with = |found| alarms(&[&holding(Coordinates::Errors, points(40, found))], 40).lacking;
        let some = with(28);
        assert!((1..40).contains(&some), "{some}");
        assert_eq!([with(40), with(9)], [0, 0], "always and never tested");
    }

    #[test]
    fn divisions_differ_and_are_the_same_again() {
        let stored = points(40, 28);
        let of = |number| {
            let division = one(&[Stored::of("f/s", "m", &stored)], number);
            (division.failed, division.lacking, division.tests)
        };
        let all: Vec<_> = (0..40).map(of).collect();
        assert!(all.iter().eq((0..40).map(of).collect::<Vec<_>>().iter()));
        let lacking = all.iter().filter(|(_, lacking, _)| *lacking).count();
        assert_eq!(lacking, alarms(&[&holding(Coordinates::Errors, stored.clone())], 40).lacking);
        // The two tests of target b are there or are lacking, unless the baseline itself has too few.
        assert!(all.iter().all(|(failed, lacking, tests)| !failed && (*tests == 8 || (*tests == 10 && !lacking))));
    }
}
