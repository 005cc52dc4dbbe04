//! The accuracy gate: the numbers of a run against those that were blessed.
//!
//! With the same seed the numbers are the same, so they are compared, point by point. Only what changed is judged: where nothing is random,
//! or no truth is known, point by point; elsewhere by tests on the paired differences of the same trials, under one error budget for a check. Sweeps
//! and adjustments are kept as digests and sums and judged by these. Ceilings, written by hand, stand beside all of it.

mod accepted_worse;
mod adjusted;
mod baseline;
mod baseline_file;
mod baselines;
mod blessing;
mod ceilings;
mod cells;
mod changed;
mod compare;
mod counts;
mod few;
mod figures;
mod finding;
mod index;
mod judge;
mod junit;
mod limits;
mod lock;
mod missing;
mod moments;
mod pairs;
mod point_by_point;
mod point_entry;
pub mod power;
mod recorded;
mod render;
mod sums;
mod sums_judged;
mod table;
mod verdicts;

/// The example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

#[cfg(test)]
mod tests;

pub use accepted_worse::worse_than;
pub use adjusted::{FigureKey, Numbers};
pub use baseline::{baseline_path, figures_path, images_path, read_baseline, write_baseline};
pub use baseline_file::{BaselineError, Kind, machine};
pub use baselines::{Baselines, Measured, Results};
pub use blessing::{BlessError, Change};
pub use ceilings::{CEILINGS, Ceiling, CeilingError, CeilingMetric, Ceilings};
pub use cells::{Cells, Kept};
pub use compare::OTHER_VERSION;
pub use few::FEW_GROWTH;
pub use figures::{FIGURE_GROWTH, FigureSums};
pub use finding::{Finding, Rules, Verdict};
pub use index::{INDEX, Index, IndexError};
pub use junit::junit;
pub use limits::{ALPHA, BOUND, LEAST_PAIRS, TOLERANCE};
pub use lock::{Access, Lock};
pub use moments::PointSums;
pub use point_entry::{Coordinates, DECIMALS, Entry, Found, Place};
pub use recorded::recorded;
pub use render::{Tally, json, not_tested, render};
pub use sums::ImageSums;
pub use sums_judged::{CELL_GROWTH, FAILURES, SIGMA_DRIFT, TARGET_GROWTH};
pub use table::{MethodTable, Table, fingerprint, library};
pub use verdicts::Verdicts;

use calibench_records::statistics::holm;
use judge::{Family, Test};

/// One check: scenarios are added, then all is decided together.
#[derive(Default)]
pub struct Check {
    findings: Vec<Finding>,
    tests: Vec<Test>,
    tally: Tally,
}

impl Check {
    /// Nothing compared yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Compares a run with its baseline. `deterministic` is true of a scenario in which nothing is random;
    /// photographs, whose truth is unknown, are compared exactly in any case.
    pub fn compare(&mut self, baseline: &Table, current: &Table, deterministic: bool) {
        let found = compare::compare(baseline, current, deterministic);
        let [same, changed] = found.methods;
        self.tally.scenarios += 1;
        self.tally.methods += same + changed;
        self.tally.changed += changed;
        self.tally.points += baseline.points();
        self.findings.extend(found.findings);
        self.tests.extend(found.tests);
    }

    /// Notes a run that has no baseline.
    pub fn unblessed(&mut self, current: &Table) {
        let empty = Table::new(current.scenario.as_str(), current.seed, current.coordinates, &[]);
        self.findings.extend(missing::completeness(&empty, current));
    }

    /// Compares the sums of a run with those that were blessed, cell by cell.
    pub fn compare_cells<T: Kept>(&mut self, baseline: &Cells<T>, current: &Cells<T>) {
        let [methods, count] = baseline.counts();
        match T::KIND {
            Kind::Figures => self.tally.figures += count,
            Kind::Images => self.tally.points += count,
            Kind::Points | Kind::Sums | Kind::Verdicts => {
                self.tally.scenarios += baseline.len();
                self.tally.methods += methods;
                self.tally.points += count;
            }
        }
        self.findings.extend(baseline.compare(current));
    }

    /// Compares the verdicts of published cells.
    pub fn verdicts(&mut self, baseline: &Verdicts, current: &Verdicts) {
        self.tally.cells += baseline.0.len();
        self.findings.extend(baseline.compare(current));
    }

    /// Notes what the caller found.
    pub fn note(&mut self, finding: Finding) {
        self.findings.push(finding);
    }

    /// Holds the runs against the ceilings.
    pub fn ceilings(&mut self, ceilings: &Ceilings, runs: &[&Table]) {
        self.tally.ceilings += ceilings.list.len();
        self.findings.extend(ceilings.check(runs));
    }

    /// How many tests share the error budget so far.
    pub fn tests(&self) -> usize {
        self.tests.len()
    }

    /// What was compared so far.
    pub fn tally(&self) -> Tally {
        self.tally
    }

    /// Decides all tests together and returns what was found: first what fails, each part sorted.
    pub fn conclude(self) -> Vec<Finding> {
        let mut findings = self.findings;
        for family in Family::ALL {
            findings.extend(decide(self.tests.iter().filter(|test| test.family == family).collect()));
        }
        findings.sort_by(Finding::order);
        findings
    }
}

/// What the tests of one family say under its share of [`ALPHA`].
fn decide(tests: Vec<&Test>) -> Vec<Finding> {
    let share = ALPHA / Family::ALL.len() as f64;
    let column = |of: fn(&Test) -> f64| tests.iter().map(|test| of(test)).collect::<Vec<f64>>();
    let (worse, better) = (holm(&column(|test| test.worse)), holm(&column(|test| test.better)));
    let mut findings = Vec::new();
    for (test, (worse, better)) in tests.into_iter().zip(worse.into_iter().zip(better)) {
        let finding = test.finding.clone();
        if worse <= share {
            findings.push(Finding { verdict: Verdict::Fails, p: Some(worse), message: "worse".into(), ..finding });
        } else if better <= share {
            findings.push(Finding { p: Some(better), ..finding });
        }
    }
    findings
}

/// Compares one run with its baseline, as a check of its own.
pub fn compare(baseline: &Table, current: &Table, deterministic: bool) -> Vec<Finding> {
    let mut check = Check::new();
    check.compare(baseline, current, deterministic);
    check.conclude()
}
