//! What calibrators made of classes, over all trials.

use std::collections::BTreeMap;

use calibench_records::league::{Answered, Class, ENDED, UNAVAILABLE, median};
use calibench_records::statistics::running::{Running, two_sided_95};
use calibench_records::statistics::{holm, paired_t};

/// How much worse than the best is as good, as a factor.
pub const AS_GOOD: f64 = 1.05;
/// How often one that is as good is called worse, in any cell of a class.
const ALPHA: f64 = 0.05;
/// Between which a mean square of errors in stated standard deviations is honest.
pub const HONEST: [f64; 2] = [0.85, 1.18];

/// Classes by calibrators.
pub struct League {
    /// In the order of their names.
    pub classes: Vec<Class>,
    /// In the order of their systems, then of their names.
    pub calibrators: Vec<Calibrator>,
    cells: BTreeMap<(usize, usize), Cell>,
}

/// A calibrator as its tables have it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Calibrator {
    /// Its name.
    pub name: String,
    /// Its system.
    pub system: String,
    /// The version that answered last.
    pub version: String,
}

/// What a calibrator says of its own precision, beside the truth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Honesty {
    /// The mean square of errors in stated standard deviations may be 1.
    Honest,
    /// Errors are smaller than stated.
    Cautious,
    /// Errors are larger than stated.
    Overconfident,
    /// Nothing is stated.
    Silent,
}

impl Honesty {
    /// In a word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Honest => "honest",
            Self::Cautious => "cautious",
            Self::Overconfident => "overconfident",
            Self::Silent => "states nothing",
        }
    }
}

/// A calibrator in a class.
#[derive(Clone, Debug, Default)]
pub struct Cell {
    /// Why it was not asked, if so.
    pub unavailable: Option<String>,
    /// How many trials there are.
    pub trials: usize,
    /// How many of them ended as calibrated, doubtful, refused, failed.
    pub ended: [usize; 4],
    /// Whether it was wrong and said nothing, trial by trial.
    silences: Vec<bool>,
    /// Distance from the true camera over the frame of each trial, px, and of photographs that of points from where they are predicted; `None` without a camera that
    /// can be compared.
    pub frames: Vec<Option<f64>>,
    /// Over the part where something was measured, px.
    covered: Vec<f64>,
    /// Of 100 mm, mm.
    lengths: Vec<f64>,
    /// Of residuals, as it states them, px.
    rms: Vec<f64>,
    /// Of photographs: points that are predicted from one side of the board, px.
    across: Vec<f64>,
    z2: Running,
    z2_parameters: Running,
    seconds: Vec<f64>,
    /// MB.
    pub peak: Option<f64>,
    /// What was said first, by how often.
    said: BTreeMap<String, usize>,
}

impl Cell {
    fn add(&mut self, row: &Answered) {
        if row.status == UNAVAILABLE {
            self.unavailable = Some(row.message.clone());
            return;
        }
        self.trials += 1;
        if let Some(place) = ENDED.iter().position(|status| *status == row.status) {
            self.ended[place] += 1;
        }
        self.silences.push(row.silent);
        self.frames.push(row.frame.or(row.held_out));
        self.across.extend(row.across);
        self.rms.extend(row.rms);
        self.covered.extend(row.covered);
        self.lengths.extend(row.length);
        row.z2.into_iter().for_each(|z2| self.z2.add(z2));
        row.z2_parameters.into_iter().for_each(|z2| self.z2_parameters.add(z2));
        self.seconds.extend(row.seconds.filter(|seconds| seconds.is_finite()));
        self.peak = row.peak_mb.map(|mb| self.peak.map_or(mb, |peak| peak.max(mb))).or(self.peak);
        if !row.message.is_empty() {
            *self.said.entry(row.message.clone()).or_default() += 1;
        }
    }

    /// How many trials were wrong and said nothing.
    pub fn silent(&self) -> usize {
        self.silent_of(self.trials)
    }

    /// How many of the first `trials` were.
    fn silent_of(&self, trials: usize) -> usize {
        self.silences.iter().take(trials).filter(|silent| **silent).count()
    }

