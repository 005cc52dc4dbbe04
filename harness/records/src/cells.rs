//! Files of records, cell by cell.

use std::io::{Read, Write};

use calibench_model::escape;
use csv::StringRecord;
use thiserror::Error;

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

/// A reader of a file of records whose header has been checked.
pub(crate) fn open<R: Read>(input: R, columns: &[&str]) -> Result<csv::Reader<R>, RecordError> {
    let mut csv = csv::Reader::from_reader(input);
    if csv.headers()?.iter().ne(columns.iter().copied()) {
        return Err(RecordError::Row { line: 1, problem: format!("expected the columns {}", columns.join(",")) });
    }
    Ok(csv)
}

/// Writes a row, its names safe from being taken for formulas; [`Cells::text`] reads them again.
pub(crate) fn write_row<W: Write>(csv: &mut csv::Writer<W>, cells: impl IntoIterator<Item: AsRef<str>>) -> Result<(), csv::Error> {
    cells.into_iter().try_for_each(|cell| csv.write_field(escape::cell(cell.as_ref()).as_bytes()))?;
    csv.write_record(None::<&[u8]>)
}

/// A row of a file of records.
pub(crate) struct Cells<'a> {
    pub(crate) record: &'a StringRecord,
    pub(crate) columns: &'a [&'a str],
}

impl Cells<'_> {
    pub(crate) fn text(&self, column: usize) -> &str {
        escape::from_cell(self.record.get(column).unwrap_or_default())
    }

    pub(crate) fn parse<T: std::str::FromStr>(&self, column: usize) -> Result<T, RecordError> {
        self.text(column).parse().map_err(|_| self.bad(column))
    }

    /// A finite number.
    pub(crate) fn number(&self, column: usize) -> Result<f64, RecordError> {
        self.parse(column).ok().filter(|number: &f64| number.is_finite()).ok_or_else(|| self.bad(column))
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

    /// A cell that holds something else than is said elsewhere.
    pub(crate) fn other(&self, column: usize, expected: &str) -> RecordError {
        self.wrong(&format!("column `{}` holds `{}`, expected `{expected}`", self.columns[column], self.text(column)))
    }

    /// Its line, counted from 1.
    pub(crate) fn line(&self) -> u64 {
        self.record.position().map_or(0, csv::Position::line)
    }

    /// A row that means nothing, and why.
    pub(crate) fn wrong(&self, problem: &str) -> RecordError {
        RecordError::Row { line: self.line(), problem: problem.to_owned() }
    }
}
