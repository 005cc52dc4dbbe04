//! The records of a sweep, read cell by cell.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use calibench_records::description::{Description, Sweep};
use calibench_records::names::cell_folder;
use calibench_records::points::RecordHead;
use calibench_records::results::Trial;
use calibench_records::score::{Score, Scores};
use calibench_records::stored::read_points;
use rayon::prelude::*;

use crate::LoadError;
use crate::load::description::description;
use crate::load::groups::{groups, limited};

/// All that reports and plots need of a sweep. Its size does not grow with the number of trials.
pub struct LoadedSweep {
    /// The scenario's name.
    pub name: String,
    /// The scenario as it was run, its sweep apart.
    pub scenario: Description,
    /// Its sweep.
    pub sweep: Sweep,
    /// The methods without their swept parameters, in the order of the records.
    pub methods: Vec<LoadedMethod>,
    /// The cells, in their order.
    pub cells: Vec<LoadedCell>,
    /// The seed of the run.
    pub seed: u64,
    /// Where the cells lie.
    pub folder: PathBuf,
}

/// A method in all cells.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LoadedMethod {
    /// Its label without what is swept.
    pub name: String,
    /// Its version.
    pub version: Arc<str>,
    /// Why it measured nothing, if so.
    pub unavailable: Option<String>,
}

/// The figures of a cell.
pub struct LoadedCell {
    /// By method, in the order of [`LoadedSweep::methods`].
    pub scores: Vec<Score>,
    /// How many trials.
    pub trials: u64,
}

/// Reads the records of sweep `name` below the records folder; `None` if the scenario that was run has no sweep, or there are no records.
///
/// # Errors
/// Records that are not whole or not of this version.
pub fn load(records: &Path, name: &str) -> Result<Option<LoadedSweep>, LoadError> {
    Ok(load_with::<()>(records, name)?.map(|(loaded, _)| loaded))
}

/// What is gathered in a cell, beside its figures.
pub trait Gather: Default + Send {
    /// Adds a trial, whose points index the names of the methods.
    fn add(&mut self, trial: &Trial, methods: &[String]);

    /// After the last trial: what was needed on the way alone goes, since all cells are kept.
    fn end(&mut self) {}
}

impl Gather for () {
    fn add(&mut self, _: &Trial, _: &[String]) {}
}

/// As [`load`], with what is gathered in each cell.
///
/// # Errors
/// As [`load`].
pub fn load_with<T: Gather>(records: &Path, name: &str) -> Result<Option<(LoadedSweep, Vec<T>)>, LoadError> {
    let folder = records.join(name);
    let Some(mut scenario) = description(&folder, name)? else { return Ok(None) };
    let Some(sweep) = scenario.sweep.take() else { return Ok(None) };
    let read: Vec<_> = (0..sweep.cells.len()).into_par_iter().map(|index| read_cell(&folder, index, (name, &scenario, &sweep))).collect();
    let mut loaded = LoadedSweep { name: name.to_owned(), scenario, sweep, methods: Vec::new(), cells: Vec::new(), seed: 0, folder };
    let mut gathered = Vec::new();
    for cell in read {
        let (head, scores, found) = cell?;
        loaded.add(head, scores);
        gathered.push(found);
    }
    loaded.order();
    Ok(Some((loaded, gathered)))
}

/// What a cell's records hold: run and methods, figures, and what is gathered.
fn read_cell<T: Gather>(
    folder: &Path,
    index: usize,
    (name, scenario, sweep): (&str, &Description, &Sweep),
) -> Result<(RecordHead, Scores, T), LoadError> {
    let mut scores = Scores { groups: groups(scenario), ..Scores::default() };
    let (mut names, mut gathered) = (Vec::new(), T::default());
    let head = read_points(&cell_folder(folder, index), &sweep.run(name, index), |trial, methods| {
        // The methods of a file are named as they come.
        if names.len() != methods.len() {
            names = methods.iter().map(|info| sweep.method(&info.label)).collect();
            scores.limited = limited(methods);
        }
        gathered.add(&trial, &names);
        scores.add(&trial, |method| methods.get(method).is_some_and(|info| scenario.compares(&info.label)));
    })?;
    scores.methods.resize_with(head.methods.len(), Score::default);
    gathered.end();
    Ok((head, scores, gathered))
}

impl LoadedSweep {
    /// Whether no method measured anything.
    pub fn is_unavailable(&self) -> bool {
        self.methods.iter().all(|method| method.unavailable.is_some())
    }

    /// Whether its methods are adjusted alone and measure no point, or there are none.
    pub fn has_no_points(&self) -> bool {
        !self.is_unavailable() && self.cells.iter().flat_map(|cell| &cell.scores).all(|score| score.points() == 0)
    }

    /// The figures of method `method` in cell `cell`, if it measured there.
    pub fn score(&self, cell: usize, method: usize) -> Option<&Score> {
        self.cells.get(cell)?.scores.get(method).filter(|score| score.points() > 0)
    }

    fn add(&mut self, head: RecordHead, scores: Scores) {
        let mut cell = LoadedCell { scores: vec![Score::default(); self.methods.len()], trials: scores.trials };
        for (info, score) in head.methods.into_iter().zip(scores.methods) {
            let name = self.sweep.method(&info.label);
            let place = self.methods.iter().position(|method| method.name == name).unwrap_or_else(|| {
                self.methods.push(LoadedMethod { name, version: info.version, unavailable: info.unavailable });
                cell.scores.push(Score::default());
                self.methods.len() - 1
            });
            cell.scores[place] = score;
        }
        self.seed = head.run.seed;
        self.cells.push(cell);
    }

    /// The methods in the order of the scenario: records name those first that are unavailable.
    fn order(&mut self) {
        let known: Vec<String> = self.scenario.methods.iter().map(|label| self.sweep.method(label)).collect();
        let mut order: Vec<usize> = (0..self.methods.len()).collect();
        order.sort_by_key(|&index| known.iter().position(|name| *name == self.methods[index].name).unwrap_or(known.len()));
        self.methods = order.iter().map(|&index| self.methods[index].clone()).collect();
        for cell in &mut self.cells {
            cell.scores = order.iter().map(|&index| cell.scores.get_mut(index).map(std::mem::take).unwrap_or_default()).collect();
        }
    }
}
