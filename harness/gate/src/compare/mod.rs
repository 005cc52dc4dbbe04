//! A run beside its baseline: what is missing, what changed, and whether what changed is worse.

use super::changed::{Changes, distance};
use super::few::few;
use super::finding::{Finding, Verdict};
use super::judge::{self, Test};
use super::missing;
use super::pairs::Pairs;
use super::point_by_point::{exact, status, worse_status};
use super::point_entry::Coordinates;
use super::table::{MethodTable, Table, is_foreign};
use super::{LEAST_PAIRS, TOLERANCE};

/// By how much, px, the points of a library's other version may move, as a root mean square, where no truth can judge them.
pub const OTHER_VERSION: f64 = 0.05;

/// What a comparison found, and the tests that are still to be decided.
#[derive(Default)]
pub(super) struct Compared {
    pub findings: Vec<Finding>,
    pub tests: Vec<Test>,
    /// How many methods of both have the same numbers, and how many do not.
    pub methods: [usize; 2],
}

/// Compares the points of a run with those of its baseline. `deterministic` is true of a scenario in which nothing is random.
pub(super) fn compare(baseline: &Table, current: &Table, deterministic: bool) -> Compared {
    let mut all = Compared { findings: missing::completeness(baseline, current), ..Compared::default() };
    let name = baseline.scenario.as_str();
    if baseline.coordinates != current.coordinates {
        let message = "the baseline has errors and the run positions, or the other way round: bless anew";
        all.findings.push(Finding::new(Verdict::Fails, name, "", "coordinates", message));
        return all;
    }
    if baseline.seed != current.seed && !deterministic && baseline.coordinates == Coordinates::Errors {
        let (now, was) = (current.seed, baseline.seed);
        let message = format!("the seed is {now} and was {was}: the trials no longer share their random numbers; bless anew");
        all.findings.push(Finding::new(Verdict::Fails, name, "all methods", "seed", message));
    }
    for (label, base) in baseline.methods() {
        let Some(now) = current.method(label).filter(|now| now.unavailable.is_none()) else { continue };
        let changes = Changes::of(base, now);
        all.methods[usize::from(!changes.is_empty())] += 1;
        if !changes.is_empty() {
            all.method(baseline, label, [base, now], &changes, deterministic);
        }
    }
    all.text(baseline, current);
    all
}

impl Compared {
    fn method(&mut self, table: &Table, label: &str, [base, now]: [&MethodTable; 2], changes: &Changes<'_>, deterministic: bool) {
        let name = table.scenario.as_str();
        let single = deterministic || table.coordinates == Coordinates::Positions;
        let foreign = is_foreign(&base.library, &now.library);
        self.findings.extend(lost_sigmas(name, label, changes));
        if single && !foreign {
            self.findings.extend(exact(table, label, [base, now], changes));
            self.findings.extend(sigmas(table, label, changes));
            return;
        }
        self.findings.extend(named(name, label, changes, foreign));
        if table.coordinates == Coordinates::Positions {
            self.findings.extend(other_version(name, label, changes, base.points.len()));
            return;
        }
        let pairs = Pairs::of(base, now, single);
        if pairs.trials < LEAST_PAIRS {
            self.findings.extend(few(name, label, &pairs));
            return;
        }
        let (mut tests, lacking) = judge::tests(name, label, &pairs);
        if foreign {
            tests.iter_mut().for_each(|test| test.finding.verdict = Verdict::Informs);
        }
        self.tests.extend(tests);
        self.findings.extend(lacking);
    }

    /// The scenario's text: with other numbers it makes the comparison one of unlike things.
    fn text(&mut self, baseline: &Table, current: &Table) {
        if baseline.text.is_empty() || current.text.is_empty() || baseline.text == current.text {
            return;
        }
        let new = |verdict, message: &str| Finding::new(verdict, &baseline.scenario, "all methods", "scenario", message);
        self.findings.push(if self.methods[1] > 0 {
            new(Verdict::Fails, "the scenario was edited since it was blessed, and its numbers are others: look, then bless")
        } else {
            new(Verdict::Changed, "the scenario's text was edited since it was blessed; the numbers are the same: bless")
        });
    }
}