    /// The median distance from the true camera over the frame, px, with its 95 % interval by order statistics; infinite where most trials have no camera.
    pub fn frame(&self) -> Option<(f64, [f64; 2])> {
        if self.trials == 0 {
            return None;
        }
        let mut all: Vec<f64> = self.frames.iter().map(|frame| frame.unwrap_or(f64::INFINITY)).collect();
        all.sort_by(f64::total_cmp);
        let n = all.len();
        let aside = (0.98 * (n as f64).sqrt()).ceil() as usize;
        let (low, high) = ((n / 2).saturating_sub(aside), (n / 2 + aside).min(n - 1));
        Some((median(self.frames.iter().copied())?, [all[low], all[high]]))
    }

    /// The median over the covered part, px.
    pub fn covered(&self) -> Option<f64> {
        median_of(&self.covered)
    }

    /// The median RMS of residuals, as it states them, px.
    pub fn rms(&self) -> Option<f64> {
        median_of(&self.rms)
    }

    /// The median of what is predicted from one side of the board, px.
    pub fn across(&self) -> Option<f64> {
        median_of(&self.across)
    }

    /// The median error of a length of 100 mm, mm.
    pub fn length(&self) -> Option<f64> {
        median_of(&self.lengths)
    }

    /// The median time, s.
    pub fn seconds(&self) -> Option<f64> {
        median_of(&self.seconds)
    }

    /// How many trials have a camera that cannot be compared: it does not picture what it should.
    pub fn incomparable(&self) -> usize {
        (self.ended[0] + self.ended[1]).saturating_sub(self.frames.iter().flatten().count())
    }

    /// What was said most often.
    pub fn said(&self) -> Option<(&str, usize)> {
        self.said.iter().max_by_key(|(_, count)| **count).map(|(text, count)| (text.as_str(), *count))
    }

    /// Mean square of errors in stated standard deviations, over the frame, else of parameters (`true`), with half its 95 % interval.
    pub fn z2(&self) -> Option<(f64, Option<f64>, bool)> {
        let of = |running: &Running, is_parameters| Some((running.mean()?, running.half(), is_parameters));
        of(&self.z2, false).or_else(|| of(&self.z2_parameters, true))
    }

    /// Whether what is stated is true.
    pub fn honesty(&self) -> Honesty {
        let Some((mean, half, _)) = self.z2() else { return Honesty::Silent };
        let half = half.unwrap_or(f64::INFINITY);
        match mean {
            mean if mean - half > HONEST[1] => Honesty::Overconfident,
            mean if mean + half < HONEST[0] => Honesty::Cautious,
            _ => Honesty::Honest,
        }
    }

    /// The share of `count` trials, %.
    pub fn percent(&self, count: usize) -> f64 {
        100.0 * count as f64 / self.trials.max(1) as f64
    }
}

fn median_of(values: &[f64]) -> Option<f64> {
    median(values.iter().copied().map(Some))
}

impl League {
    /// Of the classes and the tables by calibrator.
    pub fn new(mut classes: Vec<Class>, tables: &[(String, Vec<Answered>)]) -> Self {
        classes.retain(|class| tables.iter().any(|(_, rows)| rows.iter().any(|row| row.class == class.class)));
        classes.sort_by(|a, b| a.class.cmp(&b.class));
        let calibrator = |(name, rows): &(String, Vec<Answered>)| {
            let last = rows.last()?;
            Some(Calibrator { name: name.clone(), system: last.system.clone(), version: last.version.clone() })
        };
        let mut calibrators: Vec<Calibrator> = tables.iter().filter_map(calibrator).collect();
        calibrators.sort_by(|a, b| (&a.system, &a.name).cmp(&(&b.system, &b.name)));
        let mut cells: BTreeMap<(usize, usize), Cell> = BTreeMap::new();
        for (name, rows) in tables {
            let Some(calibrator) = calibrators.iter().position(|one| one.name == *name) else { continue };
            for row in rows {
                if let Some(class) = classes.iter().position(|class| class.class == row.class) {
                    cells.entry((class, calibrator)).or_default().add(row);
                }
            }
        }
        Self { classes, calibrators, cells }
    }

