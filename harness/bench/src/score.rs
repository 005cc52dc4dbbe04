//! Errors to figures, trial by trial, in memory that does not grow with their number.

use std::collections::BTreeMap;
use std::sync::Arc;

use statrs::distribution::{ContinuousCDF, StudentsT};

use crate::results::{Outcome, PointResult, Trial};

/// Running mean and variance (Welford).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Running {
    count: u64,
    mean: f64,
    squares: f64,
}

impl Running {
    /// Adds a value.
    pub fn add(&mut self, value: f64) {
        self.count += 1;
        let change = value - self.mean;
        self.mean += change / self.count as f64;
        self.squares += change * (value - self.mean);
    }

    /// How many values.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Their mean; `None` of nothing.
    pub fn mean(&self) -> Option<f64> {
        (self.count > 0).then_some(self.mean)
    }

    /// Their standard deviation about the mean; `None` of fewer than two.
    pub fn deviation(&self) -> Option<f64> {
        (self.count > 1).then(|| (self.squares / (self.count - 1) as f64).sqrt())
    }

    /// The two-sided interval of the mean at `level` (0.95), by Student's t; `None` of fewer than two.
    pub fn interval(&self, level: f64) -> Option<(f64, f64)> {
        let error = self.deviation()? / (self.count as f64).sqrt();
        let t = StudentsT::new(0.0, 1.0, (self.count - 1) as f64).ok()?.inverse_cdf(f64::midpoint(1.0, level));
        Some((self.mean - t * error, self.mean + t * error))
    }
}

/// The figures of one method on one scenario. Lost and rejected points are counted and take no part in the errors.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Score {
    /// Points measured within [`crate::results::LOST`] px of the truth, or, without truth, measured.
    pub measured: u64,
    /// Points measured further off.
    pub lost: u64,
    /// Points rejected, by reason.
    pub rejected: BTreeMap<&'static str, u64>,
    /// Errors in x, px.
    pub dx: Running,
    /// Errors in y, px.
    pub dy: Running,
    /// Mean squared 2D error of a trial, px^2: over its trials.
    pub square: Running,
    /// The same over all measured points, lost ones among them.
    pub whole_square: Running,
    /// The same as `square` over the points that every method measured.
    pub common_square: Running,
    /// By target, in the order of the scenario.
    pub targets: Vec<TargetScore>,
}

/// The figures of one method on one target.
#[derive(Clone, Debug, PartialEq)]
pub struct TargetScore {
    /// The target.
    pub target: Arc<str>,
    /// Squared 2D errors of all measured points, lost ones among them, px^2.
    pub square: Running,
    /// Points that were lost or rejected.
    pub failed: u64,
}

impl Score {
    fn target(&mut self, target: &Arc<str>) -> &mut TargetScore {
        let place = self.targets.iter().position(|score| score.target == *target).unwrap_or_else(|| {
            self.targets.push(TargetScore { target: target.clone(), square: Running::default(), failed: 0 });
            self.targets.len() - 1
        });
        &mut self.targets[place]
    }

    /// All points that the method was given.
    pub fn points(&self) -> u64 {
        self.measured + self.lost + self.rejected.values().sum::<u64>()
    }

    /// `sqrt(mean(dx^2 + dy^2))`, px.
    pub fn rmse(&self) -> Option<f64> {
        self.square.mean().map(f64::sqrt)
    }

    /// The 95 % interval of [`Self::rmse`] from the scatter between trials.
    pub fn rmse_interval(&self) -> Option<(f64, f64)> {
        self.square.interval(0.95).map(|(low, high)| (low.max(0.0).sqrt(), high.sqrt()))
    }

    /// The 2D standard deviation about the mean error, px.
    pub fn scatter(&self) -> Option<f64> {
        Some(self.dx.deviation()?.hypot(self.dy.deviation()?))
    }
}

/// The scores of all methods of a scenario.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scores {
    /// In the order of the methods.
    pub methods: Vec<Score>,
    /// How many trials.
    pub trials: u64,
}

impl Scores {
    /// No trial yet, for `methods` methods.
    pub fn new(methods: usize) -> Self {
        Self { methods: vec![Score::default(); methods], trials: 0 }
    }

