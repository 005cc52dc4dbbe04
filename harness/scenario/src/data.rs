//! Where photographs that others took are found.

use std::path::{Path, PathBuf};

/// The variable that names the data folder.
pub const VARIABLE: &str = "CALIBENCH_DATA";

/// The data folder: what [`VARIABLE`] says, or `../shared/data` beside the project's folder.
pub fn data_folder(root: &Path) -> PathBuf {
    std::env::var_os(VARIABLE).map_or_else(|| root.join("../shared/data"), PathBuf::from)
}
