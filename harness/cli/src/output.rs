//! What a command writes, by the option that names it.

use std::path::Path;

use calibench_exchange::OutputFolder;

use crate::failure::Failure;

/// The folder `path` that `option` names.
pub fn folder(option: &str, path: &Path) -> Result<OutputFolder, Failure> {
    OutputFolder::open(path).map_err(|error| Failure::input(format!("{option} {error}")))
}
