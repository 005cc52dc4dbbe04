//! Times of images as CSV.

use std::path::Path;

use crate::csv_named_rows::Form;
use crate::points::PointFileError;

const FORM: Form = Form {
    what: "file of times",
    key: "image",
    partner: None,
    group: None,
    required: &["time"],
    optional: &[],
    others: true,
    passed_over: &[],
};

/// Reads when images were taken: header `image,time`, seconds from any moment; other columns are read over.
///
/// # Errors
/// The first mistake, with line and column: a missing column, a number that is none, an image given twice, no row at all.
pub fn read_times(path: &Path) -> Result<Vec<(String, f64)>, PointFileError> {
    FORM.read(path, |_, row| Ok((row.name, row.numbers[0])))
}
