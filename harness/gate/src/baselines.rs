//! The results of scenarios against the folder of what was blessed.

use std::io;
use std::path::{Path, PathBuf};

use calibench_files::at;

use super::Check;
use super::baseline::{baseline_path, figures_path, images_path, read_baseline};
use super::baseline_file::{BaselineError, is_baseline};
use super::cells::{Cells, Kept};
use super::figures::FigureSums;
use super::finding::{Finding, Verdict};
use super::index::{INDEX, Index, IndexError};
use super::moments::PointSums;
use super::sums::ImageSums;
use super::table::Table;
use super::verdicts::Verdicts;

/// What a scenario gave, by its own methods, seed and trials.
pub struct Results {
    /// The scenario's name.
    pub scenario: String,
    /// Whether nothing in it is random.
    pub deterministic: bool,
    /// What was measured.
    pub measured: Measured,
    /// The figures of its adjustments, if it makes any.
    pub figures: Option<Cells<FigureSums>>,
    /// The image points behind these, as far as the run keeps them.
    pub images: Option<Cells<ImageSums>>,
}

/// What a scenario measured.
pub enum Measured {
    /// Every point.
    Points(Table),
    /// Of a sweep, sums by cell.
    Sums(Cells<PointSums>),
    /// Nothing that the gate compares, and why.
    NotCompared(String),
}

impl Results {
    /// The points, if there are any.
    pub fn table(&self) -> Option<&Table> {
        match &self.measured {
            Measured::Points(table) => Some(table),
            Measured::Sums(_) | Measured::NotCompared(_) => None,
        }
    }

    /// The files that keep it: of its points, of its figures, of the image points behind these.
    pub(super) fn paths(&self, folder: &Path) -> [PathBuf; 3] {
        paths(folder, &self.scenario)
    }
}

/// The files that keep the baseline of `scenario`: of its points, of its figures, of the image points behind these.
fn paths(folder: &Path, scenario: &str) -> [PathBuf; 3] {
    [baseline_path(folder, scenario), figures_path(folder, scenario), images_path(folder, scenario)]
}

/// The folder of what was blessed, with its list.
#[derive(Debug)]
pub struct Baselines {
    pub(super) folder: PathBuf,
    pub(super) index: Index,
}

impl Baselines {
    /// Opens a folder; its files are read as they are compared.
    ///
    /// # Errors
    /// A list of what is blessed that is not there or means nothing.
    pub fn open(folder: &Path) -> Result<Self, IndexError> {
        Ok(Self { folder: folder.to_owned(), index: Index::read(folder)? })
    }

    /// Compares one scenario with its baseline; a baseline that is not what was blessed is a finding.
    pub fn compare(&self, now: &Results, check: &mut Check) {
        let (name, [points, figures, images]) = (now.scenario.as_str(), now.paths(&self.folder));
        let found = |verdict, metric, message: String| Finding::new(verdict, name, "all methods", metric, message);
        match &now.measured {
            Measured::Points(table) => {
                if let Some(baseline) = self.blessed(check, name, &points, read_baseline(&points, name)) {
                    check.compare(&baseline, table, now.deterministic);
                } else if !self.index.lists(&points) {
                    check.unblessed(table);
                }
            }
            Measured::Sums(sums) => {
                if let Some(baseline) = self.blessed(check, name, &points, Cells::read(&points, name)) {
                    check.compare_cells(&baseline, sums);
                } else if !self.index.lists(&points) {
                    check.note(found(Verdict::Unblessed, "cells", format!("not blessed yet: {} cells", sums.len())));
                }
            }
            Measured::NotCompared(why) => return check.note(found(Verdict::Informs, "untested", format!("not compared: {why}"))),
        }
        self.compare_kept(name, &figures, now.figures.as_ref(), ("figures", "figures of adjustments"), check);
        self.compare_kept(name, &images, now.images.as_ref(), ("images", "image points of adjustments"), check);
    }

