//! Why parts cannot be put together.

use std::io;
use std::path::{Path, PathBuf};

use calibench_records::parts::{JoinError, ManifestError};
use thiserror::Error;

/// Parts that cannot be put together.
#[derive(Debug, Error)]
pub enum MergeError {
    /// A folder without any part.
    #[error("{}: holds no part of a run; expected a folder that `calibench run --part K/N -o DIR` wrote, or one with such folders in it", .0.display())]
    NoPart(PathBuf),
    /// A part whose description cannot be read.
    #[error(transparent)]
    Manifest(#[from] ManifestError),
    /// Parts of two runs.
    #[error("{} and {} are parts of different runs of `{scenario}`: the second has {difference}; expected parts of one run", first.display(), second.display())]
    Different {
        /// The scenario.
        scenario: String,
        /// A part.
        first: PathBuf,
        /// Another one.
        second: PathBuf,
        /// By what the second differs.
        difference: String,
    },
    /// A part that is there twice.
    #[error("part {part} of `{scenario}` is there twice, in {} and {}; expected each part once", first.display(), second.display())]
    Doubled {
        /// The scenario.
        scenario: String,
        /// The part, as in `3/8`.
        part: String,
        /// Where it is.
        first: PathBuf,
        /// Where it is, too.
        second: PathBuf,
    },
    /// Parts that are not there.
    #[error("`{scenario}`: {missing} missing; expected all {of} parts: run what is missing with --part, or name its folder")]
    Missing {
        /// The scenario.
        scenario: String,
        /// Which, as in `part 3/8 is`.
        missing: String,
        /// How many there must be.
        of: u64,
    },
    /// A part that is not as it was written.
    #[error("{0}; copy the part again, or delete and run it again")]
    Broken(io::Error),
    /// A file that all parts have in common, which is another one in this part.
    #[error("{}: is not the file of {}; expected parts of one run", file.display(), first.display())]
    Common {
        /// The file.
        file: PathBuf,
        /// The part that has another.
        first: PathBuf,
    },
    /// A table that does not continue that of the part before.
    #[error("{}", join(path, source))]
    Join {
        /// The table.
        path: PathBuf,
        /// The reason.
        source: JoinError,
    },
    /// Records that cannot be written.
    #[error("{0}")]
    Output(#[from] io::Error),
}

/// The error of a table; one of the file names it already.
fn join(path: &Path, source: &JoinError) -> String {
    match source {
        JoinError::Stored(error) => error.to_string(),
        other => format!("{}: {other}", path.display()),
    }
}
