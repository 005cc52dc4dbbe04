//! Baseline files: our own blessed numbers, one CSV a scenario, one row a point.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use calibench_exchange::atomic::write_atomically;
use calibench_model::Rejection;
use csv::{Position, StringRecord};
use thiserror::Error;

use super::table::{Coordinates, DECIMALS, Entry, Place, Table};

/// The columns before the two coordinates.
const COLUMNS: [&str; 8] = ["method", "version", "seed", "trial", "view", "target", "status", "reason"];

/// A baseline file that is none.
#[derive(Debug, Error)]
pub enum BaselineError {
    /// It cannot be read or written.
    #[error("{}: {source}", path.display())]
    File {
        /// Which.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// It cannot be written; the message names it.
    #[error(transparent)]
    Output(#[from] io::Error),
    /// A place in it that means nothing.
    #[error("{}: line {line}, column `{column}`: {problem}", path.display())]
    Row {
        /// Which file.
        path: PathBuf,
        /// Counted from 1; the header is line 1.
        line: u64,
        /// The column's name, or `all`.
        column: String,
        /// What was found and what was expected.
        problem: String,
    },
}

/// Where the baseline of a scenario is: `folder/<scenario with '/' as '--'>.csv`.
pub fn baseline_path(folder: &Path, scenario: &str) -> PathBuf {
    folder.join(format!("{}.csv", scenario.replace('/', "--")))
}

/// Writes a baseline: whole or not at all, the same bytes for the same table. Unavailable methods have no rows.
///
/// # Errors
/// What the file system refuses.
pub fn write_baseline(path: &Path, table: &Table) -> Result<(), BaselineError> {
    let write = |output: &mut dyn io::Write| {
        let mut csv = csv::Writer::from_writer(output);
        csv.write_record(COLUMNS.iter().chain(&table.coordinates.names()))?;
        for (label, method) in table.methods() {
            for (place, entry) in &method.points {
                write_row(&mut csv, [label, &method.version], table.seed, place, entry)?;
            }
        }
        csv.flush()
    };
    Ok(write_atomically(path, write)?)
}

fn write_row<W: io::Write>(
    csv: &mut csv::Writer<W>,
    [label, version]: [&str; 2],
    seed: u64,
    place: &Place,
    entry: &Entry,
) -> io::Result<()> {
    let reason = if let Entry::Rejected(why) = entry { why.name() } else { "" };
    let [a, b] = entry.coordinates().map_or_else(Default::default, |at| at.map(|value| format!("{value:.DECIMALS$}")));
    let (seed, trial) = (seed.to_string(), place.trial.to_string());
    Ok(csv.write_record([label, version, &seed, &trial, &place.view, &place.target, entry.status(), reason, &a, &b])?)
}

/// Reads the baseline of `scenario`; `None` when there is no such file.
///
/// # Errors
/// A file that [`write_baseline`] did not write, with line and column.
pub fn read_baseline(path: &Path, scenario: &str) -> Result<Option<Table>, BaselineError> {
    match fs::read(path) {
        Ok(bytes) => parse(path, scenario, &bytes).map(Some),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(source) => Err(BaselineError::File { path: path.to_owned(), source }),
    }
}

fn parse(path: &Path, scenario: &str, bytes: &[u8]) -> Result<Table, BaselineError> {
    let mut csv = csv::Reader::from_reader(bytes);
    let broken = |error: csv::Error| {
        let line = error.position().map_or(1, Position::line);
        BaselineError::Row { path: path.to_owned(), line, column: "all".into(), problem: error.to_string() }
    };
    let header = csv.headers().map_err(broken)?.clone();
    let read = |coordinates: Coordinates| header.iter().eq(COLUMNS.into_iter().chain(coordinates.names()));
    let Some(coordinates) = [Coordinates::Errors, Coordinates::Positions].into_iter().find(|c| read(*c)) else {
        let problem = format!("expected the columns {} and dx,dy or x,y", COLUMNS.join(","));
        return Err(BaselineError::Row { path: path.to_owned(), line: 1, column: "all".into(), problem });
    };
    let mut table = Table::new(scenario, 0, coordinates, &[]);
    let mut first = true;
    for record in csv.records() {
        let record = record.map_err(broken)?;
        let row = Row { path, record: &record, header: &header };
        let seed = row.parse(2)?;
        if !first && seed != table.seed {
            return Err(row.wrong(2, &format!("expected the seed of the rows before, {}", table.seed)));
        }
        (table.seed, first) = (seed, false);
        add(&mut table, &row)?;
    }
    Ok(table)
}

fn add(table: &mut Table, row: &Row<'_>) -> Result<(), BaselineError> {
    let (label, version): (Arc<str>, Arc<str>) = (row.text(0).into(), row.text(1).into());
    let entry = row.entry()?;
    let place = Place { trial: row.parse(3)?, view: row.text(4).into(), target: row.text(5).into() };
    let method = table.method_mut(&label, &version);
    if method.version != version {
        return Err(row.wrong(1, &format!("expected the version of the rows before, {}", method.version)));
    }
    if method.points.insert(place, entry).is_some() {
        return Err(row.wrong(5, "the point is there twice"));
    }
    Ok(())
}

struct Row<'a> {
    path: &'a Path,
    record: &'a StringRecord,
    header: &'a StringRecord,
}

impl Row<'_> {
    fn text(&self, column: usize) -> &str {
        self.record.get(column).unwrap_or_default()
    }

    fn parse<T: std::str::FromStr>(&self, column: usize) -> Result<T, BaselineError> {
        self.text(column).parse().map_err(|_| self.wrong(column, "expected a number"))
    }

    fn entry(&self) -> Result<Entry, BaselineError> {
        let at = || Ok::<_, BaselineError>([self.parse(8)?, self.parse(9)?]);
        match self.text(6) {
            "measured" => Ok(Entry::Measured(at()?)),
            "lost" => Ok(Entry::Lost(at()?)),
            "rejected" => {
                let known = Rejection::ALL.into_iter().find(|why| why.name() == self.text(7));
                known.map(Entry::Rejected).ok_or_else(|| self.wrong(7, "expected a reason of rejection"))
            }
            _ => Err(self.wrong(6, "expected measured, lost or rejected")),
        }
    }

    fn wrong(&self, column: usize, expected: &str) -> BaselineError {
        BaselineError::Row {
            path: self.path.to_owned(),
            line: self.record.position().map_or(0, Position::line),
            column: self.header.get(column).unwrap_or_default().to_owned(),
            problem: format!("found `{}`, {expected}", self.text(column)),
        }
    }
}
