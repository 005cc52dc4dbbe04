//! The figures of adjustments over all trials: parameters, poses and check points with their reported standard deviations, as sums.

use std::collections::BTreeMap;

use calibench_records::figures::{Better, FigureName, Group, Quantity};

use super::adjusted::{FigureKey, Numbers};
use super::baseline_file::{BaselineError, Kind, Row};
use super::cells::Kept;
use super::finding::{Finding, Verdict};
use super::table::MethodTable;

/// What is no change of a figure, as a fraction of its standard deviation or scatter: last bits, carried through an adjustment.
const SAME: f64 = 1e-4;
/// The least standard deviation of a root mean square error, as a fraction of it: `1 / sqrt(2 n)`, of 5000 coordinates.
const ERROR_SIGMA: f64 = 0.01;
/// What is no change of a figure, as a fraction of its value, whatever its standard deviation.
const DIGITS: f64 = 1e-8;
/// What is no error, as a fraction of the largest of its set and group: those that are zero but for rounding stand beside such that are not.
const NOTHING: f64 = 1e-12;
/// By how much, as a fraction, a root mean square error may grow without being worse.
pub const FIGURE_GROWTH: f64 = 0.02;
/// By how much, as a fraction, errors may move away from the reported standard deviations.
const SIGMA_DRIFT: f64 = 0.05;

/// A figure over all trials.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct FigureSum {
    /// In how many trials there is one.
    pub count: u64,
    /// The mean value, in the figure's unit.
    pub mean: f64,
    /// The scatter of the values about their mean, in the same unit: the root of the mean of their squared deviations.
    pub scatter: f64,
    /// The root mean square error against the truth, in the same unit, where that is known.
    pub error: Option<f64>,
    /// The root mean square of the reported standard deviations, in the same unit.
    pub sigma: Option<f64>,
}

impl FigureSum {
    fn of<'a>(numbers: impl Iterator<Item = &'a Numbers>) -> Self {
        let all: Vec<&Numbers> = numbers.collect();
        let n = all.len().max(1) as f64;
        let mean = all.iter().map(|x| x.value).sum::<f64>() / n;
        let scatter = (all.iter().map(|x| (x.value - mean).powi(2)).sum::<f64>() / n).sqrt();
        let rms = |of: fn(&Numbers) -> Option<f64>| {
            let squares: Vec<f64> = all.iter().filter_map(|x| of(x)).map(|value| value * value).collect();
            (!squares.is_empty()).then(|| (squares.iter().sum::<f64>() / squares.len() as f64).sqrt())
        };
        Self { count: all.len() as u64, mean, scatter, error: rms(|x| x.error), sigma: rms(|x| x.sigma) }
    }

    /// Whether both, of a group, are the same but for last bits.
    fn same(&self, other: &Self, group: Group) -> bool {
        let own = if is_error(group) { ERROR_SIGMA * self.mean.abs() } else { 0.0 };
        let scale = self.sigma.unwrap_or(own).max(self.scatter).max(self.error.unwrap_or(0.0));
        let agree_within = |digits: f64, a: f64, b: f64| (a - b).abs() <= SAME * scale + digits || a == b || (a.is_nan() && b.is_nan());
        let agree = |a: f64, b: f64| agree_within(DIGITS * a.abs(), a, b);
        let optional = |a: Option<f64>, b: Option<f64>| match (a, b) {
            (Some(a), Some(b)) => agree(a, b),
            (None, None) => true,
            _ => false,
        };
        self.count == other.count
            && agree(self.mean, other.mean)
            // Of a value that is the same in all trials the scatter is the rounding of its digits.
            && agree_within(DIGITS * self.mean.abs(), self.scatter, other.scatter)
            && optional(self.error, other.error)
            && optional(self.sigma, other.sigma)
    }

    /// Whether nothing is beyond `limit`.
    fn is_within(&self, limit: f64) -> bool {
        self.mean.abs() + self.scatter <= limit
    }

    /// How far errors are from the reported standard deviations: the logarithm of their ratio.
    fn misfit(&self) -> Option<f64> {
        let ratio = self.error? / self.sigma.filter(|sigma| *sigma > 0.0)?;
        (ratio > 0.0).then(|| ratio.ln().abs())
    }
}

/// All figures of a method in a cell.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FigureSums(pub(super) BTreeMap<FigureKey, FigureSum>);

