//! Monte Carlo scenarios: tests on the differences, trial by trial, between a run and its baseline.

use std::collections::BTreeMap;

use calibench_records::statistics::paired::{PValues, mean, paired_t, sign_test};

use super::finding::{Finding, Verdict};
use super::table::{Entry, MethodTable, Place, Table};
use super::{BOUND, LEAST_PAIRS, TOLERANCE};

/// One comparison whose p-values await those of all others.
pub(super) struct Test {
    /// What it is about, with both figures, and what to say when it is better.
    pub finding: Finding,
    /// The chance of what was seen, or more, if nothing became worse; 1 when nothing did by more than [`TOLERANCE`].
    pub worse: f64,
    /// The same for better.
    pub better: f64,
}

/// A point of both runs.
type Pair<'a> = (&'a Place, &'a Entry, &'a Entry);
/// The same coordinate or figure, blessed and now.
type Figures = (f64, f64);

/// The tests of all methods that both tables have, and what could not be tested.
pub(super) fn tests(baseline: &Table, current: &Table) -> (Vec<Test>, Vec<Finding>) {
    let mut all = Collected { tests: Vec::new(), untested: Vec::new() };
    for (label, base) in baseline.methods() {
        let Some(now) = current.method(label).filter(|now| now.unavailable.is_none()) else { continue };
        let subject = |metric| Finding::new(Verdict::Informs, &baseline.scenario, label, metric, "better, not blessed");
        let pairs = pairs(base, now);
        all.means_by_target(&subject, &pairs);
        all.figures_by_trial(&subject, &pairs);
        all.counts_by_trial(&subject, &pairs);
    }
    (all.tests, all.untested)
}

fn pairs<'a>(base: &'a MethodTable, now: &'a MethodTable) -> Vec<Pair<'a>> {
    base.points.iter().filter_map(|(place, old)| Some((place, old, now.points.get(place)?))).collect()
}

struct Collected {
    tests: Vec<Test>,
    untested: Vec<Finding>,
}

impl Collected {
    /// Mean dx and dy of each target, over the trials in which both runs found it.
    fn means_by_target(&mut self, subject: &dyn Fn(&'static str) -> Finding, pairs: &[Pair<'_>]) {
        let mut targets: BTreeMap<_, Vec<[Figures; 2]>> = BTreeMap::new();
        for (place, old, new) in pairs {
            let values = targets.entry((&place.view, &place.target)).or_default();
            if let (Some(a), Some(b)) = (bounded(old), bounded(new)) {
                values.push([(a[0], b[0]), (a[1], b[1])]);
            }
        }
        for ((view, target), values) in targets {
            for (axis, metric) in MEANS.into_iter().enumerate() {
                let values: Vec<Figures> = values.iter().map(|both| both[axis]).collect();
                self.mean(subject(metric).at(format!("{view}/{target}")), &values);
            }
        }
    }

    /// Of each trial: mean dx and dy over all its targets, and the mean squared error.
    fn figures_by_trial(&mut self, subject: &dyn Fn(&'static str) -> Finding, pairs: &[Pair<'_>]) {
        for (axis, metric) in MEANS.into_iter().enumerate() {
            self.mean(subject(metric), &by_trial(pairs, |entry| Some(bounded(entry)?[axis])));
        }
        let squared = by_trial(pairs, |entry| bounded(entry).map(|[dx, dy]| dx * dx + dy * dy));
        self.mean_square(subject("rms_error"), &squared);
    }

    /// Lost and rejected points of each trial.
    fn counts_by_trial(&mut self, subject: &dyn Fn(&'static str) -> Finding, pairs: &[Pair<'_>]) {
        for metric in ["lost", "rejected"] {
            let mut trials: BTreeMap<u64, (u32, u32)> = BTreeMap::new();
            for (place, old, new) in pairs {
                let counts = trials.entry(place.trial).or_default();
                counts.0 += u32::from(old.status() == metric);
                counts.1 += u32::from(new.status() == metric);
            }
            let count = |which: fn(&(u32, u32)) -> bool| trials.values().filter(|counts| which(counts)).count() as u64;
            let p = sign_test(count(|(old, new)| new > old), count(|(old, new)| new < old));
            let sum = |which: fn(&(u32, u32)) -> u32| f64::from(trials.values().map(which).sum::<u32>());
            let finding = subject(metric).figures(sum(|counts| counts.0), sum(|counts| counts.1));
            self.tests.push(Test { finding, worse: p.growth, better: p.fall });
        }
    }

    fn mean(&mut self, finding: Finding, values: &[Figures]) {
        let Some((old, new, p)) = self.test(&finding, values) else { return };
        let changed = (new - old).abs() > TOLERANCE;
        let worse = changed && new.abs() - old.abs() > TOLERANCE;
        let p_if = |holds: bool| if holds { p.two_sided } else { 1.0 };
        let message = if old.abs() - new.abs() > TOLERANCE { "better, not blessed" } else { "as far off, elsewhere; not blessed" };
        let finding = Finding { message: message.into(), ..finding.figures(old, new) };
        self.tests.push(Test { finding, worse: p_if(worse), better: p_if(changed && !worse) });
    }

    fn mean_square(&mut self, finding: Finding, values: &[Figures]) {
        let Some((old, new, p)) = self.test(&finding, values) else { return };
        let (old, new) = (old.sqrt(), new.sqrt());
        let worse = if new - old > TOLERANCE { p.growth } else { 1.0 };
        let better = if old - new > TOLERANCE { p.fall } else { 1.0 };
        self.tests.push(Test { finding: finding.figures(old, new), worse, better });
    }

    /// Both means and the p-values of their difference, unless there are too few pairs.
    fn test(&mut self, finding: &Finding, values: &[Figures]) -> Option<(f64, f64, PValues)> {
        if values.len() < LEAST_PAIRS {
            let message = format!("not tested: {} pairs, at least {LEAST_PAIRS} are needed", values.len());
            self.untested.push(Finding { message, ..finding.clone() });
            return None;
        }
        let differences: Vec<f64> = values.iter().map(|(old, new)| new - old).collect();
        let of = |which: fn(&Figures) -> f64| mean(&values.iter().map(which).collect::<Vec<f64>>());
        Some((of(|v| v.0), of(|v| v.1), paired_t(&differences)))
    }
}

/// The error of a point that was found, lost or not, each coordinate within [`BOUND`].
///
/// Points beyond [`LOST`](calibench_records::results::LOST) are not dropped: a shift takes points over that border, and without them it would
/// look smaller than it is, or, where all are lost, not be seen at all. The bound keeps one wild point from hiding the others.
fn bounded(entry: &Entry) -> Option<[f64; 2]> {
    let within = |value: f64| if value.is_nan() { BOUND } else { value.clamp(-BOUND, BOUND) };
    entry.coordinates().map(|at| at.map(within))
}

const MEANS: [&str; 2] = ["mean_dx", "mean_dy"];

/// The means over each trial's points of a figure that both runs have of a point.
fn by_trial(pairs: &[Pair<'_>], figure: impl Fn(&Entry) -> Option<f64>) -> Vec<Figures> {
    let mut trials: BTreeMap<u64, (f64, f64, f64)> = BTreeMap::new();
    for (place, old, new) in pairs {
        if let (Some(a), Some(b)) = (figure(old), figure(new)) {
            let sums = trials.entry(place.trial).or_default();
            *sums = (sums.0 + a, sums.1 + b, sums.2 + 1.0);
        }
    }
    trials.values().map(|(a, b, n)| (a / n, b / n)).collect()
}
