//! What the gate has to say.

use std::cmp::Ordering;

use serde::Serialize;

/// What a finding does to a check.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// It fails the check.
    Fails,
    /// Other numbers than those that were blessed, and not worse: it fails a strict check.
    Changed,
    /// Not blessed at all: it fails a locked check.
    Unblessed,
    /// To be known.
    Informs,
}

/// Which findings fail a check beside those that always do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rules {
    /// Whether what changed fails, if it is not worse.
    pub strict: bool,
    /// Whether what is not blessed fails.
    pub locked: bool,
}

/// One thing that differs from what was blessed, or breaks a ceiling.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// What it does to the check.
    pub verdict: Verdict,
    /// The scenario, with the cell of a sweep behind `@`.
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
    /// The p-value (0 to 1), adjusted for all tests of its family, where a test was made.
    pub p: Option<f64>,
    /// In words.
    pub message: String,
}

impl Finding {
    /// A finding without figures.
    pub fn new(verdict: Verdict, scenario: &str, method: &str, metric: &'static str, message: impl Into<String>) -> Self {
        let (scenario, method, message) = (scenario.to_owned(), method.to_owned(), message.into());
        Self { verdict, scenario, method, target: None, metric, baseline: None, now: None, p: None, message }
    }

    /// The same about `target`.
    #[must_use]
    pub fn at(self, target: impl Into<String>) -> Self {
        Self { target: Some(target.into()), ..self }
    }

    /// The same with both figures, in the metric's unit.
    #[must_use]
    pub fn figures(self, baseline: f64, now: f64) -> Self {
        Self { baseline: Some(baseline), now: Some(now), ..self }
    }

    /// Whether it fails any check.
    pub fn fails(&self) -> bool {
        self.verdict == Verdict::Fails
    }

    /// Whether it fails a check by `rules`.
    pub fn fails_by(&self, rules: Rules) -> bool {
        match self.verdict {
            Verdict::Fails => true,
            Verdict::Changed => rules.strict,
            Verdict::Unblessed => rules.locked,
            Verdict::Informs => false,
        }
    }

    /// The figure now less the baseline's, in the metric's unit.
    pub fn change(&self) -> Option<f64> {
        Some(self.now? - self.baseline?)
    }

    /// Failing ones first, then by scenario, method, target and metric.
    pub(super) fn order(&self, other: &Self) -> Ordering {
        let key = |f: &Self| (f.verdict, f.scenario.clone(), f.method.clone(), f.metric, f.target.clone(), f.message.clone());
        key(self).cmp(&key(other))
    }
}
