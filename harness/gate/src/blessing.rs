//! Today's results as the baselines to come: what would change, and how it is written.

use std::io;
use std::path::{Path, PathBuf};

use calibench_files::at;
use calibench_files::atomic::write_atomically;

use super::accepted_worse::worse_than;
use super::baseline::{read_baseline, write_baseline};
use super::baseline_file::BaselineError;
use super::baselines::{Baselines, Measured, Results};
use super::ceilings::CEILINGS;
use super::cells::{Cells, Kept};
use super::index::{INDEX, Index, IndexError};
use super::table::Table;
use super::verdicts::Verdicts;

/// Writes a baseline to a path; returns its checksum.
type Writer<'a> = Box<dyn Fn(&Path) -> Result<String, BaselineError> + 'a>;

/// A file that is to be written.
pub struct Change<'a> {
    /// The file.
    pub path: PathBuf,
    /// What changes in it and what gets worse: lines of text.
    pub news: String,
    write: Writer<'a>,
}

impl Baselines {
    /// Opens a folder in which nothing may be blessed yet.
    ///
    /// # Errors
    /// A list of what is blessed that cannot be read or means nothing.
    pub fn open_or_new(folder: &Path) -> Result<Self, IndexError> {
        match Self::open(folder) {
            Err(IndexError::Missing(_)) => Ok(Self { folder: folder.to_owned(), index: Index::default() }),
            other => other,
        }
    }

    /// Whether nothing was ever blessed here.
    pub fn is_new(&self) -> bool {
        !self.folder.join(INDEX).exists()
    }

    /// The files of a scenario that are not as they are blessed. A baseline that is damaged, or of an older version, is replaced as if there were
    /// none.
    pub fn changes<'a>(&self, now: &'a Results) -> Vec<Change<'a>> {
        let (name, [points, figures, images]) = (now.scenario.as_str(), now.paths(&self.folder));
        let mut changes = match &now.measured {
            Measured::NotCompared(_) => return Vec::new(),
            Measured::Points(table) => {
                let old = self.listed(read_baseline(&points, name), &points);
                let changed = !old.as_ref().is_some_and(|old| same(old, table));
                let news = || news(name, old.as_ref(), table);
                Vec::from_iter(changed.then(|| Change { path: points, news: news(), write: Box::new(|path| write_baseline(path, table)) }))
            }
            Measured::Sums(sums) => Vec::from_iter(self.cells(name, points, sums)),
        };
        changes.extend(now.figures.as_ref().and_then(|now| self.cells(name, figures, now)));
        changes.extend(now.images.as_ref().and_then(|now| self.cells(name, images, now)));
        changes
    }

    fn cells<'a, T: Kept>(&self, name: &str, path: PathBuf, now: &'a Cells<T>) -> Option<Change<'a>> {
        let news = match self.listed(Cells::<T>::read(&path, name), &path) {
            Some(old) => {
                let findings = old.compare(now);
                if findings.is_empty() {
                    return None;
                }
                let worse = findings.iter().filter(|finding| finding.fails());
                told(name, &worse.map(|f| format!("{}: {}: {}", f.scenario, f.method, f.message)).collect::<Vec<_>>())
            }
            None => format!("{name}: new baseline of {} points or figures in {} cells\n", now.counts()[1], now.len()),
        };
        Some(Change { path, news, write: Box::new(|path| now.write(path)) })
    }

    /// The verdicts of published cells, if they are not as they are blessed; of some scenarios alone, not `whole`, the others stay.
    pub fn changed_verdicts<'a>(&self, now: &'a mut Verdicts, whole: bool) -> Option<Change<'a>> {
        let path = Verdicts::path(&self.folder);
        let old = self.listed(Verdicts::read(&path), &path);
        for (cell, word) in old.iter().filter(|_| !whole).flat_map(|old| &old.0) {
            now.0.entry(cell.clone()).or_insert_with(|| word.clone());
        }
        // Where none is left the file goes.
        if now.0.is_empty() || old.as_ref() == Some(&*now) {
            return None;
        }
        let mut news = format!("published tables: verdicts of {} cells\n", now.0.len());
        for finding in old.map(|old| old.compare(now)).unwrap_or_default().iter().filter(|finding| finding.fails()) {
            news += &format!("    {} {}: {}\n", finding.scenario, finding.target.as_deref().unwrap_or_default(), finding.message);
        }
        Some(Change { path, news, write: Box::new(|path| now.write(path)) })
    }

    /// The files that `all` scenarios, or the published tables, do not make any more. Of some scenarios alone, not `whole`, their own files; else every
    /// other baseline that is listed or lies in the folder.
    ///
    /// # Errors
    /// A folder that cannot be read.
    pub fn gone(&self, all: &[Results], verdicts: &Verdicts, whole: bool) -> io::Result<Vec<PathBuf>> {
        let (mut made, mut own) = (Vec::new(), Vec::new());
        if !verdicts.0.is_empty() {
            made.push(Verdicts::path(&self.folder));
        }
        for one in all {
            let [points, figures, images] = one.paths(&self.folder);
            let unknown = matches!(one.measured, Measured::NotCompared(_));
            own.extend([points.clone(), figures.clone(), images.clone()]);
            made.push(points);
            made.extend(Some(figures).filter(|_| one.figures.is_some() || unknown));
            made.extend(Some(images).filter(|_| one.images.is_some() || unknown));
        }
        let mut gone = self.files()?;
        gone.retain(|path| !made.contains(path) && (whole || own.contains(path)));
        Ok(gone)
    }

    /// Writes the changes and removes what is `gone`; `written` hears of every file. The list comes last.
    ///
    /// # Errors
    /// What the file system refuses.
    pub fn bless(mut self, changes: &[Change<'_>], gone: &[PathBuf], written: &mut dyn FnMut(&Path)) -> Result<(), BlessError> {
        std::fs::create_dir_all(&self.folder).map_err(|error| at(&self.folder, &error))?;
        let ceilings = self.folder.join(CEILINGS);
        // A check asks for the file, which is written by hand: who begins has none yet.
        if self.is_new() && !ceilings.exists() {
            write_atomically(&ceilings, |_| Ok::<(), io::Error>(()))?;
        }
        for Change { path, write, .. } in changes {
            self.index.bless(path, write(path)?);
            written(path);
        }
        for path in gone {
            self.index.forget(path);
            match std::fs::remove_file(path) {
                Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(at(path, &error).into()),
                _ => {}
            }
        }
        Ok(self.index.write(&self.folder)?)
    }

    /// The content of a file that is whole and listed.
    fn listed<T>(&self, read: Result<Option<(T, String)>, BaselineError>, path: &Path) -> Option<T> {
        let (content, sum) = read.ok().flatten()?;
        self.index.mistake(path, Some(&sum)).is_none().then_some(content)
    }
}