/// What changed, in sum, and by name every point that was measured and is not any more. A library's other version only informs.
fn named(scenario: &str, label: &str, changes: &Changes<'_>, foreign: bool) -> Vec<Finding> {
    let changed = if foreign { Verdict::Informs } else { Verdict::Changed };
    let new = |verdict, metric, message: String| Finding::new(verdict, scenario, label, metric, message);
    let mut findings = Vec::new();
    for pair in changes.statuses.iter().filter(|pair| worse_status(pair)) {
        let verdict = if pair.2.is_nan() { Verdict::Fails } else { changed };
        findings.push(new(verdict, "status", status(pair)).at(pair.0.to_string()));
    }
    let others = changes.statuses.iter().filter(|pair| !worse_status(pair)).count();
    if others > 0 {
        findings.push(new(changed, "status", format!("{others} points are measured that were not, or fail for another reason")));
    }
    if let Some(first) = changes.moved.first() {
        let (count, far) = (changes.moved.len(), changes.farthest());
        findings.push(new(changed, "position", format!("{count} points moved, by up to {far:.6} px; the first is {}", first.0)));
    }
    findings.extend(changed_sigmas(scenario, label, changes, changed));
    findings
}

fn changed_sigmas(scenario: &str, label: &str, changes: &Changes<'_>, verdict: Verdict) -> Option<Finding> {
    let first = changes.sigmas.first()?;
    let message = format!("the reported standard deviation of {} points is another; the first is {}", changes.sigmas.len(), first.0);
    Some(Finding::new(verdict, scenario, label, "sigma", message))
}

/// Points whose standard deviation was reported and is not any more, or is not a number.
fn lost_sigmas(scenario: &str, label: &str, changes: &Changes<'_>) -> Option<Finding> {
    let sigma = |entry: &super::Entry| entry.found().and_then(|found| found.sigma).filter(|sigma| sigma.is_finite());
    let lost: Vec<_> = changes.sigmas.iter().filter(|(_, old, new)| sigma(old).is_some() && sigma(new).is_none()).collect();
    let message = format!("{} points have lost their reported standard deviation; the first is {}", lost.len(), lost.first()?.0);
    Some(Finding::new(Verdict::Fails, scenario, label, "sigma", message))
}

/// Where nothing is random, or nothing is true: standard deviations judged by themselves. Without truth, and where errors no longer fit them, they fail.
fn sigmas(table: &Table, label: &str, changes: &Changes<'_>) -> Option<Finding> {
    let both: Vec<[[f64; 2]; 2]> = changes.sigmas.iter().filter_map(|(_, old, new)| Some([fit(old)?, fit(new)?])).collect();
    let ratio = |which: usize| {
        let sum = both.iter().fold([0.0; 2], |sum, pair| [sum[0] + pair[which][0], sum[1] + pair[which][1]]);
        (sum[0] / sum[1]).sqrt()
    };
    let (old, new) = (ratio(0), ratio(1));
    let judged = table.coordinates == Coordinates::Errors && (new - old).is_finite() && old > 0.0 && new > 0.0;
    let worse = !judged || new.ln().abs() > old.ln().abs() + TOLERANCE;
    let finding = changed_sigmas(&table.scenario, label, changes, if worse { Verdict::Fails } else { Verdict::Changed })?;
    Some(if judged { finding.figures(old, new) } else { finding })
}

/// Squared error and reported variance of a point, px^2.
fn fit(entry: &super::Entry) -> Option<[f64; 2]> {
    let [dx, dy] = entry.coordinates()?;
    let sigma = entry.found()?.sigma?;
    Some([dx * dx + dy * dy, sigma * sigma])
}

/// A library's other version on photographs: how far its points moved from those of the blessed one.
fn other_version(scenario: &str, label: &str, changes: &Changes<'_>, points: usize) -> Vec<Finding> {
    let square: f64 = changes.moved.iter().map(|pair| distance(pair).powi(2)).sum();
    let rms = (square / points.max(1) as f64).sqrt();
    let gone = changes.statuses.iter().filter(|pair| worse_status(pair)).count();
    let mut findings = Vec::new();
    if rms > OTHER_VERSION {
        let message = format!("another version of the library: its points moved by more than {OTHER_VERSION} px, as a root mean square");
        findings.push(Finding::new(Verdict::Fails, scenario, label, "position", message).figures(0.0, rms));
    }
    if gone as f64 > 0.01 * points as f64 {
        let message = "another version of the library: more than 1 % of its points are measured no more";
        findings.push(Finding::new(Verdict::Fails, scenario, label, "measured", message).figures(points as f64, (points - gone) as f64));
    }
    findings
}

#[cfg(test)]
mod tests;
