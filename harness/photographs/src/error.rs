//! Photographs that cannot be measured.

use std::path::PathBuf;

use calibench_exchange::PhotoError;
use thiserror::Error;

/// What is wrong with photographs.
#[derive(Debug, Error)]
pub enum PhotographsError {
    /// One that cannot be read.
    #[error(transparent)]
    Photo(#[from] PhotoError),
    /// There is none.
    #[error("no photograph was given")]
    None,
    /// One is given twice.
    #[error("{}: given twice; expected each photograph once", .0.display())]
    Twice(PathBuf),
    /// Points name a photograph that may be either of two.
    #[error("two photographs are called {name}: {} and {}; points must name them with their folders, as `{}`", .paths[0].display(), .paths[1].display(), .paths[1].display())]
    Ambiguous {
        /// What points call it.
        name: String,
        /// Those of that name.
        paths: [PathBuf; 2],
    },
    /// No point is of any of the photographs.
    #[error("no point is of a photograph that was given: points name `{named}`, the photographs are called `{called}`")]
    NoneNamed {
        /// The image of the first point.
        named: String,
        /// The name of the first photograph.
        called: String,
    },
    /// Photographs of one camera that differ in size.
    #[error("{}: {} x {} px, but {} has {} x {}; expected photographs of one camera, in one orientation", other.display(), found.0, found.1, first.display(), size.0, size.1)]
    Sizes {
        /// The first.
        first: PathBuf,
        /// Its width and height, px.
        size: (u32, u32),
        /// Another one.
        other: PathBuf,
        /// Its width and height, px.
        found: (u32, u32),
    },
}
