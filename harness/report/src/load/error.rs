//! Why records cannot be read.

use std::io;
use std::path::PathBuf;

use calibench_records::RecordError;
use thiserror::Error;

/// Records that cannot be read.
#[derive(Debug, Error)]
pub enum LoadError {
    /// There are none.
    #[error("no records of `{0}`: run it first with `calibench run {0}`")]
    None(String),
    /// A file that cannot be read.
    #[error("{}: {source}", path.display())]
    File {
        /// Which.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// A file that is not what it should be.
    #[error("{}: {source}", path.display())]
    Records {
        /// Which.
        path: PathBuf,
        /// What is wrong.
        source: RecordError,
    },
    /// The scenario as it was run no longer passes the checks.
    #[error("{0}\nthese records are of an older scenario format: run the scenario again")]
    Scenario(#[from] calibench_diagnostics::Problems),
}
