//! Errors to figures, trial by trial, in memory that does not grow with their number.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::sync::Arc;

use statrs::distribution::{ContinuousCDF, StudentsT};

use crate::results::{Outcome, PointResult, Trial};

/// A mean over points that come in clusters: the points of one trial share their phase and noise.
///
/// The mean is pooled over all points; its standard error comes from the scatter between trials (the ratio estimator of cluster sampling, Cochran
/// 1977, Sect. 6.3 and 9A), and is right whatever the correlation within a trial and however many points a trial has. All are in the unit of the
/// values.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pooled {
    trials: u64,
    sum: f64,
    count: f64,
    /// Sums over trials of (sum in the trial)^2, sum * count, count^2.
    moments: [f64; 3],
}

impl Pooled {
    /// Adds a trial's values.
    pub fn add(&mut self, values: &[f64]) {
        if values.is_empty() {
            return;
        }
        let (sum, count) = (values.iter().sum::<f64>(), values.len() as f64);
        self.trials += 1;
        self.sum += sum;
        self.count += count;
        for (moment, value) in self.moments.iter_mut().zip([sum * sum, sum * count, count * count]) {
            *moment += value;
        }
    }

    /// How many values.
    pub fn count(&self) -> u64 {
        self.count as u64
    }

    /// Their mean; `None` of nothing.
    pub fn mean(&self) -> Option<f64> {
        (self.count > 0.0).then(|| self.sum / self.count)
    }

    /// The standard error of the mean; `None` of fewer than two trials.
    pub fn standard_error(&self) -> Option<f64> {
        let mean = self.mean().filter(|_| self.trials > 1)?;
        let [ss, sn, nn] = self.moments;
        let trials = self.trials as f64;
        let squares = (ss - 2.0 * mean * sn + mean * mean * nn).max(0.0);
        Some((squares * trials / (trials - 1.0)).sqrt() / self.count)
    }

    /// The standard deviation of the mean of a single trial; `None` of fewer than two trials.
    pub fn single(&self) -> Option<f64> {
        self.standard_error().map(|error| error * (self.trials as f64).sqrt())
    }

    /// The two-sided interval (lower and upper end) of the mean at `level` (0.95), by Student's t; `None` of fewer than two trials.
    pub fn interval(&self, level: f64) -> Option<(f64, f64)> {
        let (mean, error) = (self.mean()?, self.standard_error()?);
        let t = StudentsT::new(0.0, 1.0, (self.trials - 1) as f64).ok()?.inverse_cdf(f64::midpoint(1.0, level));
        Some((mean - t * error, mean + t * error))
    }
}

/// The errors of one method over some choice of points.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Errors {
    /// Error in x, px.
    pub dx: Pooled,
    /// Error in y, px.
    pub dy: Pooled,
    /// Squared 2D error, px^2.
    pub square: Pooled,
}

impl Errors {
    /// Adds a trial's errors (dx, dy), px.
    pub fn add(&mut self, errors: &[(f64, f64)]) {
        let of = |value: fn(&(f64, f64)) -> f64| errors.iter().map(value).collect::<Vec<f64>>();
        self.dx.add(&of(|e| e.0));
        self.dy.add(&of(|e| e.1));
        self.square.add(&of(|e| e.0 * e.0 + e.1 * e.1));
    }

    /// `sqrt(mean(dx^2 + dy^2))`, px.
    pub fn rmse(&self) -> Option<f64> {
        self.square.mean().map(f64::sqrt)
    }

    /// The 95 % interval (lower and upper end, px) of [`Self::rmse`] from the scatter between trials.
    pub fn rmse_interval(&self) -> Option<(f64, f64)> {
        self.square.interval(0.95).map(|(low, high)| (low.max(0.0).sqrt(), high.sqrt()))
    }

    /// The 2D scatter about the mean error, px: `sqrt(rmse^2 - bias^2)`, divided by n as the RMSE is.
    pub fn scatter(&self) -> Option<f64> {
        let (dx, dy, square) = (self.dx.mean()?, self.dy.mean()?, self.square.mean()?);
        Some((square - dx * dx - dy * dy).max(0.0).sqrt())
    }
}

