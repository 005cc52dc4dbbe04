//! What the gate has to say.

use std::cmp::Ordering;

/// Does a finding fail the check?
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    /// Yes.
    Fails,
    /// No: to be known, perhaps to be blessed.
    Informs,
}

/// One thing that differs from what was blessed, or breaks a ceiling.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// Does it fail the check?
    pub verdict: Verdict,
    /// The scenario.
    pub scenario: String,
    /// The method's label.
    pub method: String,
    /// The target, or trial and target, when it is about one.
    pub target: Option<String>,
    /// What was compared, as in `mean_dx` or `lost`.
    pub metric: &'static str,
    /// The blessed figure or the ceiling, in the metric's unit.
    pub baseline: Option<f64>,
    /// The figure now, in the metric's unit.
    pub now: Option<f64>,
    /// The p-value, adjusted for all tests of the check, where a test was made.
    pub p: Option<f64>,
    /// In words.
    pub message: String,
}

impl Finding {
    pub(super) fn new(verdict: Verdict, scenario: &str, method: &str, metric: &'static str, message: impl Into<String>) -> Self {
        let (scenario, method, message) = (scenario.to_owned(), method.to_owned(), message.into());
        Self { verdict, scenario, method, target: None, metric, baseline: None, now: None, p: None, message }
    }

    pub(super) fn at(self, target: impl Into<String>) -> Self {
        Self { target: Some(target.into()), ..self }
    }

    pub(super) fn figures(self, baseline: f64, now: f64) -> Self {
        Self { baseline: Some(baseline), now: Some(now), ..self }
    }

    /// Does it fail the check?
    pub fn fails(&self) -> bool {
        self.verdict == Verdict::Fails
    }

    /// The figure now less the baseline's.
    pub fn change(&self) -> Option<f64> {
        Some(self.now? - self.baseline?)
    }

    /// Failing ones first, then by scenario, method, target and metric.
    pub(super) fn order(&self, other: &Self) -> Ordering {
        let key = |f: &Self| (f.verdict, f.scenario.clone(), f.method.clone(), f.metric, f.target.clone(), f.message.clone());
        key(self).cmp(&key(other))
    }
}