    /// Compares what only some scenarios have, `what` as a metric and in words, with the file at `path`.
    fn compare_kept<T: Kept>(&self, name: &str, path: &Path, now: Option<&Cells<T>>, what: (&'static str, &str), check: &mut Check) {
        let found = |verdict, message: String| Finding::new(verdict, name, "all methods", what.0, message);
        match (self.blessed(check, name, path, Cells::<T>::read(path, name)), now) {
            (Some(baseline), Some(now)) => check.compare_cells(&baseline, now),
            (Some(_), None) => check.note(found(Verdict::Fails, format!("there are no {} any more", what.1))),
            (None, Some(_)) if !self.index.lists(path) => check.note(found(Verdict::Unblessed, format!("{}: not blessed yet", what.1))),
            (None, _) => {}
        }
    }

    /// Compares the verdicts of published cells; of some scenarios alone, not `whole`, those of the tables that stand on them.
    pub fn compare_verdicts(&self, now: &Verdicts, whole: bool, check: &mut Check) {
        let path = Verdicts::path(&self.folder);
        let Some(mut baseline) = self.blessed(check, "published tables", &path, Verdicts::read(&path)) else {
            if !now.0.is_empty() && !self.index.lists(&path) {
                let message = "verdicts of published cells: not blessed yet";
                check.note(Finding::new(Verdict::Unblessed, "published tables", "", "published cell", message));
            }
            return;
        };
        if !whole {
            baseline.0.retain(|[table, ..], _| now.0.keys().any(|[other, ..]| other == table));
        }
        check.verdicts(&baseline, now);
    }

    /// Notes every file of the folder, and of its list, that none of `all` scenarios makes, nor of those that are `left` to another check.
    ///
    /// # Errors
    /// A folder that cannot be read.
    pub fn vanished(&self, all: &[Results], left: &[String], check: &mut Check) -> io::Result<()> {
        let mut known: Vec<PathBuf> = all.iter().flat_map(|one| one.paths(&self.folder)).chain([Verdicts::path(&self.folder)]).collect();
        known.extend(left.iter().flat_map(|name| paths(&self.folder, name)));
        for path in self.files()?.into_iter().filter(|path| !known.contains(path)) {
            let name = path.file_stem().unwrap_or_default().to_string_lossy().replace("--", "/");
            let message = if self.index.lists(&path) {
                "the scenario is gone, its baseline is blessed: restore it, or `calibench bless`".to_owned()
            } else {
                format!("there is no such scenario, and its baseline is not in {INDEX}: remove {}", path.display())
            };
            check.note(Finding::new(Verdict::Fails, &name, "all methods", "scenario", message));
        }
        Ok(())
    }

    /// Every baseline that is listed, or that lies in the folder; what else somebody keeps there is theirs.
    ///
    /// # Errors
    /// A folder that cannot be read.
    pub(super) fn files(&self) -> io::Result<Vec<PathBuf>> {
        let there = match std::fs::read_dir(&self.folder) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => Vec::new(),
            entries => {
                let paths = entries.and_then(|entries| entries.map(|entry| Ok(entry?.path())).collect::<io::Result<Vec<PathBuf>>>());
                paths.map_err(|error| at(&self.folder, &error))?
            }
        };
        let mut files: Vec<PathBuf> = there.into_iter().filter(|path| is_baseline(path)).collect();
        files.extend(self.index.files.keys().map(|file| self.folder.join(file)));
        files.sort();
        files.dedup();
        Ok(files)
    }

    /// The content of a file if it is there; what is wrong with it is noted.
    fn blessed<T>(&self, check: &mut Check, name: &str, path: &Path, read: Result<Option<(T, String)>, BaselineError>) -> Option<T> {
        let fails = |why: String| Finding::new(Verdict::Fails, name, "all methods", "baseline", why);
        let found = match read {
            Ok(found) => found,
            Err(error) => {
                check.note(fails(error.to_string()));
                return None;
            }
        };
        let checksum = found.as_ref().map(|(_, sum)| sum.as_str());
        if let Some(why) = self.index.mistake(path, checksum) {
            check.note(fails(why));
        }
        found.map(|(content, _)| content)
    }
}
