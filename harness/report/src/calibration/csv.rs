//! A table as a file.

use std::io;
use std::path::Path;

use calibench_exchange::atomic::write_atomically;
use calibench_exchange::write_table;

/// Writes a header and rows.
pub(super) fn table(path: &Path, columns: &[&str], rows: impl IntoIterator<Item = Vec<String>>) -> io::Result<()> {
    write_atomically(path, |file| write_table(file, columns, rows))
}
