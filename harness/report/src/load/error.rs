//! Why records cannot be read.

use std::path::PathBuf;

use calibench_records::stored::StoredError;
use thiserror::Error;

/// Records that cannot be read.
#[derive(Debug, Error)]
pub enum LoadError {
    /// There are none.
    #[error("no records of `{0}`: run it first with `calibench run {0}`")]
    None(String),
    /// There are none of any scenario of a family.
    #[error("no scenario of `{family}` was run: `calibench run {family}` runs {}", those(scenarios))]
    NotRun {
        /// The family.
        family: String,
        /// Its scenarios.
        scenarios: Vec<String>,
    },
    /// A file of a run that cannot be read.
    #[error(transparent)]
    Stored(#[from] StoredError),
    /// They do not tell what their scenario is: an older version left them.
    #[error("{}: records without `scenario.json`, of an older version: run `{name}` again", folder.display())]
    Undescribed {
        /// The folder.
        folder: PathBuf,
        /// The scenario.
        name: String,
    },
    /// What they tell of their scenario is of another form.
    #[error("{}: {source}\nthese records were not written by this version, run the scenario again", path.display())]
    Description {
        /// The file.
        path: PathBuf,
        /// Line and mistake.
        source: serde_json::Error,
    },
}

/// A scenario, or how many there are with one of them.
fn those(scenarios: &[String]) -> String {
    match scenarios {
        [] => "none, for it has no scenario".into(),
        [one] => format!("`{one}`"),
        [one, ..] => format!("all {}, `calibench run {one}` one of them", scenarios.len()),
    }
}
