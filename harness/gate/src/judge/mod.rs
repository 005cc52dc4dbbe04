//! What changed, judged: better, worse or alike. Tests on the differences, trial by trial, between a run and its baseline.

use calibench_records::statistics::paired::{PValues, mean, paired_t};

use super::counts::Flips;
use super::finding::{Finding, Verdict};
use super::pairs::Pairs;
use super::point_entry::Entry;
use super::{BOUND, LEAST_PAIRS, TOLERANCE};

/// Tests that share one part of the error budget.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Family {
    /// Lost and rejected points.
    Counts,
    /// Mean errors.
    Means,
    /// Mean squares, and scatter about the mean of each target.
    Spread,
    /// Errors in units of the standard deviation that the method reports.
    Sigmas,
}

impl Family {
    /// All of them, each with the same share.
    pub const ALL: [Self; 4] = [Self::Counts, Self::Means, Self::Spread, Self::Sigmas];
}

/// One comparison whose p-values await those of all others.
#[derive(Clone)]
pub(super) struct Test {
    /// Which part of the budget it shares.
    pub family: Family,
    /// What it is about, with both figures, and what to say when it is better.
    pub finding: Finding,
    /// The chance (0 to 1) of what was seen, or more, if nothing became worse; 1 when nothing did by more than [`TOLERANCE`].
    pub worse: f64,
    /// The same for better.
    pub better: f64,
}

/// The same coordinate or figure, blessed and now.
type Figures = (f64, f64);

/// The tests of one method, and the tests that its baseline allows and this run does not.
pub(super) fn tests(scenario: &str, label: &str, pairs: &Pairs) -> (Vec<Test>, Vec<Finding>) {
    let subject = |metric| Finding::new(Verdict::Changed, scenario, label, metric, "better, not blessed");
    let mut all = Collected { tests: Vec::new(), lacking: Vec::new() };
    all.counts(&subject, pairs);
    let errors = Errors::of(pairs);
    all.means_by_target(&subject, pairs, &errors);
    all.by_trial(&subject, pairs, &errors);
    all.sigmas(&subject, pairs);
    (all.tests, all.lacking)
}

/// The errors of a run by target: (trial, dx, dy) of both runs where both found the point.
struct Errors {
    by_target: Vec<Vec<(usize, [Figures; 2])>>,
    /// How many points of each target the baseline found.
    blessed: Vec<usize>,
}

impl Errors {
    fn of(pairs: &Pairs) -> Self {
        let targets = pairs.targets.len();
        let mut errors = Self { by_target: vec![Vec::new(); targets], blessed: vec![0; targets] };
        for item in &pairs.items {
            let Some(a) = bounded(&item.old) else { continue };
            errors.blessed[item.target] += 1;
            if let Some(b) = bounded(&item.new) {
                errors.by_target[item.target].push((item.trial, [(a[0], b[0]), (a[1], b[1])]));
            }
        }
        errors
    }
}

struct Collected {
    tests: Vec<Test>,
    lacking: Vec<Finding>,
}

const MEANS: [&str; 2] = ["mean_dx", "mean_dy"];

