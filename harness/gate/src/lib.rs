//! The accuracy gate: is a run still as good as the numbers that were blessed?
//!
//! A deterministic scenario is compared coordinate by coordinate. A Monte Carlo scenario is compared by paired differences of the
//! same trials, under one error budget for all tests of all scenarios of a check. Ceilings, written by hand, stand beside both.

mod adjusted;
mod baseline;
mod ceilings;
mod exact;
mod finding;
mod missing;
mod paired;
mod render;
mod table;
mod worse;

#[cfg(test)]
mod tests;

pub use baseline::{BaselineError, baseline_path, read_baseline, write_baseline};
pub use ceilings::{Ceiling, CeilingError, CeilingMetric, Ceilings};
pub use finding::{Finding, Verdict};
pub use render::render;
pub use table::{Coordinates, DECIMALS, Entry, MethodTable, Place, Table};
pub use worse::worse_than;

use calibench_records::statistics::holm;

/// The family-wise error rate of a check: the chance that it fails although nothing became worse, over all its tests together.
///
/// At most one of a hundred runs may be a false alarm. A rate of 0.01 would hold that in expectation only, and break it every
/// fourth time; at 0.001 the expectation is 0.1, and two or more false alarms in a hundred have a chance below 0.01.
pub const ALPHA: f64 = 0.001;

/// What is no change at all, px: last bits that differ between machines. Also the tolerance of deterministic scenarios.
pub const TOLERANCE: f64 = 1e-6;

/// Fewer pairs than this are not put to a t-test: a handful of like differences would look certain.
pub const LEAST_PAIRS: usize = 10;

/// Errors count in means and mean squares as no more than this in each coordinate, px: what is further off is simply elsewhere.
pub const BOUND: f64 = 3.0;

/// One check: scenarios are added, then all is decided together.
#[derive(Default)]
pub struct Check {
    findings: Vec<Finding>,
    tests: Vec<paired::Test>,
}

impl Check {
    /// Nothing compared yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Compares a run with its baseline. `deterministic` is true of a scenario in which nothing is random;
    /// photographs, whose truth is unknown, are compared exactly in any case.
    pub fn compare(&mut self, baseline: &Table, current: &Table, deterministic: bool) {
        self.findings.extend(missing::completeness(baseline, current));
        if baseline.coordinates != current.coordinates {
            let message = "the baseline has errors and the run positions, or the other way round: bless anew";
            self.findings.push(Finding::new(Verdict::Fails, &baseline.scenario, "", "coordinates", message));
        } else if deterministic || baseline.coordinates == Coordinates::Positions {
            self.findings.extend(exact::exact(baseline, current));
        } else {
            if baseline.seed != current.seed {
                let message = format!(
                    "the seed is {} and was {}: the trials no longer share their random numbers; bless anew",
                    current.seed, baseline.seed
                );
                self.findings.push(Finding::new(Verdict::Fails, &baseline.scenario, "all methods", "seed", message));
            }
            let (tests, untested) = paired::tests(baseline, current);
            self.tests.extend(tests);
            self.findings.extend(untested);
        }
    }

    /// Notes a run that has no baseline.
    pub fn unblessed(&mut self, current: &Table) {
        let empty = Table::new(current.scenario.as_str(), current.seed, current.coordinates, &[]);
        self.findings.extend(missing::completeness(&empty, current));
    }

    /// Holds the runs against the ceilings.
    pub fn ceilings(&mut self, ceilings: &Ceilings, runs: &[&Table]) {
        self.findings.extend(ceilings.check(runs));
    }

    /// How many tests share the error budget so far.
    pub fn tests(&self) -> usize {
        self.tests.len()
    }

    /// Decides all tests together and returns what was found: first what fails, each part sorted.
    pub fn conclude(self) -> Vec<Finding> {
        let mut findings = self.findings;
        let column = |of: fn(&paired::Test) -> f64| self.tests.iter().map(of).collect::<Vec<f64>>();
        let (worse, better) = (holm(&column(|test| test.worse)), holm(&column(|test| test.better)));
        for (test, (worse, better)) in self.tests.into_iter().zip(worse.into_iter().zip(better)) {
            if worse <= ALPHA {
                findings.push(Finding { verdict: Verdict::Fails, p: Some(worse), message: "worse".into(), ..test.finding });
            } else if better <= ALPHA {
                findings.push(Finding { p: Some(better), ..test.finding });
            }
        }
        findings.sort_by(Finding::order);
        findings
    }
}

/// Compares one run with its baseline, as a check of its own.
pub fn compare(baseline: &Table, current: &Table, deterministic: bool) -> Vec<Finding> {
    let mut check = Check::new();
    check.compare(baseline, current, deterministic);
    check.conclude()
}