/// The figures of one method on one scenario. Lost and rejected points are counted; lost ones take part only where it is said.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Score {
    /// Points measured within [`crate::results::LOST`] px of the truth, or, without truth, measured.
    pub measured: u64,
    /// Points measured further off.
    pub lost: u64,
    /// Points rejected, by reason.
    pub rejected: BTreeMap<&'static str, u64>,
    /// Errors of the points that were measured and not lost.
    pub kept: Errors,
    /// Errors of all measured points, lost ones among them.
    pub whole: Errors,
    /// Errors of the points that every operator that was to measure them did, and none lost.
    pub common: Errors,
    /// Squared errors of the kept points in units of their squared bound: numbers.
    pub to_bound: Pooled,
    /// Squared errors of the kept points in units of the variance that the method itself gives: numbers.
    pub to_predicted: Pooled,
    /// By target, or by group of targets, in the order in which they come.
    pub targets: Vec<TargetScore>,
}

/// `sqrt` of a pooled mean of squares with its interval at `level` (0.95), lower and upper end, in the root of the unit of the squares.
pub fn root(squares: &Pooled, level: f64) -> Option<(f64, Option<(f64, f64)>)> {
    let interval = squares.interval(level).map(|(low, high)| (low.max(0.0).sqrt(), high.sqrt()));
    Some((squares.mean()?.sqrt(), interval))
}

/// The figures of one method on one target.
#[derive(Clone, Debug, PartialEq)]
pub struct TargetScore {
    /// The target, or the group.
    pub target: Arc<str>,
    /// Errors of all its measured points, lost ones among them.
    pub whole: Errors,
    /// Points that were lost or rejected.
    pub failed: u64,
}

impl Score {
    /// All points that the method was given.
    pub fn points(&self) -> u64 {
        self.measured + self.lost + self.rejected.values().sum::<u64>()
    }

    /// The place of a target; `last` is that of the one before, after which it is looked for first.
    fn target(&mut self, target: &Arc<str>, last: usize) -> usize {
        let is_it =
            |place: &usize| self.targets.get(*place).is_some_and(|score| Arc::ptr_eq(&score.target, target) || score.target == *target);
        let found = [last, last + 1, 0].into_iter().find(is_it).or_else(|| self.targets.iter().position(|score| score.target == *target));
        found.unwrap_or_else(|| {
            self.targets.push(TargetScore { target: target.clone(), whole: Errors::default(), failed: 0 });
            self.targets.len() - 1
        })
    }

    /// Adds the points of a trial, each with its place among the trial's keys.
    fn add(&mut self, points: &[(usize, &PointResult)], keys: &Keys<'_>) {
        let mut errors: [Vec<(f64, f64)>; 3] = Default::default();
        let (mut to_bound, mut to_predicted) = (Vec::new(), Vec::new());
        let (mut targets, mut last): (Vec<Vec<(f64, f64)>>, usize) = (Vec::new(), 0);
        for &(key, point) in points {
            last = self.target(keys.groups[key], last);
            if last >= targets.len() {
                targets.resize_with(last + 1, Vec::new);
            }
            let is_lost = point.outcome.is_lost();
            match point.outcome {
                Outcome::Rejected(why) => *self.rejected.entry(why.name()).or_default() += 1,
                Outcome::Measured { .. } if is_lost => self.lost += 1,
                Outcome::Measured { .. } => self.measured += 1,
            }
            let target = &mut self.targets[last];
            let Outcome::Measured { error, .. } = point.outcome else {
                target.failed += 1;
                continue;
            };
            let Some(error) = error else { continue };
            target.failed += u64::from(is_lost);
            targets[last].push(error);
            errors[0].push(error);
            if !is_lost {
                errors[1].push(error);
                let square = error.0 * error.0 + error.1 * error.1;
                let in_units_of = |sigma: Option<f64>| sigma.filter(|sigma| *sigma > 0.0).map(|sigma| square / (sigma * sigma));
                to_bound.extend(in_units_of(point.bound));
                to_predicted.extend(in_units_of(point.predicted));
            }
            if keys.common[key] {
                errors[2].push(error);
            }
        }
        self.whole.add(&errors[0]);
        self.kept.add(&errors[1]);
        self.common.add(&errors[2]);
        self.to_bound.add(&to_bound);
        self.to_predicted.add(&to_predicted);
        self.targets.iter_mut().zip(&targets).for_each(|(target, errors)| target.whole.add(errors));
    }
}