impl Collected {
    /// Lost and rejected points.
    fn counts(&mut self, subject: &dyn Fn(&'static str) -> Finding, pairs: &Pairs) {
        for metric in ["lost", "rejected"] {
            let flips = Flips::of(pairs, |entry| entry.status() == metric);
            let (p, [old, new]) = (flips.test(), flips.counts);
            let finding = subject(metric).figures(old as f64, new as f64);
            self.tests.push(Test { family: Family::Counts, finding, worse: p.growth, better: p.fall });
        }
    }

    /// Mean dx and dy of each target, over the trials in which both runs found it.
    fn means_by_target(&mut self, subject: &dyn Fn(&'static str) -> Finding, pairs: &Pairs, errors: &Errors) {
        for (target, values) in errors.by_target.iter().enumerate() {
            let name = &pairs.targets[target];
            if values.len() < LEAST_PAIRS {
                if errors.blessed[target] >= LEAST_PAIRS {
                    let (old, new) = (errors.blessed[target], values.len());
                    let message = format!("no longer tested: the baseline found the point in {old} trials, this run in {new} of them");
                    let finding = Finding { verdict: Verdict::Fails, message, ..subject("tests").at(name.as_str()) };
                    self.lacking.push(finding.figures(old as f64, new as f64));
                }
                continue;
            }
            for (axis, metric) in MEANS.into_iter().enumerate() {
                let values: Vec<Figures> = values.iter().map(|(_, both)| both[axis]).collect();
                self.mean(subject(metric).at(name.as_str()), &values);
            }
        }
    }

    /// Of each trial: mean dx and dy over all its targets, the mean square, and the scatter about the mean of each target.
    fn by_trial(&mut self, subject: &dyn Fn(&'static str) -> Finding, pairs: &Pairs, errors: &Errors) {
        let mut sums = vec![([(0.0, 0.0); 4], 0_usize); pairs.trials];
        for values in &errors.by_target {
            let of = |axis: usize, which: fn(&Figures) -> f64| mean(&values.iter().map(|(_, both)| which(&both[axis])).collect::<Vec<_>>());
            if values.is_empty() {
                continue;
            }
            let (old, new) = ([of(0, |v| v.0), of(1, |v| v.0)], [of(0, |v| v.1), of(1, |v| v.1)]);
            for (trial, [dx, dy]) in values {
                let (sum, count) = &mut sums[*trial];
                let square = |x: f64, y: f64| x * x + y * y;
                let spread = (square(dx.0 - old[0], dy.0 - old[1]), square(dx.1 - new[0], dy.1 - new[1]));
                for (sum, value) in sum.iter_mut().zip([*dx, *dy, (square(dx.0, dy.0), square(dx.1, dy.1)), spread]) {
                    *sum = (sum.0 + value.0, sum.1 + value.1);
                }
                *count += 1;
            }
        }
        let trials: Vec<_> = sums.into_iter().filter(|(_, count)| *count > 0).collect();
        let column = |which: usize| trials.iter().map(|(sum, n)| (sum[which].0 / *n as f64, sum[which].1 / *n as f64)).collect::<Vec<_>>();
        for (axis, metric) in MEANS.into_iter().enumerate() {
            self.mean(subject(metric), &column(axis));
        }
        self.mean_square(subject("rms_error"), &column(2));
        self.mean_square(subject("scatter"), &column(3));
    }

    /// Squared errors over the variances that the method reports: 1 in the mean if these are right.
    fn sigmas(&mut self, subject: &dyn Fn(&'static str) -> Finding, pairs: &Pairs) {
        let mut sums = vec![((0.0, 0.0), 0_usize); pairs.trials];
        for item in &pairs.items {
            let (Some(a), Some(b)) = (normalised(&item.old), normalised(&item.new)) else { continue };
            let (sum, count) = &mut sums[item.trial];
            *sum = (sum.0 + a, sum.1 + b);
            *count += 1;
        }
        let values: Vec<Figures> =
            sums.iter().filter(|(_, count)| *count > 0).map(|(sum, n)| (sum.0 / *n as f64, sum.1 / *n as f64)).collect();
        let Some((old, new, p)) = test(&values) else { return };
        let off = |square: f64| square.max(f64::MIN_POSITIVE).ln().abs();
        let (changed, worse) = ((new - old).abs() > TOLERANCE, off(new) > off(old));
        let finding = subject("error_over_sigma").figures(old.sqrt(), new.sqrt());
        let p_if = |holds: bool| if holds { p.two_sided } else { 1.0 };
        self.tests.push(Test { family: Family::Sigmas, finding, worse: p_if(changed && worse), better: p_if(changed && !worse) });
    }

    fn mean(&mut self, finding: Finding, values: &[Figures]) {
        let Some((old, new, p)) = test(values) else { return };
        let changed = (new - old).abs() > TOLERANCE;
        let worse = changed && new.abs() - old.abs() > TOLERANCE;
        let p_if = |holds: bool| if holds { p.two_sided } else { 1.0 };
        let message = if old.abs() - new.abs() > TOLERANCE { "better, not blessed" } else { "as far off, elsewhere; not blessed" };
        let finding = Finding { message: message.into(), ..finding.figures(old, new) };
        self.tests.push(Test { family: Family::Means, finding, worse: p_if(worse), better: p_if(changed && !worse) });
    }

    fn mean_square(&mut self, finding: Finding, values: &[Figures]) {
        let Some((old, new, p)) = test(values) else { return };
        let (old, new) = (old.sqrt(), new.sqrt());
        let worse = if new - old > TOLERANCE { p.growth } else { 1.0 };
        let better = if old - new > TOLERANCE { p.fall } else { 1.0 };
        self.tests.push(Test { family: Family::Spread, finding: finding.figures(old, new), worse, better });
    }
}

/// Both means and the p-values of their difference, unless there are too few pairs.
fn test(values: &[Figures]) -> Option<(f64, f64, PValues)> {
    if values.len() < LEAST_PAIRS {
        return None;
    }
    let differences: Vec<f64> = values.iter().map(|(old, new)| new - old).collect();
    let of = |which: fn(&Figures) -> f64| mean(&values.iter().map(which).collect::<Vec<f64>>());
    Some((of(|v| v.0), of(|v| v.1), paired_t(&differences)))
}

/// The error of a point that was found, lost or not, each coordinate within [`BOUND`].
///
/// Points beyond [`LOST`](calibench_records::results::LOST) are not dropped: a shift takes points over that border, and without them it would
/// look smaller than it is, or, where all are lost, not be seen at all. The bound keeps one wild point from hiding the others.
pub(super) fn bounded(entry: &Entry) -> Option<[f64; 2]> {
    let within = |value: f64| if value.is_nan() { BOUND } else { value.clamp(-BOUND, BOUND) };
    entry.coordinates().map(|at| at.map(within))
}

/// The squared error of a point that was measured and not lost, over the variance that the method reports; at most 100 = ten standard deviations.
fn normalised(entry: &Entry) -> Option<f64> {
    let [dx, dy] = entry.kept()?;
    let sigma = entry.found()?.sigma.filter(|sigma| *sigma > 0.0)?;
    Some(((dx * dx + dy * dy) / (sigma * sigma)).min(100.0))
}

#[cfg(test)]
mod tests;
