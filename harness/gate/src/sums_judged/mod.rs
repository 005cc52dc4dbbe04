//! Two digests that differ, judged by counts and moments.

use super::finding::{Finding, Verdict};
use super::moments::{PointSums, Sum};

/// By how much, as a fraction, the root mean square error of a method in a cell may grow without being worse; its scatter by twice as much.
pub const CELL_GROWTH: f64 = 0.02;
/// By how much, as a fraction of the method's own in that cell, the root mean square error of a target may grow.
pub const TARGET_GROWTH: f64 = 0.2;
/// How many of a method's points in a cell may be lost or rejected that were not, as a fraction of all.
pub const FAILURES: f64 = 0.01;
/// By how much, as a fraction, errors may move away from the standard deviations that the method reports.
pub const SIGMA_DRIFT: f64 = 0.05;
/// How far, px, means may differ, and, as a fraction, covariances, if only last digits do: what rounding leaves of sums that are equal.
const ROUNDING: [f64; 2] = [2e-8, 4e-6];

type Make<'a> = &'a dyn Fn(Verdict, &'static str, String) -> Finding;

/// What differs between `old`, which was blessed, and `new`. Nothing if the digests are the same; a digest that differs while all sums
/// agree to the last digit is a coordinate at the border of two rounded values.
pub(super) fn judged(old: &PointSums, new: &PointSums, finding: Make<'_>) -> Vec<Finding> {
    let mut findings = sigmas(old, new, finding);
    if old.digest == new.digest {
        return findings;
    }
    for target in old.targets.keys().filter(|target| !new.targets.contains_key(*target)) {
        findings.push(finding(Verdict::Fails, "target", "the target is missing".into()).at(&**target));
    }
    let pairs: Vec<(&str, &Sum, &Sum)> = old.targets.iter().filter_map(|(name, a)| Some((&**name, a, new.targets.get(name)?))).collect();
    if findings.is_empty() && old.targets.len() == new.targets.len() && pairs.iter().all(|(_, a, b)| same(a, b)) {
        return Vec::new();
    }
    let (a, b) = (Pooled::of(pairs.iter().map(|pair| pair.1)), Pooled::of(pairs.iter().map(|pair| pair.2)));
    findings.push(finding(Verdict::Changed, "digest", "the points are others".into()).figures(a.rms(), b.rms()));
    findings.extend(counts(&pairs, &a, &b, finding));
    for (metric, old, new, growth) in
        [("rms_error", a.rms(), b.rms(), CELL_GROWTH), ("scatter", a.scatter(), b.scatter(), 2.0 * CELL_GROWTH)]
    {
        if grew(old, new, growth) {
            findings.push(finding(Verdict::Fails, metric, format!("worse by more than {} %", 100.0 * growth)).figures(old, new));
        }
    }
    for (name, before, after) in pairs {
        let (old, new) = (before.square().sqrt(), after.square().sqrt());
        if new - old > TARGET_GROWTH * a.rms() + super::TOLERANCE {
            let message = format!("worse by more than {} % of the method's own", 100.0 * TARGET_GROWTH);
            findings.push(finding(Verdict::Fails, "rms_error", message).at(name).figures(old, new));
        }
    }
    findings
}

/// Points that are measured no more, by target, and whether they are too many.
fn counts(pairs: &[(&str, &Sum, &Sum)], a: &Pooled, b: &Pooled, finding: Make<'_>) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (name, old, new) in pairs.iter().filter(|(_, old, new)| new.nans > old.nans) {
        let (old, new) = (old.nans as f64, new.nans as f64);
        findings.push(finding(Verdict::Fails, "nan", "more points of this target are not a number".into()).at(*name).figures(old, new));
    }
    for (place, metric) in [(1, "lost"), (2, "rejected")] {
        for (name, old, new) in pairs.iter().filter(|(_, old, new)| new.counts[place] > old.counts[place]) {
            let (old, new) = (old.counts[place] as f64, new.counts[place] as f64);
            findings.push(finding(Verdict::Changed, metric, "more points of this target".into()).at(*name).figures(old, new));
        }
        let (old, new) = (a.counts[place], b.counts[place]);
        if new - old > (FAILURES * a.points()).max(1.0) {
            let message = format!("worse by more than {} % of all points", 100.0 * FAILURES);
            findings.push(finding(Verdict::Fails, metric, message).figures(old, new));
        }
    }
    if b.counts[0] == 0.0 && a.counts[0] > 0.0 {
        findings.push(finding(Verdict::Fails, "tests", "no longer tested: no point is measured".into()).figures(a.counts[0], 0.0));
    }
    findings
}

