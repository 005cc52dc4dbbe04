//! Tables of parts, joined row by row into the table of the run.

use std::io::{Read, Write};
use std::path::Path;

use csv::ByteRecord;
use thiserror::Error;

use super::Span;
use crate::cells::RecordError;
use crate::stored::{StoredError, decompressed};

/// The column of the trial's number, in every table of a run; what is said of no trial stands before them all.
const TRIAL: usize = 1;

/// A table that does not continue the ones before it.
#[derive(Debug, Error)]
pub enum JoinError {
    /// A file that cannot be read.
    #[error(transparent)]
    Stored(#[from] StoredError),
    /// The columns, or what is said of all trials (what was unavailable, the detector), are others than those of the first table.
    #[error(
        "begins with `{found}`, the part before it with `{expected}`: all parts are to be run with the same program, methods and tools"
    )]
    Head {
        /// The first row that differs; empty if there is none.
        found: String,
        /// The row of the first table.
        expected: String,
    },
    /// A table that cannot be written.
    #[error(transparent)]
    Output(csv::Error),
}

/// Joins tables, given in the order of their trials. One row is held at a time.
pub struct Joiner<W: Write> {
    csv: csv::Writer<W>,
    head: Option<Vec<ByteRecord>>,
}

impl<W: Write> Joiner<W> {
    /// Nothing yet, to go to `output`.
    pub fn new(output: W) -> Self {
        Self { csv: csv::Writer::from_writer(output), head: None }
    }

    /// Adds the compressed table at `path`, whose trials must be among `trials`.
    ///
    /// # Errors
    /// [`JoinError`].
    pub fn add(&mut self, path: &Path, trials: Span) -> Result<(), JoinError> {
        self.add_plain(decompressed(path)?, trials).map_err(|problem| match problem {
            Problem::Input(source) => StoredError::Records { path: path.to_owned(), source }.into(),
            Problem::Joined(error) => error,
        })
    }

    fn add_plain(&mut self, input: impl Read, trials: Span) -> Result<(), Problem> {
        let mut csv = csv::ReaderBuilder::new().has_headers(false).from_reader(input);
        let (mut head, mut row) = (Vec::new(), ByteRecord::new());
        let mut more = csv.read_byte_record(&mut row)?;
        // The names of the columns, and rows of no trial.
        while more && (head.is_empty() || trial_of(&row).is_empty()) {
            head.push(row.clone());
            more = csv.read_byte_record(&mut row)?;
        }
        self.begin(head)?;
        let mut earliest = trials.from;
        while more {
            let number = std::str::from_utf8(trial_of(&row)).ok().and_then(|text| text.parse().ok());
            let number = number.filter(|number| trials.holds(*number) && *number >= earliest);
            earliest = number.ok_or_else(|| Problem::Input(misplaced(&row, trials)))?;
            self.write(&row)?;
            more = csv.read_byte_record(&mut row)?;
        }
        Ok(())
    }

    /// Writes the head of the first table; that of every other must be the same.
    fn begin(&mut self, head: Vec<ByteRecord>) -> Result<(), JoinError> {
        let Some(first) = &self.head else {
            head.iter().try_for_each(|row| self.write(row))?;
            self.head = Some(head);
            return Ok(());
        };
        let places = 0..first.len().max(head.len());
        let differs = places.map(|place| [head.get(place), first.get(place)]).find(|[found, expected]| found != expected);
        let Some(rows) = differs else { return Ok(()) };
        let [found, expected] = rows.map(|row| row.map_or_else(String::new, shown));
        Err(JoinError::Head { found, expected })
    }

    /// Field by field, as the run wrote it: a compressor's bytes depend on the blocks in which it is fed.
    fn write(&mut self, row: &ByteRecord) -> Result<(), JoinError> {
        let mut written = row.iter().try_for_each(|field| self.csv.write_field(field));
        written = written.and_then(|()| self.csv.write_record(None::<&[u8]>));
        written.map_err(JoinError::Output)
    }

    /// Ends the table and gives back its output.
    ///
    /// # Errors
    /// What the output refuses.
    pub fn finish(self) -> Result<W, JoinError> {
        self.csv.into_inner().map_err(|error| JoinError::Output(error.into_error().into()))
    }
}

/// What is wrong: with the table that is read, or beside the others.
enum Problem {
    Input(RecordError),
    Joined(JoinError),
}

impl From<csv::Error> for Problem {
    fn from(error: csv::Error) -> Self {
        Self::Input(error.into())
    }
}

impl From<JoinError> for Problem {
    fn from(error: JoinError) -> Self {
        Self::Joined(error)
    }
}

fn trial_of(row: &ByteRecord) -> &[u8] {
    row.get(TRIAL).unwrap_or_default()
}

/// A row as CSV, for a message.
fn shown(row: &ByteRecord) -> String {
    row.iter().map(String::from_utf8_lossy).collect::<Vec<_>>().join(",")
}

fn misplaced(row: &ByteRecord, Span { from, to }: Span) -> RecordError {
    let problem =
        format!("column `trial` holds `{}`; expected rising numbers from {from}, below {to}", String::from_utf8_lossy(trial_of(row)));
    RecordError::Row { line: row.position().map_or(0, csv::Position::line), problem }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = "scenario,trial,method\ns,,\"absent, alas\"\n";

    fn joined(tables: &[(&str, [u64; 2])]) -> Result<String, String> {
        let mut joiner = Joiner::new(Vec::new());
        for (text, [from, to]) in tables {
            joiner.add_plain(text.as_bytes(), Span { from: *from, to: *to }).map_err(|error| match error {
                Problem::Input(error) => error.to_string(),
                Problem::Joined(error) => error.to_string(),
            })?;
        }
        Ok(String::from_utf8(joiner.finish().unwrap()).unwrap())
    }

    fn table(rows: &str) -> String {
        format!("{HEAD}{rows}")
    }

    #[test]
    fn rows_follow_each_other_under_one_head() {
        let [a, b, none] = ["s,0,m\ns,0,\"n,\"\"x\"\"\"\ns,2,m\n", "s,3,m\n", ""].map(table);
        let whole = table("s,0,m\ns,0,\"n,\"\"x\"\"\"\ns,2,m\ns,3,m\n");
        assert_eq!(joined(&[(&a, [0, 3]), (&none, [3, 3]), (&b, [3, 4])]), Ok(whole));
    }

    #[test]
    fn what_does_not_continue_the_others_is_refused() {
        for (rows, expected) in [
            ("s,5,m\n", "line 3: column `trial` holds `5`; expected rising numbers from 3, below 5"),
            ("s,2,m\n", "`2`"),
            ("s,4,m\ns,3,m\n", "line 4: column `trial` holds `3`"),
            ("s,3,m\ns,,m\n", "line 4: column `trial` holds ``"),
            ("s,three,m\n", "`three`"),
            ("s,3\n", "2 fields"),
        ] {
            let error = joined(&[(&table("s,0,m\n"), [0, 3]), (&table(rows), [3, 5])]).unwrap_err();
            assert!(error.contains(expected), "{rows}: {error}");
        }
        for head in ["scenario,trial,method\n", "scenario,trial,method\ns,,another\n", "scenario,trial\n", ""] {
            let error = joined(&[(&table("s,0,m\n"), [0, 3]), (head, [3, 5])]).unwrap_err();
            assert!(error.contains("the same program, methods and tools"), "{head}: {error}");
        }
    }
}
