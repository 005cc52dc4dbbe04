//! Sweeps over boards: what was found, how well it was measured, what the camera is worth.

use std::collections::{BTreeMap, HashMap};
use std::path::Path;
use std::sync::Arc;

use calibench_records::figures::Quantity;
use calibench_records::results::{Outcome, Trial};
use calibench_records::statistics::running::Running;

use crate::LoadError;
use crate::load::adjustments::Summaries;
use crate::sweep::{Gather, LoadedSweep, load_with};

/// The swept key that makes a sweep one over boards.
pub const BOARD: &str = "testfield.board";

/// A sweep over boards and at least one more key.
pub struct Comparison {
    /// Its records.
    pub sweep: LoadedSweep,
    /// What was found in each cell, by method.
    cells: Vec<BTreeMap<String, Found>>,
    /// The calibrations of each cell.
    cameras: Vec<Option<Summaries>>,
}

/// Points of a method in a cell.
#[derive(Clone, Debug, Default)]
pub struct Found {
    /// Points in view, all trials together.
    pub asked: u64,
    /// Those that were measured within a pixel.
    pub measured: u64,
    /// Those that were measured and are further off.
    pub lost: u64,
    /// Squared errors of the measured, both axes together, px^2.
    squares: f64,
    /// Squared bounds of the measured that have one, px^2.
    bounds: Running,
    /// Squared deviations from the mean at one point, of all points and both axes together, px^2, and how many of them are free.
    scatter: (f64, u64),
    points: Points,
}

/// Errors of each point over the trials, while they are read.
#[derive(Clone, Debug, Default)]
struct Points {
    /// In the order in which they came.
    errors: Vec<[Running; 2]>,
    places: HashMap<(Arc<str>, Arc<str>), usize>,
    /// The points by their places, and the place after that of the last: trials have them in the same order.
    keys: Vec<(Arc<str>, Arc<str>)>,
    next: usize,
}

impl Points {
    fn of(&mut self, view: &Arc<str>, target: &Arc<str>) -> &mut [Running; 2] {
        let is_next = self.keys.get(self.next).is_some_and(|(known, of)| *of == *target && *known == *view);
        let place = if is_next { self.next } else { *self.places.entry((view.clone(), target.clone())).or_insert(self.keys.len()) };
        if place == self.keys.len() {
            self.keys.push((view.clone(), target.clone()));
            self.errors.push(Default::default());
        }
        self.next = if place + 1 < self.keys.len() { place + 1 } else { 0 };
        &mut self.errors[place]
    }

    fn scatter(&self) -> (f64, u64) {
        let (mut sum, mut free) = (0.0, 0);
        for axis in self.errors.iter().flatten() {
            if let Some(deviation) = axis.deviation() {
                sum += deviation.powi(2) * (axis.count - 1) as f64;
                free += axis.count - 1;
            }
        }
        (sum, free)
    }
}

impl Gather for BTreeMap<String, Found> {
    fn add(&mut self, trial: &Trial, methods: &[String]) {
        for point in &trial.points {
            let Some(name) = methods.get(point.method) else { continue };
            if !self.contains_key(name) {
                self.insert(name.clone(), Found::default());
            }
            if let Some(found) = self.get_mut(name) {
                found.add((&point.view, &point.target), &point.outcome, point.bound);
            }
        }
    }

    fn end(&mut self) {
        self.values_mut().for_each(Found::end);
    }
}

impl Found {
    fn add(&mut self, (view, target): (&Arc<str>, &Arc<str>), outcome: &Outcome, bound: Option<f64>) {
        self.asked += 1;
        self.lost += u64::from(outcome.is_lost());
        let Some((dx, dy)) = outcome.kept_error() else { return };
        self.measured += 1;
        self.squares += dx * dx + dy * dy;
        bound.into_iter().for_each(|bound| self.bounds.add(bound * bound));
        let [x, y] = self.points.of(view, target);
        x.add(dx);
        y.add(dy);
    }

    /// After the last trial: of the points only what they have in common is kept.
    fn end(&mut self) {
        self.scatter = std::mem::take(&mut self.points).scatter();
    }

    /// Root mean square error of a coordinate, px.
    pub fn rmse(&self) -> Option<f64> {
        (self.measured > 0).then(|| (0.5 * self.squares / self.measured as f64).sqrt())
    }

    /// What trials differ by at one point, over the bound: the standard deviation, without what every trial has alike.
    pub fn scatter_to_bound(&self) -> Option<f64> {
        let (sum, free) = self.scatter;
        let (variance, bound) = (sum / free as f64, 0.5 * self.bounds.mean()?);
        (free > 0).then(|| (variance / bound).sqrt())
    }

    /// The share of the points in view that were measured.
    pub fn share(&self) -> f64 {
        self.measured as f64 / self.asked as f64
    }
}

/// A camera that a board gave.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Its distance from the true one over the frame, px: mean over the trials, and half of its 95 % interval.
    pub error: (f64, Option<f64>),
    /// What its covariance predicts of that, px.
    pub predicted: Option<f64>,
    /// Images that were left out, a trial.
    pub left_out: f64,
    /// Trials without a camera.
    pub failed: u64,
}

impl Camera {
    /// What it is worth, px: the larger of its error and what is predicted of it.
    pub fn worth(&self) -> f64 {
        self.predicted.map_or(self.error.0, |predicted| predicted.max(self.error.0))
    }
}