impl Kept for FigureSums {
    const KIND: Kind = Kind::Figures;
    const COLUMNS: &'static [&'static str] = &["set", "group", "name", "count", "mean", "scatter", "error", "sigma"];

    fn of(method: &MethodTable) -> Self {
        Self(method.figures.iter().map(|(key, trials)| (key.clone(), FigureSum::of(trials.values()))).collect())
    }

    fn rows(&self) -> Vec<Vec<String>> {
        let digits = |value: f64| format!("{value:.9e}");
        let optional = |value: Option<f64>| value.map_or_else(String::new, |value| format!("{value:.6e}"));
        let row = |((set, figure), sum): (&FigureKey, &FigureSum)| {
            let [set, group, name] = [(set + 1).to_string(), figure.group().name().to_owned(), figure.to_string()];
            vec![
                set,
                group,
                name,
                sum.count.to_string(),
                digits(sum.mean),
                format!("{:.6e}", sum.scatter),
                optional(sum.error),
                optional(sum.sigma),
            ]
        };
        self.0.iter().map(row).collect()
    }

    fn add(&mut self, row: &Row<'_>) -> Result<(), BaselineError> {
        let group = Group::named(row.text(3)).ok_or_else(|| row.wrong(3, "expected a group of figures"))?;
        let figure = FigureName::parse(group, row.text(4)).map_err(|unknown| row.wrong(4, &unknown.to_string()))?;
        let set: usize = row.parse(2)?;
        let key = (set.checked_sub(1).ok_or_else(|| row.wrong(2, "expected 1 or more"))?, figure);
        let [count, mean, scatter] = [5, 6, 7];
        let sum = FigureSum {
            count: row.parse(count)?,
            mean: row.parse(mean)?,
            scatter: row.parse(scatter)?,
            error: row.optional(8)?,
            sigma: row.optional(9)?,
        };
        if self.0.insert(key, sum).is_some() { Err(row.wrong(4, "the figure is there twice")) } else { Ok(()) }
    }

    fn compare(&self, now: &Self, finding: &dyn Fn(Verdict, &'static str, String) -> Finding) -> Vec<Finding> {
        let mut findings = Vec::new();
        let mut largest: BTreeMap<(usize, Group), f64> = BTreeMap::new();
        for ((set, figure), sum) in self.0.iter().filter(|((_, figure), _)| is_error(figure.group())) {
            let largest = largest.entry((*set, figure.group())).or_default();
            *largest = largest.max(sum.mean.abs());
        }
        for (key, old) in &self.0 {
            let (set, group) = (key.0, key.1.group());
            let name = format!("set {} {} {}", set + 1, group.name(), key.1);
            let Some(new) = now.0.get(key) else {
                findings.push(finding(Verdict::Fails, "figure", "the figure is missing".into()).at(name));
                continue;
            };
            let rounding = largest.get(&(set, group)).map_or(0.0, |largest| NOTHING * largest);
            let both_nothing = old.count == new.count && old.is_within(rounding) && new.is_within(rounding);
            if !both_nothing && !old.same(new, group) {
                findings.extend(judged(&key.1, old, new, finding).map(|found| found.at(name.as_str())));
            }
        }
        let new = now.0.keys().filter(|key| !self.0.contains_key(*key)).count();
        if new > 0 {
            findings.push(finding(Verdict::Unblessed, "figure", format!("not blessed yet: {new} figures of adjustments")));
        }
        findings
    }

    fn count(&self) -> usize {
        self.0.len()
    }
}

/// The distance of cameras over the frame and the errors of check points are errors themselves. Of the other figures each has a unit of its own.
fn is_error(group: Group) -> bool {
    matches!(group, Group::Frame | Group::Check)
}

/// What changed of a figure, and what of it is worse.
fn judged(
    figure: &FigureName,
    old: &FigureSum,
    new: &FigureSum,
    finding: &dyn Fn(Verdict, &'static str, String) -> Finding,
) -> impl Iterator<Item = Finding> {
    let (mut findings, group) = (Vec::new(), figure.group());
    if new.count < old.count {
        let message = "fewer adjustments give this figure".to_owned();
        findings.push(finding(Verdict::Fails, "adjusted", message).figures(old.count as f64, new.count as f64));
    }
    let error = |sum: &FigureSum| if is_error(group) { Some(sum.mean) } else { sum.error };
    if let (Some(a), Some(b)) = (error(old), error(new))
        && (b.is_nan() || b > a * (1.0 + FIGURE_GROWTH))
    {
        findings.push(finding(Verdict::Fails, "error", format!("worse by more than {} %", 100.0 * FIGURE_GROWTH)).figures(a, b));
    }
    if figure.quantity() == Quantity::IsWrongAndSilent && new.mean > old.mean {
        findings.push(finding(Verdict::Fails, "silent", "wrong without a word more often".into()).figures(old.mean, new.mean));
    }
    // Of mean squares half the logarithm: as of their roots.
    let from_one = |sum: &FigureSum| 0.5 * sum.mean.ln().abs();
    let (before, now) = (from_one(old), from_one(new));
    if figure.quantity().entry().better == Better::One && (now.is_nan() || now > before + SIGMA_DRIFT) {
        let message = format!("errors fit what is stated less, by more than {} %", 100.0 * SIGMA_DRIFT);
        findings.push(finding(Verdict::Fails, "stated", message).figures(old.mean, new.mean));
    }
    match (old.sigma, new.sigma) {
        (Some(a), None) => {
            findings.push(finding(Verdict::Fails, "sigma", "the reported standard deviation is missing".into()).figures(a, 0.0));
        }
        (Some(a), Some(b)) if new.misfit().zip(old.misfit()).is_some_and(|(new, old)| new > old + SIGMA_DRIFT) || b.is_nan() => {
            let message = format!("errors fit the reported standard deviation less, by more than {} %", 100.0 * SIGMA_DRIFT);
            findings.push(finding(Verdict::Fails, "sigma", message).figures(a, b));
        }
        _ => {}
    }
    if findings.is_empty() {
        findings.push(finding(Verdict::Changed, "figure", "the figure is another".into()).figures(old.mean, new.mean));
    }
    findings.into_iter()
}

#[cfg(test)]
mod tests;
