//! What is wrong with a project, or with what is asked of it.

use std::io;
use std::path::PathBuf;

use calibench_diagnostics::Problems;
use calibench_plugins::PluginError;
use calibench_scenario::catalogue::CatalogueError;
use thiserror::Error;

/// Why something of a project cannot be had.
#[derive(Debug, Error)]
pub enum ProjectError {
    /// A scenario or a plug-in's file has mistakes, each with its place.
    #[error(transparent)]
    Problems(Problems),
    /// A scenario cannot be had for another reason.
    #[error(transparent)]
    Catalogue(CatalogueError),
    /// A plug-in cannot be had for another reason.
    #[error(transparent)]
    Plugin(PluginError),
    /// A folder that was named as a project and is none.
    #[error("--root {}: expected a folder that holds scenarios/ and reference/", .0.display())]
    NoProject(PathBuf),
    /// There is no project, and there must be one.
    #[error("no folder with scenarios/ and reference/ from here upwards; go to the project or name it with --root DIR")]
    Outside,
    /// A scenario was asked for by name, and there is no project.
    #[error(
        "{0}: no folder with scenarios/ and reference/ from here upwards; go to the project, name it with --root DIR, or expected a TOML file"
    )]
    NameOutside(String),
    /// What was asked for cannot be, in words.
    #[error("{0}")]
    Asked(String),
    /// The current folder, which may be gone.
    #[error("the current folder: {0}; go to one that is there")]
    Here(io::Error),
}

impl From<CatalogueError> for ProjectError {
    fn from(error: CatalogueError) -> Self {
        match error {
            CatalogueError::Problems(problems) => Self::Problems(problems),
            other => Self::Catalogue(other),
        }
    }
}

impl From<PluginError> for ProjectError {
    fn from(error: PluginError) -> Self {
        match error {
            PluginError::Problems(problems) => Self::Problems(problems),
            other => Self::Plugin(other),
        }
    }
}
