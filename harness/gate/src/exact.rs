//! Deterministic scenarios: every coordinate, point by point.

use super::TOLERANCE;
use super::finding::{Finding, Verdict};
use super::table::{Coordinates, Entry, MethodTable, Place, Table};

/// Every point that changed its status, its reason or, by more than [`TOLERANCE`], a coordinate. All of them fail.
pub(super) fn exact(baseline: &Table, current: &Table) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (label, base) in baseline.methods() {
        let Some(now) = current.method(label) else { continue };
        let pairs = base.points.iter().filter_map(|(place, old)| Some((place, old, now.points.get(place)?)));
        let changed = pairs.flat_map(|(place, old, new)| point(baseline, label, place, old, new));
        let changed: Vec<Finding> = changed.collect();
        let statuses = changed.iter().any(|finding| finding.metric == "status");
        findings.extend(changed);
        if statuses {
            findings.extend(counts(baseline, label, base, now));
        }
    }
    findings
}

fn point(table: &Table, label: &str, place: &Place, old: &Entry, new: &Entry) -> Vec<Finding> {
    let fails = |metric, message| Finding::new(Verdict::Fails, &table.scenario, label, metric, message).at(place.to_string());
    let (Some(a), Some(b)) = (old.coordinates(), new.coordinates()) else {
        let same = old == new;
        return if same { Vec::new() } else { vec![fails("status", format!("was {}, is {}", old.describe(), new.describe()))] };
    };
    let mut findings = Vec::new();
    if old.status() != new.status() {
        findings.push(fails("status", format!("was {}, is {}", old.describe(), new.describe())));
    }
    let verdict = verdict(table.coordinates, a, b);
    for (axis, metric) in table.coordinates.names().into_iter().enumerate() {
        if !agree(a[axis], b[axis]) {
            findings.push(fails(metric, verdict.to_owned()).figures(a[axis], b[axis]));
        }
    }
    findings
}

fn agree(a: f64, b: f64) -> bool {
    (a - b).abs() <= TOLERANCE || (a.is_nan() && b.is_nan())
}

/// Which way a point went, by the magnitude of its error.
fn verdict(coordinates: Coordinates, old: [f64; 2], new: [f64; 2]) -> &'static str {
    let [old, new] = [old, new].map(|[x, y]| x.hypot(y));
    match coordinates {
        Coordinates::Positions => "moved; no truth says whether for the better",
        Coordinates::Errors if new <= old - TOLERANCE => "better, not blessed",
        Coordinates::Errors if (new - old).abs() < TOLERANCE => "as far off, elsewhere; not blessed",
        Coordinates::Errors => "worse",
    }
}

fn counts(table: &Table, label: &str, base: &MethodTable, now: &MethodTable) -> Vec<Finding> {
    let figures = base.counts().into_iter().zip(now.counts()).zip(["measured", "lost", "rejected"]);
    let changed = figures.filter(|((old, new), _)| old != new);
    let finding = |((old, new), metric)| {
        let message = format!("{old} of {} points, now {new} of {}", base.points.len(), now.points.len());
        Finding::new(Verdict::Informs, &table.scenario, label, metric, message).figures(old as f64, new as f64)
    };
    changed.map(finding).collect()
}
