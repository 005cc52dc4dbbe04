//! Files of plug-ins that are none.

use std::io;
use std::path::PathBuf;

use calibench_diagnostics::Problems;
use thiserror::Error;

/// Why there is no plug-in.
#[derive(Debug, Error)]
pub enum PluginError {
    /// The file has mistakes, each with its place.
    #[error(transparent)]
    Problems(#[from] Problems),
    /// It cannot be read.
    #[error("{}: {source}", path.display())]
    File {
        /// The file or folder.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// Two plug-ins of one name.
    #[error("{}: `{name}` is declared already, in {}; expected another name", path.display(), earlier.display())]
    Twice {
        /// The later file.
        path: PathBuf,
        /// The earlier one.
        earlier: PathBuf,
        /// The name.
        name: String,
    },
    /// A plug-in that is called as a method of this program.
    #[error("{}: `{name}` is a method of calibench itself; expected another name", path.display())]
    Taken {
        /// The file.
        path: PathBuf,
        /// The name.
        name: String,
    },
}
