//! What the gate compares: every point of a run, by method, with coordinates as a baseline file holds them.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::sync::Arc;

use calibench_model::Rejection;
use calibench_records::results::{LOST, MethodInfo, Outcome, PointResult, Trial};

/// Decimals of a coordinate, px: what a baseline file keeps, and what a table is rounded to, so that both compare alike.
pub const DECIMALS: usize = 9;

/// What the two coordinates of a measured point are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coordinates {
    /// Measured less true position (dx, dy), px.
    Errors,
    /// The measured position (x, y), px, of which no truth is known.
    Positions,
}

impl Coordinates {
    /// What a run yields: errors where the truth is known, positions elsewhere.
    pub const fn of(truth_is_known: bool) -> Self {
        if truth_is_known { Self::Errors } else { Self::Positions }
    }

    /// The names of the columns.
    pub const fn names(self) -> [&'static str; 2] {
        match self {
            Self::Errors => ["dx", "dy"],
            Self::Positions => ["x", "y"],
        }
    }
}

/// Which point of a run.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Place {
    /// The trial, from 0.
    pub trial: u64,
    /// The image.
    pub view: Arc<str>,
    /// The target.
    pub target: Arc<str>,
}

/// `view/target`, with the trial before it unless that is the first.
impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.trial > 0 {
            write!(f, "trial {} ", self.trial)?;
        }
        write!(f, "{}/{}", self.view, self.target)
    }
}

/// What became of a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Entry {
    /// Measured: its coordinates, px, as the table's [`Coordinates`] say.
    Measured([f64; 2]),
    /// Measured, and more than [`LOST`] px from the truth, or not a number.
    Lost([f64; 2]),
    /// Rejected by the operator.
    Rejected(Rejection),
}

impl Entry {
    /// The word in files.
    pub const fn status(&self) -> &'static str {
        match self {
            Self::Measured(_) => "measured",
            Self::Lost(_) => "lost",
            Self::Rejected(_) => "rejected",
        }
    }

    /// Status and reason in words.
    pub fn describe(&self) -> String {
        match self {
            Self::Rejected(why) => format!("rejected ({why})"),
            _ => self.status().to_owned(),
        }
    }

    /// The coordinates, lost or not.
    pub const fn coordinates(&self) -> Option<[f64; 2]> {
        match self {
            Self::Measured(at) | Self::Lost(at) => Some(*at),
            Self::Rejected(_) => None,
        }
    }

    /// The coordinates of a point that was measured and not lost.
    pub const fn kept(&self) -> Option<[f64; 2]> {
        match self {
            Self::Measured(at) => Some(*at),
            _ => None,
        }
    }
}

/// The points of one method.
#[derive(Clone, Debug, PartialEq)]
pub struct MethodTable {
    /// The method's version.
    pub version: Arc<str>,
    /// Why it measured nothing, if so.
    pub unavailable: Option<String>,
    /// Every point, in order.
    pub points: BTreeMap<Place, Entry>,
}

/// The points of one run of one scenario. Filled trial by trial; trials may come in any order.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// The scenario's name.
    pub scenario: String,
    /// The seed of the run.
    pub seed: u64,
    /// What the coordinates are.
    pub coordinates: Coordinates,
    labels: Vec<Arc<str>>,
    methods: BTreeMap<Arc<str>, MethodTable>,
}

impl Table {
    /// An empty table for `methods`, in the order in which the trials' points name them.
    pub fn new(scenario: impl Into<String>, seed: u64, coordinates: Coordinates, methods: &[MethodInfo]) -> Self {
        let mut table = Self { scenario: scenario.into(), seed, coordinates, labels: Vec::new(), methods: BTreeMap::new() };
        for info in methods {
            table.labels.push(info.label.clone());
            table.method_mut(&info.label, &info.version).unavailable.clone_from(&info.unavailable);
        }
        table
    }

    /// Adds a trial.
    ///
    /// # Panics
    /// When a point names a method that is not in the list given to [`Table::new`]: another run's trial.
    pub fn add(&mut self, trial: &Trial) {
        if !trial.calibrations.is_empty() {
            return self.add_adjusted(trial);
        }
        for point in &trial.points {
            let entry = entry(&point.outcome, self.coordinates);
            let PointResult { view, target, .. } = point;
            let place = Place { trial: trial.number, view: view.clone(), target: target.clone() };
            let method = self.methods.get_mut(&self.labels[point.method]).expect("every label has its points");
            method.points.insert(place, entry);
        }
    }

    /// Adds what became of the adjustments of a trial, in place of its points: the camera over the frame (px, 0), and the check points (RMSE_XY, RMSE_Z in mm).
    fn add_adjusted(&mut self, trial: &Trial) {
        for adjusted in trial.calibrations.iter().filter(|adjusted| adjusted.set == 0) {
            let method = self.methods.get_mut(&self.labels[adjusted.method]).expect("every label has its points");
            for (target, entry) in super::adjusted::entries(adjusted) {
                let place = Place { trial: trial.number, view: super::adjusted::VIEW.into(), target: target.into() };
                method.points.insert(place, entry);
            }
        }
    }

    /// The methods, by label.
    pub fn methods(&self) -> impl Iterator<Item = (&Arc<str>, &MethodTable)> {
        self.methods.iter()
    }

    /// The method of this label.
    pub fn method(&self, label: &str) -> Option<&MethodTable> {
        self.methods.get(label)
    }

    /// How many different trials there are.
    pub fn trials(&self) -> usize {
        let numbers = self.methods.values().flat_map(|method| method.points.keys().map(|place| place.trial));
        numbers.collect::<BTreeSet<u64>>().len()
    }

    pub(super) fn method_mut(&mut self, label: &Arc<str>, version: &Arc<str>) -> &mut MethodTable {
        let empty = || MethodTable { version: version.clone(), unavailable: None, points: BTreeMap::new() };
        self.methods.entry(label.clone()).or_insert_with(empty)
    }
}

impl MethodTable {
    /// How many points are measured, lost and rejected.
    pub fn counts(&self) -> [usize; 3] {
        let count = |status| self.points.values().filter(|entry| entry.status() == status).count();
        ["measured", "lost", "rejected"].map(count)
    }
}

fn entry(outcome: &Outcome, coordinates: Coordinates) -> Entry {
    match (outcome, coordinates) {
        (Outcome::Rejected(why), _) => Entry::Rejected(*why),
        (Outcome::Measured { position, .. }, Coordinates::Positions) => Entry::Measured([rounded(position.x), rounded(position.y)]),
        (Outcome::Measured { error, .. }, Coordinates::Errors) => {
            let (dx, dy) = error.unwrap_or((f64::NAN, f64::NAN));
            let at = [rounded(dx), rounded(dy)];
            if dx.hypot(dy) <= LOST { Entry::Measured(at) } else { Entry::Lost(at) }
        }
    }
}

/// The value that the file's decimals hold, without a negative zero.
pub(super) fn rounded(value: f64) -> f64 {
    let text = format!("{value:.DECIMALS$}");
    text.parse::<f64>().unwrap_or(f64::NAN) + 0.0
}