/// The points of a trial, whichever method measured them: each view and target once.
struct Keys<'t> {
    /// What their targets are scored with.
    groups: Vec<&'t Arc<str>>,
    /// Whether every operator that was to measure it did.
    common: Vec<bool>,
}

/// The places of points among all views and targets. Every method has them in the same order: the one that is next is tried first.
#[derive(Default)]
struct Places<'t> {
    keys: Vec<(&'t Arc<str>, &'t Arc<str>)>,
    known: HashMap<(&'t str, &'t str), usize>,
    next: usize,
}

impl<'t> Places<'t> {
    fn of(&mut self, point: &'t PointResult) -> usize {
        let is_same = |a: &Arc<str>, b: &Arc<str>| Arc::ptr_eq(a, b) || a == b;
        let is_next = self.keys.get(self.next).is_some_and(|(view, target)| is_same(target, &point.target) && is_same(view, &point.view));
        let place = if is_next {
            self.next
        } else {
            let count = self.keys.len();
            *self.known.entry((&*point.view, &*point.target)).or_insert(count)
        };
        if place == self.keys.len() {
            self.keys.push((&point.view, &point.target));
        }
        self.next = place + 1;
        if self.next == self.keys.len() {
            self.next = 0;
        }
        place
    }
}

/// The group of each target that is scored as one of many, by the target's name.
pub type Groups = BTreeMap<Arc<str>, Arc<str>>;

/// The scores of all methods of a scenario.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scores {
    /// In the order of the methods.
    pub methods: Vec<Score>,
    /// How many trials.
    pub trials: u64,
    /// How targets are grouped; a target that is not named stands for itself.
    pub groups: Groups,
    /// The methods that are limited to kinds of targets: they have no rows of others.
    pub limited: BTreeSet<usize>,
}

impl Scores {
    /// No trial yet, for `methods` methods.
    pub fn new(methods: usize) -> Self {
        Self { methods: vec![Score::default(); methods], ..Self::default() }
    }

    /// Adds a trial. `operators` are the methods whose points decide what is common: those that look at the image.
    pub fn add(&mut self, trial: &Trial, operators: impl Fn(usize) -> bool) {
        self.trials += 1;
        // Records name a method when they first meet it.
        let most = trial.points.iter().map(|point| point.method + 1).max().unwrap_or(0);
        if most > self.methods.len() {
            self.methods.resize_with(most, Score::default);
        }
        let mut places = Places::default();
        let mut points: Vec<Vec<(usize, &PointResult)>> = vec![Vec::new(); self.methods.len()];
        trial.points.iter().for_each(|point| points[point.method].push((places.of(point), point)));
        let operators: Vec<bool> = (0..points.len()).map(|method| !points[method].is_empty() && operators(method)).collect();
        let common = self.common_points(&points, &operators, places.keys.len());
        let groups = places.keys.iter().map(|&(_, target)| self.groups.get(target).unwrap_or(target)).collect();
        let keys = Keys { groups, common };
        self.methods.iter_mut().zip(&points).for_each(|(score, points)| score.add(points, &keys));
    }

    /// The points that every operator of the trial measured and none lost. One that is limited is asked only for those of which it says something.
    fn common_points(&self, points: &[Vec<(usize, &PointResult)>], operators: &[bool], count: usize) -> Vec<bool> {
        let of_all = (0..points.len()).filter(|method| operators[*method] && !self.limited.contains(method)).count();
        let (mut asked, mut kept, mut seen) = (vec![of_all; count], vec![0; count], vec![false; count]);
        for (method, points) in points.iter().enumerate().filter(|(method, _)| operators[*method]) {
            let is_limited = self.limited.contains(&method);
            for &(key, point) in points {
                asked[key] += usize::from(is_limited);
                kept[key] += usize::from(point.outcome.kept_error().is_some());
                seen[key] = true;
            }
        }
        (0..count).map(|key| seen[key] && asked[key] == kept[key]).collect()
    }
}

#[cfg(test)]
mod tests;