    /// Adds a trial.
    pub fn add(&mut self, trial: &Trial) {
        self.trials += 1;
        // Records name a method when they first meet it.
        let most = trial.points.iter().map(|point| point.method + 1).max().unwrap_or(0);
        if most > self.methods.len() {
            self.methods.resize_with(most, Score::default);
        }
        let common = common_points(trial);
        for (index, score) in self.methods.iter_mut().enumerate() {
            let mut all = Running::default();
            let mut whole = Running::default();
            let mut shared = Running::default();
            for point in trial.points.iter().filter(|point| point.method == index) {
                count(score, point);
                if let Outcome::Measured { error: Some((dx, dy)), .. } = point.outcome {
                    whole.add(dx * dx + dy * dy);
                    score.target(&point.target).square.add(dx * dx + dy * dy);
                }
                if let Some((dx, dy)) = point.outcome.kept_error() {
                    score.dx.add(dx);
                    score.dy.add(dy);
                    all.add(dx * dx + dy * dy);
                    if common.contains_key(&(point.view.clone(), point.target.clone())) {
                        shared.add(dx * dx + dy * dy);
                    }
                } else {
                    score.target(&point.target).failed += 1;
                }
            }
            all.mean().into_iter().for_each(|square| score.square.add(square));
            whole.mean().into_iter().for_each(|square| score.whole_square.add(square));
            shared.mean().into_iter().for_each(|square| score.common_square.add(square));
        }
    }
}

fn count(score: &mut Score, point: &PointResult) {
    match point.outcome {
        Outcome::Rejected(why) => *score.rejected.entry(why.name()).or_default() += 1,
        Outcome::Measured { .. } if point.outcome.is_lost() => score.lost += 1,
        Outcome::Measured { .. } => score.measured += 1,
    }
}

/// The points that every method of the trial measured and did not lose.
fn common_points(trial: &Trial) -> BTreeMap<(Arc<str>, Arc<str>), usize> {
    let mut methods: Vec<usize> = trial.points.iter().map(|point| point.method).collect();
    methods.sort_unstable();
    methods.dedup();
    let mut counts = BTreeMap::new();
    for point in trial.points.iter().filter(|point| point.outcome.kept_error().is_some()) {
        *counts.entry((point.view.clone(), point.target.clone())).or_insert(0) += 1;
    }
    counts.retain(|_, count| *count == methods.len());
    counts
}

#[cfg(test)]
mod tests {
    use super::*;
    use calibench_model::{PixelPoint, Rejection};

    fn point(method: usize, target: &str, error: Option<(f64, f64)>) -> PointResult {
        let outcome = error.map_or(Outcome::Rejected(Rejection::Border), |error| Outcome::Measured {
            position: PixelPoint::new(0.0, 0.0),
            error: Some(error),
        });
        PointResult { view: "v".into(), target: target.into(), method, outcome }
    }

    #[test]
    fn lost_and_rejected_points_are_counted_and_not_averaged() {
        let mut scores = Scores::new(2);
        let points = vec![
            point(0, "a", Some((0.3, 0.4))),
            point(0, "b", Some((3.0, 4.0))),
            point(0, "c", None),
            point(1, "a", Some((0.0, 0.1))),
            point(1, "b", Some((0.0, 0.7))),
        ];
        scores.add(&Trial { number: 0, points, missed_views: Vec::new() });
        let first = &scores.methods[0];
        assert_eq!((first.measured, first.lost, first.rejected["border"], first.points()), (1, 1, 1, 3));
        assert!((first.rmse().unwrap() - 0.5).abs() < 1e-15);
        assert!((first.whole_square.mean().unwrap() - (0.25 + 25.0) / 2.0).abs() < 1e-12);
        assert_eq!((first.targets[1].failed, first.targets[2].failed, first.targets[2].square.count()), (1, 1, 0));
        let second = &scores.methods[1];
        assert!((second.rmse().unwrap() - 0.5).abs() < 1e-15, "sqrt((0.01 + 0.49) / 2)");
        assert!((second.common_square.mean().unwrap() - 0.01).abs() < 1e-15, "only `a` is common");
        assert_eq!(second.rmse_interval(), None, "one trial has no interval");
    }

    #[test]
    fn running_figures_are_those_of_the_textbook() {
        let mut running = Running::default();
        [2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0].into_iter().for_each(|v| running.add(v));
        assert_eq!(running.mean(), Some(5.0));
        assert!((running.deviation().unwrap() - (32.0_f64 / 7.0).sqrt()).abs() < 1e-15);
        // t(0.975, 7) = 2.364624.
        let (low, high) = running.interval(0.95).unwrap();
        let half = 2.364_624_25 * (32.0_f64 / 7.0 / 8.0).sqrt();
        assert!((high - 5.0 - half).abs() < 1e-6 && (5.0 - low - half).abs() < 1e-6);
    }
}
