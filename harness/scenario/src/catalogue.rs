//! Where scenarios are found.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use calibench_diagnostics::{Problems, nearest};
use calibench_measure::Registry;
use thiserror::Error;

use super::{Scenario, check, why};

/// What the names of scenarios begin with whose files are not in the folder.
pub const LOCAL: &str = "local/";

/// The folder of scenario files.
#[derive(Clone, Debug)]
pub struct Catalogue {
    folder: Option<PathBuf>,
}

/// A scenario that cannot be loaded.
#[derive(Debug, Error)]
pub enum CatalogueError {
    /// Its file has mistakes.
    #[error(transparent)]
    Problems(#[from] Problems),
    /// There is none of this name.
    #[error("no scenario is called `{name}`{}; `calibench list scenarios` lists them", proposal.as_ref().map_or(String::new(), |p| format!(", did you mean `{p}`?")))]
    Unknown {
        /// What was asked for.
        name: String,
        /// What is nearest.
        proposal: Option<String>,
    },
    /// A file or folder that cannot be read.
    #[error("{}: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
}

impl Catalogue {
    /// The scenarios below `folder`.
    pub fn new(folder: impl Into<PathBuf>) -> Self {
        Self { folder: Some(folder.into()) }
    }

    /// No folder: only files are loaded.
    pub fn outside() -> Self {
        Self { folder: None }
    }

    /// The names of all scenarios, sorted.
    ///
    /// # Errors
    /// A folder that cannot be read.
    pub fn names(&self) -> Result<Vec<String>, CatalogueError> {
        let mut names = Vec::new();
        self.folder.as_ref().map_or(Ok(()), |folder| collect(folder, "", &mut names))?;
        names.sort();
        Ok(names)
    }

    /// Loads the scenario called `name`, or, when `name` ends in `.toml`, that of this file.
    ///
    /// # Errors
    /// No such scenario, or every mistake in its file.
    pub fn load(&self, name: &str, registry: &Registry) -> Result<Scenario, CatalogueError> {
        let (path, text) = self.text(name)?;
        Ok(check::parse(&self.name_of(&path), &path.display().to_string(), &text, registry)?)
    }

    /// What the scenario called `name`, or that of the file `name`, is to show, from its text alone: nothing of what it describes is made or checked.
    ///
    /// # Errors
    /// No such scenario, and a text that does not say it.
    pub fn why(&self, name: &str) -> Result<String, CatalogueError> {
        let (path, text) = self.text(name)?;
        Ok(why::why(&path.display().to_string(), &text)?)
    }

    /// The file of the scenario called `name`, or the file `name`, and its text.
    fn text(&self, name: &str) -> Result<(PathBuf, String), CatalogueError> {
        let path = match &self.folder {
            Some(folder) if !is_toml(Path::new(name)) => folder.join(format!("{name}.toml")),
            _ => PathBuf::from(name),
        };
        match calibench_files::bounded::text(&path) {
            Ok(text) => Ok((path, text)),
            Err(error) if error.kind() == io::ErrorKind::NotFound && !is_toml(Path::new(name)) => Err(self.unknown(name)),
            Err(source) => Err(CatalogueError::File { path, source }),
        }
    }

    fn unknown(&self, name: &str) -> CatalogueError {
        let names = self.names().unwrap_or_default();
        let proposal = nearest(name, names.iter().map(String::as_str)).map(str::to_owned);
        CatalogueError::Unknown { name: name.to_owned(), proposal }
    }

    /// The path below the folder, or, for a file elsewhere, `local/` and its stem.
    fn name_of(&self, path: &Path) -> String {
        let below = match (path.canonicalize(), self.folder.as_ref().map(|folder| folder.canonicalize())) {
            (Ok(path), Some(Ok(folder))) => path.strip_prefix(folder).ok().map(Path::to_owned),
            _ => None,
        };
        let stem = |path: &Path| path.with_extension("").to_string_lossy().replace('\\', "/");
        below.map_or_else(|| format!("{LOCAL}{}", path.file_stem().unwrap_or_default().to_string_lossy()), |path| stem(&path))
    }
}

/// Whether a name is that of a scenario's file.
pub fn is_toml(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == "toml")
}

fn collect(folder: &Path, prefix: &str, names: &mut Vec<String>) -> Result<(), CatalogueError> {
    let failed = |source| CatalogueError::File { path: folder.to_owned(), source };
    for entry in fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        if path.is_dir() {
            collect(&path, &format!("{prefix}{name}/"), names)?;
        } else if is_toml(&path) {
            names.push(format!("{prefix}{name}"));
        }
    }
    Ok(())
}
