//! What the gate compares: every point of a run, by method, with coordinates as a baseline file holds them.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use calibench_records::figures::Kind;
use calibench_records::results::{MethodInfo, Trial};

use super::adjusted::{self, FigureKey, Numbers};
use super::point_entry::{Coordinates, Entry, Place};

/// The points of one method.
#[derive(Clone, Debug, PartialEq)]
pub struct MethodTable {
    /// The method's version.
    pub version: Arc<str>,
    /// All its parameters with their values, those at their default among them; empty where they are not known.
    pub settings: String,
    /// The library on which its numbers depend, with the version that this machine has; empty where there is none.
    pub library: String,
    /// Why it measured nothing, if so.
    pub unavailable: Option<String>,
    /// Every point, in order; of a method whose points are adjusted, what came of its adjustments.
    pub points: BTreeMap<Place, Entry>,
    /// The image points behind its adjustments, as far as a run keeps them: those of the first trial, or of all.
    pub images: BTreeMap<Place, Entry>,
    /// Every figure of its adjustments, by trial; residuals of single points are left out.
    pub figures: BTreeMap<FigureKey, BTreeMap<u64, Numbers>>,
}

/// The libraries on which the numbers of the method `label` depend, with their versions: OpenCV on that of its methods, its solver with the linear algebra under it,
/// and the detector, with its name and version, that gave the approximate positions.
pub fn library(label: &str, version: &str, detector: Option<&(String, String)>) -> String {
    let own = label.starts_with("opencv").then(|| format!("OpenCV {version}"));
    own.into_iter().chain(solver(version)).chain(detector.map(|(name, version)| format!("{name} {version}"))).collect::<Vec<_>>().join(", ")
}

/// OpenCV's solver with the linear algebra under it, where a version names it among others.
fn solver(version: &str) -> Option<String> {
    version.split(", ").find(|part| part.starts_with("calibrateCamera ")).map(str::to_owned)
}

/// Whether the numbers depend on another library, or version of it, than `blessed`; where one of them is not known they do not.
pub(super) fn is_foreign(blessed: &str, now: &str) -> bool {
    !blessed.is_empty() && !now.is_empty() && blessed != now
}

/// The points of one run of one scenario. Filled trial by trial; trials may come in any order.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// The scenario's name.
    pub scenario: String,
    /// The fingerprint of the scenario's text, where it is known.
    pub text: String,
    /// The seed of the run.
    pub seed: u64,
    /// What the coordinates are.
    pub coordinates: Coordinates,
    labels: Vec<Arc<str>>,
    methods: BTreeMap<Arc<str>, MethodTable>,
}

/// The fingerprint of a scenario's text: the first 16 bytes of its BLAKE3 hash, in hexadecimal, with line ends of any system.
pub fn fingerprint(text: &str) -> String {
    let mut hasher = blake3::Hasher::new();
    for line in text.lines() {
        hasher.update(line.as_bytes());
        hasher.update(b"\n");
    }
    hasher.finalize().to_hex()[..32].to_owned()
}

impl Table {
    /// An empty table for `methods`, in the order in which the trials' points name them.
    pub fn new(scenario: impl Into<String>, seed: u64, coordinates: Coordinates, methods: &[MethodInfo]) -> Self {
        let mut table =
            Self { scenario: scenario.into(), text: String::new(), seed, coordinates, labels: Vec::new(), methods: BTreeMap::new() };
        table.name_methods(methods);
        table
    }

    /// Makes sure that every one of `methods` has its place: records name a method when they first meet it.
    pub fn name_methods(&mut self, methods: &[MethodInfo]) {
        for info in methods.iter().skip(self.labels.len()) {
            self.labels.push(info.label.clone());
            self.method_mut(&info.label, &info.version).unavailable.clone_from(&info.unavailable);
        }
    }

    /// States all parameters of the method `label`, and the library on which its numbers depend.
    pub fn describe(&mut self, label: &str, settings: String, library: String) {
        if let Some(method) = self.methods.get_mut(label) {
            (method.settings, method.library) = (settings, library);
        }
    }

    /// Adds a trial.
    ///
    /// # Panics
    /// When a point names a method that is not in the list given to [`Table::new`]: another run's trial.
    pub fn add(&mut self, trial: &Trial) {
        self.add_adjusted(trial);
        let are_adjusted = !trial.calibrations.iter().all(|one| one.kind() == Some(Kind::Detection));
        self.add_points(trial, are_adjusted);
    }

    /// Adds the points of a trial, as those behind adjustments if they `are_adjusted`.
    pub(super) fn add_points(&mut self, trial: &Trial, are_adjusted: bool) {
        for point in &trial.points {
            let place = Place { trial: trial.number, view: point.view.clone(), target: point.target.clone() };
            let entry = Entry::of(point, self.coordinates);
            let method = self.of_index(point.method);
            if are_adjusted { &mut method.images } else { &mut method.points }.insert(place, entry);
        }
    }

    /// Adds the results of the adjustments of a trial, in place of its points: the camera over the frame (px, 0), the check points
    /// (RMSE_XY, RMSE_Z in mm), and every figure with its standard deviation. Counts of detections stand beside the points.
    fn add_adjusted(&mut self, trial: &Trial) {
        for adjusted in &trial.calibrations {
            let method = self.of_index(adjusted.method);
            for (key, numbers) in adjusted::figures(adjusted) {
                method.figures.entry(key).or_default().insert(trial.number, numbers);
            }
            for (target, entry) in adjusted::entries(adjusted) {
                let place = Place { trial: trial.number, view: adjusted::VIEW.into(), target };
                method.points.insert(place, entry);
            }
        }
    }

    fn of_index(&mut self, method: usize) -> &mut MethodTable {
        self.methods.get_mut(&self.labels[method]).expect("every label has its points")
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

    /// How many points all methods have.
    pub fn points(&self) -> usize {
        self.methods.values().map(|method| method.points.len()).sum()
    }

    /// The same run with the method `label` alone, its results replaced by `other` if there are any.
    #[must_use]
    pub fn only(&self, label: &str, other: Option<MethodTable>) -> Self {
        let kept = self.methods.get_key_value(label).map(|(label, method)| (label.clone(), other.unwrap_or_else(|| method.clone())));
        Self { scenario: self.scenario.clone(), text: self.text.clone(), labels: Vec::new(), methods: kept.into_iter().collect(), ..*self }
    }

    /// The method of this label, new if there was none.
    pub fn method_mut(&mut self, label: &Arc<str>, version: &Arc<str>) -> &mut MethodTable {
        self.methods.entry(label.clone()).or_insert_with(|| MethodTable::new(version.clone()))
    }
}

impl MethodTable {
    /// A method without a point.
    pub fn new(version: Arc<str>) -> Self {
        let (points, images, figures) = (BTreeMap::new(), BTreeMap::new(), BTreeMap::new());
        let library = solver(&version).unwrap_or_default();
        Self { version, settings: String::new(), library, unavailable: None, points, images, figures }
    }

    /// How many points are measured, lost and rejected.
    pub fn counts(&self) -> [usize; 3] {
        let count = |status| self.points.values().filter(|entry| entry.status() == status).count();
        ["measured", "lost", "rejected"].map(count)
    }
}
