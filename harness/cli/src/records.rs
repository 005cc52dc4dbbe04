//! `calibench records`: what a run left, in plain text.

use std::io::{self, BufRead, BufReader, Write};
use std::path::{Path, PathBuf};

use calibench_records::description::Description;
use calibench_records::names::{SCENARIO, cell_folder};
use calibench_records::plain;
use calibench_records::stored::{StoredError, Table, open};
use calibench_report::sweep;
use clap::{Args, ValueEnum};

use super::context::Context;
use super::plot::pair;
use crate::deliver::stream;
use crate::failure::Failure;

#[derive(Args)]
pub struct Records {
    /// Name of a scenario that was run, its TOML file, the folder of its records, or one file of them
    #[arg(value_name = "SCENARIO")]
    scenario: String,
    /// What of it
    #[arg(long, value_enum, default_value = "points")]
    table: Which,
    /// Of a sweep only the cells with this value of a swept key, as in --at blur=0.5; may be repeated
    #[arg(long, value_name = "KEY=VALUE", value_parser = pair)]
    at: Vec<(String, String)>,
    /// As CSV with every column, as the file holds it [default: columns side by side, what is the same in all rows once above them]
    #[arg(long)]
    csv: bool,
}

/// A table by its name on the command line.
#[derive(Clone, Copy, ValueEnum)]
enum Which {
    /// What was measured, a row a point
    Points,
    /// What was adjusted, a row a figure
    Adjustments,
}

impl Which {
    const fn table(self) -> Table {
        match self {
            Self::Points => Table::Points,
            Self::Adjustments => Table::Adjustments,
        }
    }
}

impl Records {
    pub fn run(&self, context: &Context<'_>) -> Result<(), Failure> {
        let files = self.files(context)?;
        let mut read = Ok(());
        stream(|output| match if self.csv { csv(&files, output) } else { columns(&files, output) } {
            Err(Ended::Output(error)) => Err(error),
            Err(Ended::Read(error)) => {
                read = Err(error);
                Ok(())
            }
            Ok(()) => Ok(()),
        })?;
        Ok(read?)
    }

    /// The files to print, in the order of their cells.
    fn files(&self, context: &Context<'_>) -> Result<Vec<PathBuf>, Failure> {
        let path = Path::new(&self.scenario);
        if path.is_file() && path.extension().is_some_and(|ending| ending == "gz") {
            return if self.at.is_empty() {
                Ok(vec![path.to_owned()])
            } else {
                Err(Failure::input(format!(
                    "--at: {} is one file, of no sweep or of one cell; expected the name of a sweep",
                    path.display()
                )))
            };
        }
        let folder = self.folder(context, path)?;
        let sweep = described(&folder)?.sweep;
        let cells = match &sweep {
            Some(sweep) => sweep::cells(sweep, &self.at)?.into_iter().map(|cell| cell_folder(&folder, cell)).collect(),
            None if self.at.is_empty() => vec![folder],
            None => return Err(Failure::input(format!("--at: {}: these records are not of a sweep", folder.display()))),
        };
        let table = self.table.table();
        cells.iter().map(|cell| self.file(table, cell)).collect()
    }

    /// The file of `table` in `folder`, where it must be.
    fn file(&self, table: Table, folder: &Path) -> Result<PathBuf, Failure> {
        if table.is_in(folder)? {
            return Ok(folder.join(table.file()));
        }
        Err(match table {
            Table::Points => none(&self.scenario),
            Table::Adjustments => Failure::input(format!("{}: the run adjusts nothing; expected --table points", folder.display())),
        })
    }

    /// The folder of the records that the user means.
    fn folder(&self, context: &Context<'_>, path: &Path) -> Result<PathBuf, Failure> {
        let records = context.places()?.records;
        let there = [path.to_owned(), records.join(path)].into_iter().find(|folder| folder.join(SCENARIO).is_file());
        match there {
            Some(folder) => Ok(folder),
            None => {
                let folder = records.join(context.scenario(&self.scenario)?.name);
                if folder.join(SCENARIO).is_file() { Ok(folder) } else { Err(none(&self.scenario)) }
            }
        }
    }
}

fn none(scenario: &str) -> Failure {
    Failure::input(format!("no records of `{scenario}`: run it first with `calibench run {scenario}`"))
}

/// What the records in `folder` tell of their scenario.
fn described(folder: &Path) -> Result<Description, Failure> {
    calibench_report::load::description(folder, &folder.display().to_string())?.ok_or_else(|| none(&folder.display().to_string()))
}

/// Why printing ended early.
enum Ended {
    Output(io::Error),
    Read(StoredError),
}

impl From<io::Error> for Ended {
    fn from(error: io::Error) -> Self {
        Self::Output(error)
    }
}

impl From<StoredError> for Ended {
    fn from(error: StoredError) -> Self {
        Self::Read(error)
    }
}

/// The rows of all files under one header, byte by byte as they are.
fn csv(files: &[PathBuf], output: &mut dyn Write) -> Result<(), Ended> {
    for (place, path) in files.iter().enumerate() {
        let wrong = |source| StoredError::File { path: path.clone(), source };
        let (mut input, mut header) = (BufReader::new(open(path)?), Vec::new());
        // No name of a column holds a line end.
        input.read_until(b'\n', &mut header).map_err(wrong)?;
        if place == 0 {
            output.write_all(&header)?;
        }
        loop {
            let bytes = input.fill_buf().map_err(wrong)?;
            if bytes.is_empty() {
                break;
            }
            output.write_all(bytes)?;
            let count = bytes.len();
            input.consume(count);
        }
    }
    Ok(())
}

/// The rows of all files, columns side by side.
fn columns(files: &[PathBuf], output: &mut dyn Write) -> Result<(), Ended> {
    let mut layout = plain::Layout::default();
    let wrong = |path: &Path| {
        let path = path.to_owned();
        |source| StoredError::Records { path, source }
    };
    for path in files {
        layout.add(open(path)?).map_err(wrong(path))?;
    }
    for line in layout.head() {
        writeln!(output, "{line}")?;
    }
    for path in files {
        for line in layout.lines(open(path)?) {
            writeln!(output, "{}", line.map_err(wrong(path))?)?;
        }
    }
    Ok(())
}
