//! Runs in which nothing is random, and those without truth: each point is judged by itself.

use super::TOLERANCE;
use super::changed::{Changes, Pair, agree};
use super::finding::{Finding, Verdict};
use super::point_entry::Coordinates;
use super::table::{MethodTable, Table};

/// A finding for every point that changed. What is worse fails, and what no truth can judge; what is better or as far off elsewhere changed.
pub(super) fn exact(table: &Table, label: &str, [base, now]: [&MethodTable; 2], changes: &Changes<'_>) -> Vec<Finding> {
    let new = |verdict, metric, message: String| Finding::new(verdict, &table.scenario, label, metric, message);
    let mut findings = Vec::new();
    for pair in &changes.statuses {
        let verdict = if worse_status(pair) { Verdict::Fails } else { Verdict::Changed };
        findings.push(new(verdict, "status", status(pair)).at(pair.0.to_string()));
    }
    for pair in &changes.moved {
        findings.extend(moved(table.coordinates, pair, &new));
    }
    if !changes.statuses.is_empty() {
        findings.extend(counts(&new, base, now));
    }
    findings
}

/// Whether a point that was measured is measured no more.
pub(super) fn worse_status((_, old, new): &Pair<'_>) -> bool {
    (old.is_kept() && !new.is_kept()) || (new.is_nan() && !old.is_nan())
}

/// The change of status in words.
pub(super) fn status((_, old, new): &Pair<'_>) -> String {
    format!("was {}, is {}", old.describe(), new.describe())
}

fn moved(kind: Coordinates, (place, old, new): &Pair<'_>, finding: &dyn Fn(Verdict, &'static str, String) -> Finding) -> Vec<Finding> {
    let (Some(a), Some(b)) = (old.coordinates(), new.coordinates()) else { return Vec::new() };
    let (verdict, message) = judged(kind, a, b);
    let axes = kind.names().into_iter().enumerate().filter(|(axis, _)| !agree(a[*axis], b[*axis]));
    axes.map(|(axis, metric)| finding(verdict, metric, message.to_owned()).at(place.to_string()).figures(a[axis], b[axis])).collect()
}

/// Which way a point went, by the magnitude of its error.
fn judged(coordinates: Coordinates, old: [f64; 2], new: [f64; 2]) -> (Verdict, &'static str) {
    let [old, new] = [old, new].map(|[x, y]| x.hypot(y));
    match coordinates {
        Coordinates::Positions => (Verdict::Fails, "moved; no truth says whether for the better"),
        Coordinates::Errors if new <= old - TOLERANCE => (Verdict::Changed, "better, not blessed"),
        Coordinates::Errors if (new - old).abs() < TOLERANCE => (Verdict::Changed, "as far off, elsewhere; not blessed"),
        Coordinates::Errors => (Verdict::Fails, "worse"),
    }
}

fn counts(new: &dyn Fn(Verdict, &'static str, String) -> Finding, base: &MethodTable, now: &MethodTable) -> Vec<Finding> {
    let figures = base.counts().into_iter().zip(now.counts()).zip(["measured", "lost", "rejected"]);
    let changed = figures.filter(|((old, new), _)| old != new);
    let finding = |((old, count), metric)| {
        let message = format!("{old} of {} points, now {count} of {}", base.points.len(), now.points.len());
        new(Verdict::Informs, metric, message).figures(old as f64, count as f64)
    };
    changed.map(finding).collect()
}
