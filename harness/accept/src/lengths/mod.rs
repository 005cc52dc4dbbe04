//! Tests by calibrated lengths.

mod remarks;

use std::collections::BTreeMap;

use calibench_model::{MeasuredDistance, TestLength};

pub use remarks::{Assumed, LENGTHS_OF_LINE, LINES, OF_DIAGONAL, Unmet};

use crate::{Decision, Limit, Rule, conformance_probability};

/// What is tested, and by what.
#[derive(Clone, Copy, Debug)]
pub struct LengthTest<'a> {
    /// The lengths.
    pub lengths: &'a [TestLength],
    /// The limit of their errors.
    pub limit: Limit,
    /// When an error is taken as within or beyond it.
    pub rule: Rule,
    /// Diagonal of the measuring volume, in the unit of the lengths, if it is told.
    pub diagonal: Option<f64>,
    /// The distances that gave the scale, if they are told: those among the lengths are no test.
    pub scale: Option<&'a [MeasuredDistance]>,
}

/// What became of a length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Its error was held against the limit.
    Tested(Decision),
    /// It gave the scale.
    GaveScale,
    /// It has no measured length.
    NotMeasured,
}

/// A length against its limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LengthResult {
    /// Measured less calibrated length, in their unit; `None` where nothing was measured.
    pub error: Option<f64>,
    /// The limit of its size.
    pub limit: f64,
    /// Probability that the error is within the limit; `None` where it is not tested.
    pub probability: Option<f64>,
    /// What became of it.
    pub outcome: Outcome,
}

/// The tested errors together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Together {
    /// How many.
    pub count: usize,
    /// The largest by size, in the unit of the lengths, and the place of its length.
    pub largest: (f64, usize),
    /// Root mean square.
    pub rms: f64,
    /// The best change of scale, a number: that of measured lengths is larger by so much, and its standard deviation from the scatter of the errors; `None` of a
    /// single length.
    pub scale: Option<(f64, f64)>,
    /// The probability that all errors are within their limits, if the reference's errors are independent.
    pub probability: f64,
}

/// The outcome of a test.
#[derive(Clone, Debug, PartialEq)]
pub struct LengthAcceptance {
    /// Each length, in their order.
    pub results: Vec<LengthResult>,
    /// The tested ones together; `None` where none is.
    pub together: Option<Together>,
    /// What keeps it from being passed, whatever the errors.
    pub unmet: Vec<Unmet>,
    /// What is taken for granted.
    pub assumed: Vec<Assumed>,
    /// Of all: a single length beyond its limit fails, however few there are.
    pub decision: Decision,
}