/// Reported standard deviations: whether they are others, and whether errors fit them less.
fn sigmas(old: &PointSums, new: &PointSums, finding: Make<'_>) -> Vec<Finding> {
    let pairs: Vec<(&Sum, &Sum)> = old.targets.iter().filter_map(|(name, a)| Some((a, new.targets.get(name)?))).collect();
    let other = |(a, b): &&(&Sum, &Sum)| match (a.sigma, b.sigma) {
        (Some(a), Some(b)) => (a - b).abs() > super::TOLERANCE,
        (Some(_), None) => b.counts[0] > 0,
        _ => false,
    };
    let changed: Vec<&(&Sum, &Sum)> = pairs.iter().filter(other).collect();
    if changed.is_empty() {
        return Vec::new();
    }
    let ratio = |of: fn(&(&Sum, &Sum)) -> Sum| {
        let sums = pairs.iter().map(of).filter(|sum| sum.sigma.is_some());
        let (square, variance) = sums.fold((0.0, 0.0), |(square, variance), sum| {
            let n = sum.counts[0] as f64;
            (square + n * sum.square(), variance + n * sum.sigma.unwrap_or_default().powi(2))
        });
        (square / variance).sqrt()
    };
    let (a, b) = (ratio(|pair| *pair.0), ratio(|pair| *pair.1));
    let message = format!("the reported standard deviations of {} targets are others", changed.len());
    let worse = b.is_nan() || a.is_nan() || b.ln().abs() > a.ln().abs() + SIGMA_DRIFT;
    vec![finding(if worse { Verdict::Fails } else { Verdict::Changed }, "error_over_sigma", message).figures(a, b)]
}

fn same(a: &Sum, b: &Sum) -> bool {
    let [step, fraction] = ROUNDING;
    let means = a.mean.iter().zip(b.mean).all(|(a, b)| (a - b).abs() <= step);
    let scale = a.spread().max(b.spread());
    let covariances = a.covariance.iter().zip(b.covariance).all(|(a, b)| (a - b).abs() <= fraction * scale + step * step);
    (a.counts, a.nans) == (b.counts, b.nans) && means && covariances
}

fn grew(old: f64, new: f64, growth: f64) -> bool {
    new > old * (1.0 + growth) + super::TOLERANCE
}

/// All targets of a method in a cell together.
struct Pooled {
    counts: [f64; 3],
    square: f64,
    spread: f64,
}

impl Pooled {
    fn of<'a>(sums: impl Iterator<Item = &'a Sum>) -> Self {
        let mut all = Self { counts: [0.0; 3], square: 0.0, spread: 0.0 };
        for sum in sums {
            (0..3).for_each(|place| all.counts[place] += sum.counts[place] as f64);
            all.square += sum.counts[0] as f64 * sum.square();
            all.spread += sum.counts[0] as f64 * sum.spread();
        }
        all
    }

    fn points(&self) -> f64 {
        self.counts.iter().sum()
    }

    fn rms(&self) -> f64 {
        (self.square / self.counts[0].max(1.0)).sqrt()
    }

    fn scatter(&self) -> f64 {
        (self.spread / self.counts[0].max(1.0)).sqrt()
    }
}

#[cfg(test)]
mod tests;
