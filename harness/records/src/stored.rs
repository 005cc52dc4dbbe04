//! The tables of a run as they lie in its folder: compressed CSV. Every reader of records goes through here.

use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use calibench_model::escape;
use thiserror::Error;

use crate::adjustments::{self, Row};
use crate::cells::RecordError;
use crate::judgement::{self, RECORDED_JUDGEMENT};
use crate::limited::unpacked;
use crate::names::PART;
use crate::points::{self, RecordHead, RunInfo};
use crate::results::{MethodInfo, Trial};

/// A table of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Table {
    /// What was measured, a row a point.
    Points,
    /// What was adjusted, a row a figure; not every run has it.
    Adjustments,
}

/// A table that cannot be read.
#[derive(Debug, Error)]
pub enum StoredError {
    /// There is none.
    #[error("{}: there is no such file", .0.display())]
    Absent(PathBuf),
    /// An older version left it, in a form that is no longer read.
    #[error("{}: records of an older version, which are not read any more: run the scenario again", .0.display())]
    Older(PathBuf),
    /// It is of a part of a run.
    #[error("{}: is a part of a run, and no run: put all parts together with `calibench merge`, then name what that wrote", .0.display())]
    Part(PathBuf),
    /// It is of another run than its folder says.
    #[error("{}: holds records of `{}`, expected those of `{expected}`: put them where they belong, or run the scenario again", path.display(), escape::name(found))]
    Misplaced {
        /// The file.
        path: PathBuf,
        /// The scenario, or the cell of its sweep, of which it is.
        found: String,
        /// That of which it should be.
        expected: String,
    },
    /// It does not fit what lies beside it.
    #[error("{}: {}: run the scenario again", path.display(), escape::name(problem))]
    Mistaken {
        /// The file.
        path: PathBuf,
        /// How.
        problem: String,
    },
    /// A file that cannot be read.
    #[error("{}: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// A file that is not what it should be.
    #[error("{}: {source}", path.display())]
    Records {
        /// The file.
        path: PathBuf,
        /// The reason.
        source: RecordError,
    },
}

impl Table {
    /// The table's file in the folder of a run.
    pub const fn file(self) -> &'static str {
        match self {
            Self::Points => "records.csv.gz",
            Self::Adjustments => "calibrations.csv.gz",
        }
    }

    /// The file that older versions left in its place.
    const fn older(self) -> &'static str {
        match self {
            Self::Points => "records.csv",
            Self::Adjustments => "calibrations.csv",
        }
    }

    /// Whether the run in `folder` has the table.
    ///
    /// # Errors
    /// [`StoredError::Older`] where an older version left it, [`StoredError::Part`] where the folder is of a part of a run.
    pub fn is_in(self, folder: &Path) -> Result<bool, StoredError> {
        whole(folder)?;
        let (path, older) = (folder.join(self.file()), folder.join(self.older()));
        match (path.is_file(), older.is_file()) {
            (false, true) => Err(StoredError::Older(older)),
            (there, _) => Ok(there),
        }
    }

    /// The table in `folder` as plain CSV.
    ///
    /// # Errors
    /// A table that is not there, that an older version left, or that cannot be opened.
    pub fn open(self, folder: &Path) -> Result<impl Read, StoredError> {
        let path = folder.join(self.file());
        if !self.is_in(folder)? {
            return Err(StoredError::Absent(path));
        }
        open(&path)
    }

    fn wrong(self, folder: &Path) -> impl FnOnce(RecordError) -> StoredError {
        let path = folder.join(self.file());
        |source| StoredError::Records { path, source }
    }
}

/// The compressed CSV file at `path` as plain CSV.
///
/// # Errors
/// A file that cannot be opened, [`StoredError::Part`] for one of a part of a run.
pub fn open(path: &Path) -> Result<impl Read + use<>, StoredError> {
    path.parent().map_or(Ok(()), whole)?;
    decompressed(path)
}

/// A part of a run must never be taken for the run: it would look like one of fewer trials.
///
/// # Errors
/// [`StoredError::Part`] for the folder of a part, or of a cell in it.
pub fn whole(folder: &Path) -> Result<(), StoredError> {
    let part = [Some(folder), folder.parent()].into_iter().flatten().find(|folder| folder.join(PART).is_file());
    part.map_or(Ok(()), |folder| Err(StoredError::Part(folder.to_owned())))
}

/// As [`open()`], of a run or of a part of one.
pub(crate) fn decompressed(path: &Path) -> Result<impl Read + use<>, StoredError> {
    let file = File::open(path).map_err(|source| StoredError::File { path: path.to_owned(), source })?;
    unpacked(file).map_err(|source| StoredError::File { path: path.to_owned(), source })
}

/// Reads the points of the run in `folder`, as [`points::read_records`] hands them on. `name` is that of the scenario, for a cell of its sweep with `@` and the
/// cell's label behind it.
///
/// # Errors
/// As [`Table::open`]; a file that was not written by this version, or of another run.
pub fn read_points(folder: &Path, name: &str, sink: impl FnMut(Trial, &[MethodInfo])) -> Result<RecordHead, StoredError> {
    let head = points::read_records(Table::Points.open(folder)?, sink).map_err(Table::Points.wrong(folder))?;
    belongs(folder.join(Table::Points.file()), &head.run.scenario, name)?;
    Ok(head)
}

/// Reads the adjustments of the run in `folder`, row by row; what all rows share. `name` is as for [`read_points`].
///
/// # Errors
/// As [`read_points`].
pub fn read_adjustments(folder: &Path, name: &str, sink: impl FnMut(Row)) -> Result<RunInfo, StoredError> {
    let run = adjustments::read(Table::Adjustments.open(folder)?, sink).map_err(Table::Adjustments.wrong(folder))?;
    belongs(folder.join(Table::Adjustments.file()), &run.scenario, name)?;
    Ok(run)
}

/// Reads the judgement of the run of `name` in `folder`: its seed and its rows.
///
/// # Errors
/// As [`open()`]; a file that was not written by this version, or of another run.
pub fn read_judgement(folder: &Path, name: &str) -> Result<(u64, Vec<judgement::Row>), StoredError> {
    let path = folder.join(RECORDED_JUDGEMENT);
    let (run, rows) = judgement::read_rows(open(&path)?).map_err(|source| StoredError::Records { path: path.clone(), source })?;
    belongs(path, &run.scenario, name)?;
    Ok((run.seed, rows))
}

/// A table without a row is of no run.
fn belongs(path: PathBuf, found: &str, expected: &str) -> Result<(), StoredError> {
    if found.is_empty() || found == expected {
        return Ok(());
    }
    Err(StoredError::Misplaced { path, found: found.to_owned(), expected: expected.to_owned() })
}
