//! Published tables that cannot be read.

use std::path::PathBuf;

use calibench_diagnostics::Problems;
use thiserror::Error;

use super::EnsembleError;

/// A table that cannot be read.
#[derive(Debug, Error)]
pub enum PublishedError {
    /// The file or its folder.
    #[error("{}: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// Its text.
    #[error(transparent)]
    Problems(#[from] Problems),
    /// Its experiments.
    #[error(transparent)]
    Ensemble(#[from] EnsembleError),
}