impl Comparison {
    /// Reads the records of sweep `name`, whose calibrations, `cameras`, were read before; `None` if there are none.
    ///
    /// # Errors
    /// Records that are not whole or not of this version.
    pub fn load(records: &Path, name: &str, cameras: Vec<Option<Summaries>>) -> Result<Option<Self>, LoadError> {
        Ok(load_with(records, name)?.map(|(sweep, cells)| Self { sweep, cells, cameras }))
    }

    /// The words of the boards.
    pub fn boards(&self) -> Vec<&str> {
        self.sweep.sweep.axes[0].values.iter().map(|value| value.text.as_str()).collect()
    }

    /// The values of the other key; of several keys what differs from the first value of each.
    pub fn values(&self) -> Vec<String> {
        let sweep = &self.sweep.sweep;
        let of = |cell: usize| {
            let values = sweep.values(cell);
            if let [_, value] = values[..] {
                return value.text.clone();
            }
            let changed = sweep.axes.iter().zip(&values).skip(1).filter(|(axis, value)| value.text != axis.values[0].text);
            let changed: Vec<String> = changed.map(|(axis, value)| format!("{} {}", axis.name, value.text)).collect();
            if changed.is_empty() { "nothing".into() } else { changed.join(", ") }
        };
        (0..self.cells.len() / sweep.axes[0].values.len()).map(of).collect()
    }

    fn cell(&self, board: usize, value: usize) -> usize {
        board * (self.cells.len() / self.sweep.sweep.axes[0].values.len()) + value
    }

    /// Whether several causes are swept, each with and without: an error budget.
    pub fn is_budget(&self) -> bool {
        self.sweep.sweep.axes.len() > 2
    }

    /// The method that measures a board best in a cell: the one with the least error, of those that measured most points.
    pub fn method(&self, board: usize, value: usize) -> Option<&str> {
        let cell = &self.cells[self.cell(board, value)];
        let most = cell.values().map(|found| found.measured).max().filter(|most| *most > 0)?;
        let near = |(_, found): &(&String, &Found)| 100 * found.measured >= 98 * most;
        let least = cell.iter().filter(near).min_by(|a, b| a.1.rmse().unwrap_or(f64::MAX).total_cmp(&b.1.rmse().unwrap_or(f64::MAX)));
        least.map(|(name, _)| name.as_str())
    }

    /// What a method found in a cell.
    pub fn found(&self, board: usize, value: usize, method: &str) -> Option<&Found> {
        self.cells[self.cell(board, value)].get(method)
    }

    /// The camera that a method gave in a cell.
    pub fn camera(&self, board: usize, value: usize, method: &str) -> Option<Camera> {
        let summaries = self.cameras[self.cell(board, value)].as_ref()?;
        let frame = summaries.get(method, Quantity::OverFrame)?;
        Some(Camera {
            error: (frame.value.mean()?, frame.value.half()),
            predicted: frame.sigma.mean(),
            left_out: summaries.left_out(method),
            failed: summaries.failures(method, None),
        })
    }

    /// How many trials a cell has.
    pub fn trials(&self, board: usize, value: usize) -> u64 {
        self.sweep.cells.get(self.cell(board, value)).map_or(0, |cell| cell.trials)
    }

    /// Whether cameras were calibrated.
    pub fn is_calibrated(&self) -> bool {
        self.cameras.iter().any(Option::is_some)
    }
}

/// The kind of a board by its word.
pub fn kind(word: &str) -> &str {
    word.split(':').next().unwrap_or(word)
}

#[cfg(test)]
mod tests {
    use calibench_model::PixelPoint;

    use super::*;

    /// Two points, three trials: what every trial has alike is no scatter, and what was far off no error.
    #[test]
    fn scatter_is_what_trials_differ_by_at_one_point() {
        let measured = |dx: f64, dy: f64| Outcome::Measured { position: PixelPoint::new(0.0, 0.0), error: Some((dx, dy)) };
        let mut found = Found::default();
        let (view, a, b): (Arc<str>, Arc<str>, Arc<str>) = ("v".into(), "a".into(), "b".into());
        for off in [-0.01, 0.0, 0.01] {
            found.add((&view, &a), &measured(0.1 + off, 0.1 - off), Some(0.02));
            found.add((&view, &b), &measured(-0.1 + off, 0.1 + off), Some(0.02));
        }
        found.add((&view, &b), &measured(3.0, 0.0), Some(0.02));
        found.end();
        assert!(found.points.errors.is_empty());
        assert_eq!((found.asked, found.measured, found.lost), (7, 6, 1));
        assert!((found.share() - 6.0 / 7.0).abs() < 1e-15);
        // A variance of 1e-4 an axis beside a bound of 2e-4.
        assert!((found.scatter_to_bound().unwrap() - 0.5_f64.sqrt()).abs() < 1e-12);
        let rmse = (0.01 + 1e-4 * 2.0 / 3.0_f64).sqrt();
        assert!((found.rmse().unwrap() - rmse).abs() < 1e-12, "{:?} {rmse}", found.rmse());
        assert_eq!(Found::default().rmse(), None);
        assert_eq!(kind("charuco:8x5:30:21:DICT_4X4_50"), "charuco");
    }
}
