//! Files of records, cell by cell.

use std::io::Write;

use calibench_model::escape;
use thiserror::Error;

use crate::rows::decimal;

/// A records file that is none.
#[derive(Debug, Error)]
pub enum RecordError {
    /// Not the CSV that it should be.
    #[error(transparent)]
    Csv(#[from] csv::Error),
    /// A row that means nothing.
    #[error("line {line}: {}; these records were not written by this version, run the scenario again", escape::name(problem))]
    Row {
        /// Counted from 1.
        line: u64,
        /// The fault.
        problem: String,
    },
}

/// Writes a row, its names safe from being taken for formulas; [`Cells::text`] reads them again.
pub(crate) fn write_row<W: Write>(csv: &mut csv::Writer<W>, cells: impl IntoIterator<Item: AsRef<str>>) -> Result<(), csv::Error> {
    cells.into_iter().try_for_each(|cell| csv.write_field(escape::cell(cell.as_ref()).as_bytes()))?;
    csv.write_record(None::<&[u8]>)
}

/// A row of a file of records: its cells are parts of one text.
#[derive(Clone, Copy)]
pub(crate) struct Cells<'a> {
    pub(crate) text: &'a str,
    pub(crate) spans: &'a [(usize, usize)],
    pub(crate) line: u64,
    pub(crate) columns: &'a [&'a str],
}

impl<'a> Cells<'a> {
    pub(crate) fn text(&self, column: usize) -> &'a str {
        let cell = self.spans.get(column).and_then(|(start, end)| self.text.get(*start..*end)).unwrap_or_default();
        if cell.starts_with('\'') { escape::from_cell(cell) } else { cell }
    }

    /// How many cells it has.
    pub(crate) fn count(&self) -> usize {
        self.spans.len()
    }

    pub(crate) fn parse<T: std::str::FromStr>(&self, column: usize) -> Result<T, RecordError> {
        self.text(column).parse().map_err(|_| self.bad(column))
    }

    /// A finite number.
    pub(crate) fn number(&self, column: usize) -> Result<f64, RecordError> {
        decimal(self.text(column)).filter(|number| number.is_finite()).ok_or_else(|| self.bad(column))
    }

    /// A finite number, or an empty cell.
    pub(crate) fn optional_number(&self, column: usize) -> Result<Option<f64>, RecordError> {
        if self.text(column).is_empty() { Ok(None) } else { self.number(column).map(Some) }
    }

    /// A cell that may be empty.
    pub(crate) fn optional<T: std::str::FromStr>(&self, column: usize) -> Result<Option<T>, RecordError> {
        if self.text(column).is_empty() { Ok(None) } else { self.parse(column).map(Some) }
    }

    /// A cell that holds what it should not.
    pub(crate) fn bad(&self, column: usize) -> RecordError {
        self.wrong(&format!("column `{}` holds `{}`", self.columns[column], self.text(column)))
    }

    /// Its line, counted from 1.
    pub(crate) fn line(&self) -> u64 {
        self.line
    }

    /// A row that means nothing, and why.
    pub(crate) fn wrong(&self, problem: &str) -> RecordError {
        RecordError::Row { line: self.line(), problem: problem.to_owned() }
    }
}