    /// That of the calibrators of one system alone.
    pub fn of_system(&self, system: &str) -> Self {
        let places: Vec<usize> = (0..self.calibrators.len()).filter(|place| self.calibrators[*place].system == system).collect();
        let cell =
            |(&(class, place), cell): (&(usize, usize), &Cell)| Some(((class, places.iter().position(|own| *own == place)?), cell.clone()));
        Self {
            classes: self.classes.clone(),
            calibrators: places.iter().map(|place| self.calibrators[*place].clone()).collect(),
            cells: self.cells.iter().filter_map(cell).collect(),
        }
    }

    /// A calibrator in a class, by their places; `None` where it was not asked.
    pub fn cell(&self, class: usize, calibrator: usize) -> Option<&Cell> {
        self.cells.get(&(class, calibrator))
    }

    /// The calibrators of a class that were asked, with their cells.
    pub fn asked(&self, class: usize) -> impl Iterator<Item = (usize, &Cell)> {
        (0..self.calibrators.len()).filter_map(move |one| Some((one, self.cell(class, one).filter(|cell| cell.trials > 0)?)))
    }

    /// The calibrator with the least median over the trials of a class that all were asked about.
    pub fn best(&self, class: usize) -> Option<usize> {
        let trials = self.asked(class).map(|(_, cell)| cell.trials).min()?;
        let median = |cell: &Cell| median(cell.frames[..trials].iter().copied()).unwrap_or(f64::INFINITY);
        let best = self.asked(class).min_by(|a, b| median(a.1).total_cmp(&median(b.1)))?;
        median(best.1).is_finite().then_some(best.0)
    }

    /// The error over the frame of a calibrator over that of another in the same trials, as a geometric mean with its 95 % interval; `None` where fewer than two trials
    /// have both cameras.
    pub fn ratio(&self, class: usize, [one, other]: [usize; 2]) -> Option<(f64, [f64; 2])> {
        let mut logs = Running::default();
        self.logs(class, [one, other]).into_iter().for_each(|log| logs.add(log));
        let half = logs.deviation()? * two_sided_95(logs.count)? / (logs.count as f64).sqrt();
        Some((logs.mean.exp(), [(logs.mean - half).exp(), (logs.mean + half).exp()]))
    }

    /// Logarithms of the errors of a calibrator over those of another in the same trials, where both have a camera.
    fn logs(&self, class: usize, places: [usize; 2]) -> Vec<f64> {
        let [Some(one), Some(other)] = places.map(|place| self.cell(class, place)) else { return Vec::new() };
        let log = |(one, other): (&Option<f64>, &Option<f64>)| Some(((*one)? / (*other)?).ln());
        one.frames.iter().zip(&other.frames).filter_map(log).filter(|log| log.is_finite()).collect()
    }

    /// The chance of logarithms as large as those of a calibrator over the best, if it were worse by no more than [`AS_GOOD`]; 0 where fewer than two trials have both
    /// cameras.
    fn no_worse(&self, class: usize, places: [usize; 2]) -> f64 {
        let beyond: Vec<f64> = self.logs(class, places).into_iter().map(|log| log - AS_GOOD.ln()).collect();
        if beyond.len() < 2 { 0.0 } else { paired_t(&beyond).growth }
    }

    /// The calibrators that are as good as the best of a class: not shown to be worse by more than [`AS_GOOD`] (Holm, [`ALPHA`]), with as many cameras and never wrong in
    /// silence, as far as both were asked about the same trials.
    pub fn as_good(&self, class: usize) -> Vec<usize> {
        let Some(best) = self.best(class) else { return Vec::new() };
        let Some(first) = self.cell(class, best) else { return Vec::new() };
        let cameras = |cell: &Cell, trials: usize| cell.frames.iter().take(trials).flatten().count();
        let others: Vec<usize> = self.asked(class).map(|(one, _)| one).filter(|one| *one != best).collect();
        let p = holm(&others.iter().map(|one| self.no_worse(class, [*one, best])).collect::<Vec<_>>());
        let is_as_good = |(one, cell): &(usize, &Cell)| {
            let near = others.iter().position(|other| other == one).is_none_or(|place| p[place] > ALPHA);
            let trials = cell.trials.min(first.trials);
            near && cell.silent_of(trials) == 0 && cameras(cell, trials) >= cameras(first, trials)
        };
        self.asked(class).filter(is_as_good).map(|(one, _)| one).collect()
    }
}
