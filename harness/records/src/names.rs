//! Where records lie.

use std::path::{Path, PathBuf};

/// The records' file in a scenario's folder.
pub const RECORDS: &str = "records.csv";
/// The scenario as it was run, in the same folder.
pub const SCENARIO: &str = "scenario.toml";

/// The folder of a cell's records in that of its scenario.
pub fn cell_folder(folder: &Path, index: usize) -> PathBuf {
    folder.join(format!("cell-{:04}", index + 1))
}

/// Where the image of view `view` is kept in the folder of a scenario's records: under its full name, so that `a.jpg` and `a.png` do not meet.
pub fn kept_image(folder: &Path, view: &str) -> PathBuf {
    folder.join(format!("{view}.png"))
}