/// Why baselines cannot be blessed.
#[derive(Debug, thiserror::Error)]
pub enum BlessError {
    /// The folder, or a file that goes.
    #[error(transparent)]
    Folder(#[from] io::Error),
    /// A baseline.
    #[error(transparent)]
    Baseline(#[from] BaselineError),
    /// The list of what is blessed.
    #[error(transparent)]
    Index(#[from] IndexError),
}

/// Whether both would be written as the same baseline, but for the program and the machine.
fn same(old: &Table, new: &Table) -> bool {
    let available = |table: &'_ Table| {
        let kept = table.methods().filter(|(_, method)| method.unavailable.is_none());
        kept.map(|(label, m)| (label.clone(), m.version.clone(), m.settings.clone(), m.library.clone(), m.points.clone()))
            .collect::<Vec<_>>()
    };
    old.seed == new.seed && old.text == new.text && old.coordinates == new.coordinates && available(old) == available(new)
}

fn news(scenario: &str, old: Option<&Table>, new: &Table) -> String {
    let Some(old) = old else {
        let counts = new.methods().map(|(_, method)| method.counts());
        let [measured, lost, rejected] = counts.fold([0; 3], |sum, counts| [0, 1, 2].map(|i| sum[i] + counts[i]));
        return format!("{scenario}: new baseline, {measured} measured, {lost} lost, {rejected} rejected\n");
    };
    told(scenario, &worse_than(old, new))
}

/// What gets worse in a scenario, a line each.
fn told(scenario: &str, worse: &[String]) -> String {
    let lines: String = worse.iter().map(|line| format!("    {line}\n")).collect();
    let verdict = if worse.is_empty() { "changed, nothing gets worse" } else { "gets worse:" };
    format!("{scenario}: {verdict}\n{lines}")
}
