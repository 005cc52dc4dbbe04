//! What is kept of runs whose rows would be too many: something small for each method in each cell of a sweep.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use super::baseline_file::{self, BaselineError, Head, HeadMethod, Kind, Row};
use super::finding::{Finding, Verdict};
use super::point_entry::Coordinates;
use super::table::{MethodTable, Table, is_foreign};

/// What a file can keep of a method in a cell.
pub trait Kept: Default + Sized {
    /// What the rows are.
    const KIND: Kind;
    /// The columns after `cell` and `method`.
    const COLUMNS: &'static [&'static str];
    /// What is kept of a method.
    fn of(method: &MethodTable) -> Self;
    /// As rows, in order, without cell and method.
    fn rows(&self) -> Vec<Vec<String>>;
    /// Adds a row; the columns start at 2.
    ///
    /// # Errors
    /// A cell that means nothing.
    fn add(&mut self, row: &Row<'_>) -> Result<(), BaselineError>;
    /// What differs between `self`, which was blessed, and `now`; `finding` makes one about this method and cell.
    fn compare(&self, now: &Self, finding: &dyn Fn(Verdict, &'static str, String) -> Finding) -> Vec<Finding>;
    /// How many points or figures.
    fn count(&self) -> usize;
}

/// What identifies a method.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Described {
    version: Arc<str>,
    settings: String,
    library: String,
}

/// A scenario, cell by cell. One without a sweep has one cell, whose label is empty.
#[derive(Clone, Debug, PartialEq)]
pub struct Cells<T> {
    /// The scenario's name.
    pub scenario: String,
    text: String,
    seed: u64,
    coordinates: Coordinates,
    labels: Vec<String>,
    methods: BTreeMap<Arc<str>, Described>,
    values: Vec<BTreeMap<Arc<str>, T>>,
}

impl<T: Kept> Cells<T> {
    /// No cell yet.
    pub fn new(scenario: &str, text: &str, seed: u64, coordinates: Coordinates) -> Self {
        let (scenario, text) = (scenario.to_owned(), text.to_owned());
        Self { scenario, text, seed, coordinates, labels: Vec::new(), methods: BTreeMap::new(), values: Vec::new() }
    }

    /// Adds the run of the next cell.
    pub fn add(&mut self, label: &str, table: &Table) {
        let mut values = BTreeMap::new();
        for (name, method) in table.methods().filter(|(_, method)| method.unavailable.is_none()) {
            let (version, settings, library) = (method.version.clone(), method.settings.clone(), method.library.clone());
            self.methods.entry(name.clone()).or_insert(Described { version, settings, library });
            values.insert(name.clone(), T::of(method));
        }
        self.labels.push(label.to_owned());
        self.values.push(values);
    }

    /// What is kept of every method of every cell.
    pub fn values(&self) -> impl Iterator<Item = &T> {
        self.values.iter().flat_map(BTreeMap::values)
    }

    /// How many cells.
    pub fn len(&self) -> usize {
        self.labels.len()
    }

    /// Whether nothing is kept at all.
    pub fn is_empty(&self) -> bool {
        self.values().all(|value| value.count() == 0)
    }

    /// How many methods of all cells, and how many points or figures these have.
    pub fn counts(&self) -> [usize; 2] {
        [self.values().count(), self.values().map(Kept::count).sum()]
    }

    /// Writes the file, whole or not at all, and returns its checksum.
    ///
    /// # Errors
    /// What the file system refuses.
    pub fn write(&self, path: &Path) -> Result<String, BaselineError> {
        let mut rows: Vec<Vec<String>> = Vec::new();
        let mut counts = vec![0; self.methods.len()];
        for (cell, values) in self.values.iter().enumerate() {
            for (place, label) in self.methods.keys().enumerate() {
                for row in values.get(label).map(Kept::rows).unwrap_or_default() {
                    counts[place] += 1;
                    rows.push([(cell + 1).to_string(), (place + 1).to_string()].into_iter().chain(row).collect());
                }
            }
        }
        let mut head = Head::new(T::KIND, &self.scenario, &self.text, self.seed, self.coordinates.name(), self.labels.clone());
        let method = |((label, d), rows): ((&Arc<str>, &Described), u64)| HeadMethod {
            label: label.to_string(),
            version: d.version.to_string(),
            settings: d.settings.clone(),
            library: d.library.clone(),
            rows,
        };
        head.method = self.methods.iter().zip(counts).map(method).collect();
        baseline_file::write(path, &head, &Self::columns(), rows.into_iter())
    }

    /// Reads the file of `scenario` with its checksum; `None` when there is none.
    ///
    /// # Errors
    /// A file that is not to the letter what was written.
    pub fn read(path: &Path, scenario: &str) -> Result<Option<(Self, String)>, BaselineError> {
        let Some(sheet) = baseline_file::read(path, T::KIND, &Self::columns())? else { return Ok(None) };
        let (head, damaged) = (&sheet.head, |problem| BaselineError::Damaged { path: path.to_owned(), problem });
        if head.scenario != scenario {
            return Err(damaged(format!("is the baseline of `{}`, expected that of `{scenario}`", head.scenario)));
        }
        let seed = head.seed.parse().map_err(|_| damaged(format!("its head says seed {}, expected a whole number", head.seed)))?;
        let mut all = Self::new(scenario, &head.text, seed, Coordinates::of(head.coordinates == Coordinates::Errors.name()));
        all.labels.clone_from(&head.cells);
        all.values.resize_with(head.cells.len(), BTreeMap::new);
        let labels: Vec<Arc<str>> = head.method.iter().map(|method| method.label.as_str().into()).collect();
        for (method, label) in head.method.iter().zip(&labels) {
            let (settings, library) = (method.settings.clone(), method.library.clone());
            all.methods.insert(label.clone(), Described { version: method.version.as_str().into(), settings, library });
        }
        for row in sheet.rows() {
            let (cell, method) = (row.place(0, all.values.len())?, row.place(1, labels.len())?);
            all.values[cell].entry(labels[method].clone()).or_default().add(&row)?;
        }
        sheet.verify()?;
        Ok(Some((all, sheet.checksum)))
    }

    fn columns() -> Vec<&'static str> {
        ["cell", "method"].into_iter().chain(T::COLUMNS.iter().copied()).collect()
    }

    /// Every method of every cell beside what was blessed: what is missing, what changed, and whether it is worse.
    pub fn compare(&self, now: &Self) -> Vec<Finding> {
        let mut findings = Vec::new();
        let mut changed = false;
        let missing = |name: &str, method: &str, what: &str| Finding::new(Verdict::Fails, name, method, "cell", what);
        for (label, blessed) in self.labels.iter().zip(&self.values) {
            let name = self.name(label);
            let Some(place) = now.labels.iter().position(|other| other == label) else {
                findings.push(missing(&name, "all methods", "the cell is missing"));
                continue;
            };
            for (method, old) in blessed {
                let Some(new) = now.values[place].get(method) else {
                    findings.push(missing(&name, method, "the method is missing"));
                    continue;
                };
                let foreign = is_foreign(&self.methods[method].library, &now.methods[method].library);
                let finding = |verdict: Verdict, metric: &'static str, message: String| {
                    let verdict = if foreign && verdict == Verdict::Changed { Verdict::Informs } else { verdict };
                    Finding::new(verdict, &name, method, metric, message)
                };
                let found = old.compare(new, &finding);
                changed |= !found.is_empty();
                findings.extend(found);
            }
        }
        findings.extend(self.identity(now, changed));
        findings.extend(self.unblessed(now));
        findings
    }

    fn name(&self, label: &str) -> String {
        if label.is_empty() { self.scenario.clone() } else { format!("{}@{label}", self.scenario) }
    }

    /// Text, seed, versions and parameters.
    fn identity(&self, now: &Self, changed: bool) -> Vec<Finding> {
        let mut findings = Vec::new();
        let all = |verdict, metric, message: &str| Finding::new(verdict, &self.scenario, "all methods", metric, message);
        if self.seed != now.seed {
            findings.push(all(Verdict::Fails, "seed", &format!("the seed is {} and was {}: bless anew", now.seed, self.seed)));
        }
        if !self.text.is_empty() && !now.text.is_empty() && self.text != now.text {
            findings.push(if changed {
                all(
                    Verdict::Fails,
                    "scenario",
                    "the scenario was edited since it was blessed, and its numbers are others: look, then bless",
                )
            } else {
                all(Verdict::Changed, "scenario", "the scenario's text was edited since it was blessed; the numbers are the same: bless")
            });
        }
        for (label, old) in &self.methods {
            let Some(new) = now.methods.get(label) else { continue };
            let verdict = if is_foreign(&old.library, &new.library) { Verdict::Informs } else { Verdict::Changed };
            if old.version != new.version {
                let message = format!("the version changed from {} to {}: look, then bless", old.version, new.version);
                findings.push(Finding::new(verdict, &self.scenario, label, "version", message));
            }
            if !old.settings.is_empty() && !new.settings.is_empty() && old.settings != new.settings {
                let message = format!("the parameters were {} and are {}: look, then bless", old.settings, new.settings);
                findings.push(Finding::new(Verdict::Changed, &self.scenario, label, "parameters", message));
            }
        }
        findings
    }

    /// Cells and methods that were not blessed.
    fn unblessed(&self, now: &Self) -> Vec<Finding> {
        let mut findings = Vec::new();
        for (label, values) in now.labels.iter().zip(&now.values) {
            let blessed = self.labels.iter().position(|other| other == label).map(|place| &self.values[place]);
            // A method that is idle in a cell has nothing there, and no row in the file.
            let busy = values.iter().filter(|(_, kept)| kept.count() > 0).map(|(method, _)| method);
            for method in busy.filter(|method| !blessed.is_some_and(|cell| cell.contains_key(*method))) {
                findings.push(Finding::new(Verdict::Unblessed, &self.name(label), method, "cell", "not blessed yet"));
            }
        }
        findings
    }
}