impl LengthTest<'_> {
    /// Holds each length against its limit, with the reference's uncertainty, and all of them against what a test must have.
    ///
    /// Source: VDI/VDE 2634 part 1 and ISO 14253-1:2017, as [`crate::basis`] knows them.
    pub fn run(&self) -> LengthAcceptance {
        let results: Vec<LengthResult> = self.lengths.iter().map(|length| self.result(length)).collect();
        let decisions: Vec<Decision> = results.iter().filter_map(|result| result.outcome.decision()).collect();
        let unmet = self.unmet(&results);
        let failed = decisions.contains(&Decision::Fail);
        let decision = if failed || unmet.is_empty() { Decision::of_all(decisions) } else { Decision::CannotTell };
        LengthAcceptance { together: self.together(&results), assumed: self.assumed(&results), results, unmet, decision }
    }

    fn result(&self, length: &TestLength) -> LengthResult {
        let limit = self.limit.at(length.calibrated);
        let error = length.measured.map(|measured| measured - length.calibrated);
        let result = |outcome, probability| LengthResult { error, limit, probability, outcome };
        let Some(error) = error else { return result(Outcome::NotMeasured, None) };
        if self.scale.is_some_and(|scale| scale.iter().any(|distance| is_same(&distance.targets, &length.targets))) {
            return result(Outcome::GaveScale, None);
        }
        let decision = self.rule.decide(error, length.sigma, limit);
        result(Outcome::Tested(decision), Some(conformance_probability(error, length.sigma, limit)))
    }

    /// The tested lengths with their results.
    fn tested<'r>(&'r self, results: &'r [LengthResult]) -> impl Iterator<Item = (usize, &'r TestLength, f64)> {
        let all = self.lengths.iter().zip(results).enumerate();
        all.filter(|(_, (_, result))| result.outcome.decision().is_some())
            .filter_map(|(place, (length, result))| Some((place, length, result.error?)))
    }

    fn together(&self, results: &[LengthResult]) -> Option<Together> {
        let largest = self.tested(results).map(|(place, _, error)| (error, place)).max_by(|a, b| a.0.abs().total_cmp(&b.0.abs()))?;
        let sums = self.tested(results).fold([0.0; 4], |[n, ee, el, ll], (_, length, error)| {
            [n + 1.0, ee + error * error, el + error * length.calibrated, ll + length.calibrated * length.calibrated]
        });
        let [count, squares, products, lengths] = sums;
        let rate = products / lengths;
        let left = (squares - rate * products).max(0.0);
        Some(Together {
            count: count as usize,
            largest,
            rms: (squares / count).sqrt(),
            scale: (count > 1.0).then(|| (rate, (left / (count - 1.0) / lengths).sqrt())),
            probability: results.iter().filter_map(|result| result.probability).product(),
        })
    }

    fn unmet(&self, results: &[LengthResult]) -> Vec<Unmet> {
        let mut lines: BTreeMap<&str, usize> = BTreeMap::new();
        self.tested(results).for_each(|(_, length, _)| *lines.entry(&length.line).or_default() += 1);
        let whole = lines.values().filter(|count| **count >= LENGTHS_OF_LINE).count();
        let longest = self.tested(results).map(|(_, length, _)| length.calibrated).fold(0.0, f64::max);
        let missing = count(results, Outcome::NotMeasured);
        let short = self.diagonal.filter(|diagonal| longest < OF_DIAGONAL * diagonal);
        let lines = (whole < LINES).then_some(Unmet::Lines(whole));
        let missing = (missing > 0).then_some(Unmet::NotMeasured(missing));
        lines.into_iter().chain(short.map(|diagonal| Unmet::Longest { longest, diagonal })).chain(missing).collect()
    }

    fn assumed(&self, results: &[LengthResult]) -> Vec<Assumed> {
        let exact = self.tested(results).filter(|(_, length, _)| length.sigma == 0.0).count();
        let gave = count(results, Outcome::GaveScale);
        let all = [
            (exact > 0).then_some(Assumed::Exact(exact)),
            self.scale.is_none().then_some(Assumed::ScaleUntold),
            (gave > 0).then_some(Assumed::GaveScale(gave)),
            self.diagonal.is_none().then_some(Assumed::VolumeUntold),
        ];
        all.into_iter().flatten().collect()
    }
}

impl Outcome {
    /// What was decided, of a tested length.
    pub const fn decision(self) -> Option<Decision> {
        match self {
            Self::Tested(decision) => Some(decision),
            Self::GaveScale | Self::NotMeasured => None,
        }
    }

    /// In words.
    pub const fn words(self) -> &'static str {
        match self {
            Self::Tested(decision) => decision.words(),
            Self::GaveScale => "gave the scale",
            Self::NotMeasured => "not measured",
        }
    }
}

fn count(results: &[LengthResult], outcome: Outcome) -> usize {
    results.iter().filter(|result| result.outcome == outcome).count()
}

/// Whether two pairs of targets are one, in whichever order.
fn is_same(a: &[String; 2], b: &[String; 2]) -> bool {
    a == b || (a[0] == b[1] && a[1] == b[0])
}

#[cfg(test)]
mod tests;
