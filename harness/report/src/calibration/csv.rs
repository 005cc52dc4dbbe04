//! A table as a file.

use std::io;

use calibench_files::{NewFolder, write_table};

/// Writes a header and rows.
pub(super) fn table(folder: &NewFolder, name: &str, columns: &[&str], rows: impl IntoIterator<Item = Vec<String>>) -> io::Result<()> {
    folder.write(name, |file| write_table(file, columns, rows))
}
