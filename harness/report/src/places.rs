//! Where reports come from and where they go.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

use crate::LoadError;
use crate::published::PublishedError;
use crate::speeds::SpeedsError;

/// The file name of a report's page.
pub(crate) const PAGE: &str = "README.md";

/// Where a report's material is and where reports go.
#[derive(Clone, Debug)]
pub struct Places {
    /// Records, one folder a scenario.
    pub records: PathBuf,
    /// Published tables, one folder a paper.
    pub published: PathBuf,
    /// Published cameras.
    pub cameras: PathBuf,
    /// Tables of the league, one a calibrator.
    pub league: PathBuf,
    /// Reports, one folder a family of scenarios.
    pub reports: PathBuf,
}

/// A report that cannot be made.
#[derive(Debug, Error)]
pub enum ReportError {
    /// Its records.
    #[error(transparent)]
    Load(#[from] LoadError),
    /// Its published tables.
    #[error(transparent)]
    Published(#[from] PublishedError),
    /// Its published cameras.
    #[error(transparent)]
    Cameras(calibench_diagnostics::Problems),
    /// Its conversions.
    #[error(transparent)]
    Convert(#[from] calibench_model::convert::ConvertError),
    /// Its measured speeds.
    #[error(transparent)]
    Speeds(#[from] SpeedsError),
    /// Its files.
    #[error("{0}")]
    Output(#[from] io::Error),
}

/// Whether a report was written, and the path of its page.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Written {
    /// It was made anew.
    New(PathBuf),
    /// Nothing of it could be measured here; the older one was left as it is.
    Kept(PathBuf),
}
