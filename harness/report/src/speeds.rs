//! Points per second of methods, as `calibench speed` measured them: reference data, because times are not the same bytes twice.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Where they lie below the project's folder.
pub const SPEEDS: &str = "reference/speeds.csv";

/// What one method did on the image of one scenario, on one thread.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Speed {
    /// The scenario that pictures the image.
    pub scenario: String,
    /// The method with its setting.
    pub method: String,
    /// Its version.
    pub version: String,
    /// The median over the rounds, points per second.
    pub points_per_second: f64,
    /// The lower quartile, points per second.
    pub low: f64,
    /// The upper quartile, points per second.
    pub high: f64,
    /// Points in the image.
    pub points: usize,
    /// How many rounds, each with all methods in turn.
    pub rounds: usize,
    /// Columns and rows of the image, as in 240x200: operators that search the whole image take as long for one point as for all.
    pub image: String,
}

/// All speeds of one run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Speeds {
    /// The machine, in words.
    pub machine: String,
    /// Scenario by scenario.
    pub rows: Vec<Speed>,
}

/// A file of speeds that cannot be read.
#[derive(Debug, Error)]
pub enum SpeedsError {
    /// It cannot be opened or read.
    #[error("{}: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// It is not such a file.
    #[error("{}: {source}; `calibench speed` writes it anew", path.display())]
    Csv {
        /// The file.
        path: PathBuf,
        /// Line and mistake.
        source: csv::Error,
    },
    /// A figure that no measurement gives.
    #[error("{}: `{method}` on `{scenario}` has {value} points a second; expected a number above 0. `calibench speed` writes the file anew", path.display())]
    Value {
        /// The file.
        path: PathBuf,
        /// The scenario of the row.
        scenario: String,
        /// The method of the row.
        method: String,
        /// What stands there.
        value: f64,
    },
}

impl Speeds {
    /// Reads `path`; empty if there is no such file.
    ///
    /// # Errors
    /// A file that is not one of speeds.
    pub fn read(path: &Path) -> Result<Self, SpeedsError> {
        let failed = |source| SpeedsError::File { path: path.to_owned(), source };
        let file = match File::open(path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Self::default()),
            other => other.map_err(failed)?,
        };
        let mut input = BufReader::new(file);
        let mut first = String::new();
        input.read_line(&mut first).map_err(failed)?;
        let machine = first.strip_prefix("# ").map(|text| text.trim_end().to_owned());
        let whole: Box<dyn Read> = if machine.is_some() { Box::new(input) } else { Box::new(io::Cursor::new(first).chain(input)) };
        let rows = csv::ReaderBuilder::new().comment(Some(b'#')).from_reader(whole).into_deserialize().collect::<Result<Vec<Speed>, _>>();
        let rows = rows.map_err(|source| SpeedsError::Csv { path: path.to_owned(), source })?;
        if let Some(row) = rows.iter().find(|row| !(row.points_per_second.is_finite() && row.points_per_second > 0.0)) {
            let (scenario, method) = (row.scenario.clone(), row.method.clone());
            return Err(SpeedsError::Value { path: path.to_owned(), scenario, method, value: row.points_per_second });
        }
        Ok(Self { machine: machine.unwrap_or_default(), rows })
    }

    /// Writes them as CSV below a line that describes the machine.
    ///
    /// # Errors
    /// What the output refuses.
    pub fn write(&self, output: &mut dyn Write) -> io::Result<()> {
        writeln!(output, "# {}", self.machine)?;
        let mut csv = csv::Writer::from_writer(output);
        self.rows.iter().try_for_each(|row| csv.serialize(row)).map_err(io::Error::other)?;
        csv.flush()
    }

    /// Of `method` on the image of `scenario`.
    pub fn of(&self, scenario: &str, method: &str) -> Option<&Speed> {
        self.rows.iter().find(|row| row.scenario == scenario && row.method == method)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn speed(points_per_second: f64) -> Speed {
        let [scenario, method, version, image] = ["atlas/corners", "forstner:window=11,gauss=2", "1", "240x200"].map(str::to_owned);
        Speed { scenario, method, version, points_per_second, low: 90.5, high: 120.25, points: 20, rounds: 9, image }
    }

    #[test]
    fn what_is_written_is_read_again() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("speeds.csv");
        assert_eq!(Speeds::read(&path).unwrap(), Speeds::default());
        let speeds = Speeds { machine: "two threads, x86_64".into(), rows: vec![speed(101.5), speed(7.0)] };
        speeds.write(&mut File::create(&path).unwrap()).unwrap();
        assert_eq!(Speeds::read(&path).unwrap(), speeds);
    }

    #[test]
    fn a_speed_that_cannot_be_is_refused_by_name() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("speeds.csv");
        Speeds { machine: "m".into(), rows: vec![speed(0.0)] }.write(&mut File::create(&path).unwrap()).unwrap();
        let message = Speeds::read(&path).unwrap_err().to_string();
        assert!(message.contains("forstner:window=11,gauss=2") && message.contains("above 0"), "{message}");
        std::fs::write(&path, "scenario,method\na,b\n").unwrap();
        assert!(matches!(Speeds::read(&path), Err(SpeedsError::Csv { .. })));
    }
}
