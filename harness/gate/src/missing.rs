//! Completeness: what was blessed must be there, whatever the figures say.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::finding::{Finding, Verdict};
use super::point_entry::Place;
use super::table::{MethodTable, Table, is_foreign};

/// What the baseline has and the current table lacks fails; what is new is not blessed; another version or other parameters are a change.
pub(super) fn completeness(baseline: &Table, current: &Table) -> Vec<Finding> {
    let mut findings = Vec::new();
    let name = baseline.scenario.as_str();
    for (label, base) in baseline.methods() {
        match current.method(label) {
            None => findings.push(gone(name, label, base, "the method is missing".into())),
            Some(MethodTable { unavailable: Some(why), .. }) => {
                findings.push(gone(name, label, base, format!("the method is unavailable: {why}")));
            }
            Some(now) if now.points.is_empty() && !base.points.is_empty() => {
                findings.push(gone(name, label, base, "the method has no points".into()));
            }
            Some(now) => {
                findings.extend(missing_points(name, label, base, now));
                findings.extend(news(name, label, base, now));
            }
        }
    }
    for (label, now) in current.methods().filter(|(label, _)| baseline.method(label).is_none()) {
        let message = match &now.unavailable {
            Some(why) => format!("not blessed yet, and unavailable: {why}"),
            None => format!("not blessed yet: {} points", now.points.len()),
        };
        findings.push(Finding::new(Verdict::Unblessed, name, label, "points", message));
    }
    findings
}

fn gone(scenario: &str, label: &str, base: &MethodTable, message: String) -> Finding {
    Finding::new(Verdict::Fails, scenario, label, "points", message).figures(base.points.len() as f64, 0.0)
}

fn missing_points(scenario: &str, label: &str, base: &MethodTable, now: &MethodTable) -> Vec<Finding> {
    let mut left: Vec<&Place> = base.points.keys().filter(|place| !now.points.contains_key(place)).collect();
    let (total, found) = (base.points.len(), base.points.len() - left.len());
    let finding = |metric, message| Finding::new(Verdict::Fails, scenario, label, metric, message).figures(total as f64, found as f64);
    let mut findings = Vec::new();
    let (trials, kept_trials) = (trials(base), trials(now));
    let lost_trials: BTreeSet<u64> = trials.difference(&kept_trials).copied().collect();
    if let (Some(first), Some(last)) = (lost_trials.first(), lost_trials.last()) {
        let message = format!("{} of {} trials are missing, from {first} to {last}", lost_trials.len(), trials.len());
        let finding = Finding::new(Verdict::Fails, scenario, label, "trials", message);
        findings.push(finding.figures(trials.len() as f64, (trials.len() - lost_trials.len()) as f64));
        left.retain(|place| !lost_trials.contains(&place.trial));
    }
    let kept_targets: BTreeSet<_> = now.points.keys().map(target).collect();
    let mut lost_targets: BTreeMap<_, usize> = BTreeMap::new();
    left.retain(|place| {
        kept_targets.contains(&target(place)) || {
            *lost_targets.entry(target(place)).or_default() += 1;
            false
        }
    });
    for ((view, name), points) in lost_targets {
        findings.push(finding("points", format!("the target is missing: {points} of {total} points")).at(format!("{view}/{name}")));
    }
    if let Some(first) = left.first() {
        let message = format!("{} of {total} points are missing, the first in trial {}", left.len(), first.trial);
        findings.push(finding("points", message).at(first.to_string()));
    }
    findings
}

fn news(scenario: &str, label: &str, base: &MethodTable, now: &MethodTable) -> Vec<Finding> {
    let mut findings = Vec::new();
    if base.version != now.version {
        let message = format!("the version changed from {} to {}: look, then bless", base.version, now.version);
        // A library's version is the machine's.
        let verdict = if is_foreign(&base.library, &now.library) { Verdict::Informs } else { Verdict::Changed };
        findings.push(Finding::new(verdict, scenario, label, "version", message));
    }
    if !base.settings.is_empty() && !now.settings.is_empty() && base.settings != now.settings {
        let message = format!("the parameters were {} and are {}: look, then bless", base.settings, now.settings);
        findings.push(Finding::new(Verdict::Changed, scenario, label, "parameters", message));
    }
    let new = now.points.keys().filter(|place| !base.points.contains_key(place)).count();
    if new > 0 {
        findings.push(Finding::new(Verdict::Unblessed, scenario, label, "points", format!("not blessed yet: {new} points")));
    }
    findings
}

fn target(place: &Place) -> (Arc<str>, Arc<str>) {
    (place.view.clone(), place.target.clone())
}

fn trials(method: &MethodTable) -> BTreeSet<u64> {
    method.points.keys().map(|place| place.trial).collect()
}
