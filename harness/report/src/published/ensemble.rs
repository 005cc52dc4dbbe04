//! What many plausible experiments say of a printed figure, where the paper does not tell which of them was its own.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use thiserror::Error;

use super::range::Range;

/// Figures of many experiments: a CSV file beside the table, a row for each experiment, a column for each figure.
#[derive(Debug, Default)]
pub struct Ensemble {
    /// The values of each column.
    columns: BTreeMap<String, Vec<f64>>,
}

/// A file of experiments that cannot be read.
#[derive(Debug, Error)]
pub enum EnsembleError {
    /// The file or its form.
    #[error("{}: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What is wrong, with its line.
        source: csv::Error,
    },
    /// A field.
    #[error("{}:{line}: column `{column}` holds `{text}`: expected a number", path.display())]
    Number {
        /// The file.
        path: PathBuf,
        /// Its line, from 1.
        line: u64,
        /// The column.
        column: String,
        /// What stands there.
        text: String,
    },
    /// No rows.
    #[error("{}: no experiment: expected a line of names and at least one row", path.display())]
    Empty {
        /// The file.
        path: PathBuf,
    },
}

impl Ensemble {
    /// Reads a file.
    ///
    /// # Errors
    /// A file that cannot be read, has a field that is no number, or no rows.
    pub fn read(path: &Path) -> Result<Self, EnsembleError> {
        let file = |source| EnsembleError::File { path: path.to_owned(), source };
        let mut reader = csv::Reader::from_path(path).map_err(file)?;
        let names: Vec<String> = reader.headers().map_err(file)?.iter().map(str::to_owned).collect();
        let mut values = vec![Vec::new(); names.len()];
        for record in reader.records() {
            let record = record.map_err(file)?;
            for ((name, values), text) in names.iter().zip(&mut values).zip(&record) {
                let line = record.position().map_or(0, csv::Position::line);
                let number = || EnsembleError::Number { path: path.to_owned(), line, column: name.clone(), text: text.to_owned() };
                values.push(text.trim().parse().ok().filter(|value: &f64| value.is_finite()).ok_or_else(number)?);
            }
        }
        if values.first().is_none_or(Vec::is_empty) {
            return Err(EnsembleError::Empty { path: path.to_owned() });
        }
        Ok(Self { columns: names.into_iter().zip(values).collect() })
    }

    /// How many experiments there are.
    pub fn count(&self) -> usize {
        self.columns.values().next().map_or(0, Vec::len)
    }

    /// The names of its columns, sorted.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.columns.keys().map(String::as_str)
    }

    /// Where the experiments lie in `column`.
    pub fn range(&self, column: &str) -> Option<Range> {
        Range::of(self.columns.get(column)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(text: &str) -> (tempfile::TempDir, PathBuf) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("networks.csv");
        std::fs::write(&path, text).unwrap();
        (folder, path)
    }

    /// Of 0, 1, ..., 40 the median is 20; 2.5 % of 42 intervals are 1.05.
    #[test]
    fn ranges_are_those_counted_by_hand() {
        let rows: String = (0..=40).map(|i| format!("{},{}\n", (i * 17) % 41, 2)).collect();
        let (_folder, path) = written(&format!("a,b\n{rows}"));
        let ensemble = Ensemble::read(&path).unwrap();
        assert_eq!((ensemble.count(), ensemble.names().collect::<Vec<_>>()), (41, vec!["a", "b"]));
        let Range { median, low, high } = ensemble.range("a").unwrap();
        assert!((median - 20.0).abs() < 1e-12 && (low - 0.05).abs() < 1e-12 && (high - 39.95).abs() < 1e-12, "{low} {high}");
        assert_eq!(ensemble.range("b"), Some(Range { median: 2.0, low: 2.0, high: 2.0 }));
        assert_eq!(ensemble.range("c"), None);
        let (_folder, path) = written("a\n1\n2\n");
        assert_eq!(Ensemble::read(&path).unwrap().range("a").unwrap().median, 1.5, "between two");
    }

    #[test]
    fn files_that_hold_no_figures_are_refused() {
        for (text, expected) in [
            ("a,b\n1,2\n1,x\n", "networks.csv:3: column `b` holds `x`: expected a number"),
            ("a\nNaN\n", "networks.csv:2: column `a` holds `NaN`"),
            ("a,b\n", "no experiment"),
            ("", "no experiment"),
            ("a,b\n1\n", "networks.csv: CSV error: record 1 (line: 2"),
        ] {
            let (_folder, path) = written(text);
            let found = Ensemble::read(&path).unwrap_err().to_string();
            assert!(found.contains(expected), "{found}");
        }
        assert!(Ensemble::read(Path::new("/absent/networks.csv")).unwrap_err().to_string().starts_with("/absent/networks.csv: "));
    }
}
