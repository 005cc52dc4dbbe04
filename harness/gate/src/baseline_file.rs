//! What all files of baselines share: a head that says what was blessed, rows of CSV, and a checksum over both.
//!
//! The head is TOML behind `# `. The checksum is the first 16 bytes of the BLAKE3 hash of every line but its own, in hexadecimal.

use std::fs;
use std::io::{self, Read as _};
use std::path::{Path, PathBuf};

use calibench_files::atomic::write_atomically;
use calibench_records::spelling::{present_label, present_settings};
use csv::{Position, StringRecord};
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// The number of this format.
const FORMAT: u32 = 2;
const FIRST: &str = "# Blessed numbers of calibench: written by `calibench bless`, never by hand.";
const CHECKSUM: &str = "# checksum = ";

/// A baseline file that is none.
#[derive(Debug, Error)]
pub enum BaselineError {
    /// It cannot be read or written.
    #[error("{}: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// It is not as it was written.
    #[error("{}: {problem}", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What was found and what was expected.
        problem: String,
    },
    /// A place in it that means nothing.
    #[error("{}: line {line}, column `{column}`: {problem}", path.display())]
    Row {
        /// The file.
        path: PathBuf,
        /// Counted from 1, the head's lines among them.
        line: u64,
        /// The column's name, or `all`.
        column: String,
        /// What was found and what was expected.
        problem: String,
    },
}

/// What the rows of a file are.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// One row a point.
    Points,
    /// One row a target, method and cell of a sweep: counts and sums.
    Sums,
    /// One row a figure of adjustments, method and cell: sums over trials.
    Figures,
    /// As [`Self::Sums`], of the image points behind adjustments.
    Images,
    /// One row a published cell: its verdict.
    Verdicts,
}

/// A method of a file; rows name it by its place in the list, from 1.
#[derive(Clone, Debug, Deserialize, PartialEq, Eq, Serialize)]
#[serde(deny_unknown_fields)]
pub struct HeadMethod {
    /// Its label.
    pub label: String,
    /// Its version.
    pub version: String,
    /// All its parameters with their values.
    pub settings: String,
    /// The library on which its numbers depend, with its version.
    pub library: String,
    /// How many rows it has.
    pub rows: u64,
}

/// The head of a file: the fingerprints of what was blessed.
#[derive(Clone, Debug, Deserialize, PartialEq, Eq, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Head {
    format: u32,
    /// What the rows are.
    pub kind: Kind,
    /// The scenario's name.
    pub scenario: String,
    /// The fingerprint of its text.
    pub text: String,
    /// The seed, as text: TOML's integers are too small.
    pub seed: String,
    /// `errors` or `positions`.
    pub coordinates: String,
    /// The version of calibench.
    pub program: String,
    /// The processor's architecture and features: for information.
    pub machine: String,
    /// The labels of the cells, in their order; a scenario without a sweep has one without a label.
    pub cells: Vec<String>,
    /// The methods.
    #[serde(default)]
    pub method: Vec<HeadMethod>,
}

impl Head {
    /// A head without methods.
    pub fn new(kind: Kind, scenario: &str, text: &str, seed: u64, coordinates: &str, cells: Vec<String>) -> Self {
        Self {
            format: FORMAT,
            kind,
            scenario: scenario.to_owned(),
            text: text.to_owned(),
            seed: seed.to_string(),
            coordinates: coordinates.to_owned(),
            program: env!("CARGO_PKG_VERSION").to_owned(),
            machine: machine(),
            cells,
            method: Vec::new(),
        }
    }
}

/// Architecture and vector instructions of this processor.
pub fn machine() -> String {
    #[cfg(target_arch = "x86_64")]
    {
        let lanes = [("AVX-512", is_x86_feature_detected!("avx512f")), ("AVX2", is_x86_feature_detected!("avx2")), ("SSE2", true)];
        let best = lanes.into_iter().find(|(_, there)| *there).map_or("", |(name, _)| name);
        format!("x86_64 {best}")
    }
    #[cfg(not(target_arch = "x86_64"))]
    std::env::consts::ARCH.to_owned()
}

/// Writes a file, whole or not at all, the same bytes for the same content; returns its checksum.
///
/// # Errors
/// What the file system refuses.
pub fn write(path: &Path, head: &Head, columns: &[&str], rows: impl Iterator<Item = Vec<String>>) -> Result<String, BaselineError> {
    let failed = |source| BaselineError::File { path: path.to_owned(), source };
    let mut csv = csv::Writer::from_writer(Vec::new());
    let all = || -> Result<Vec<u8>, csv::Error> {
        csv.write_record(columns)?;
        for row in rows {
            csv.write_record(&row)?;
        }
        csv.into_inner().map_err(|error| error.into_error().into())
    };
    let body = all().map_err(|error| failed(io::Error::other(error)))?;
    let toml = toml::to_string(head).map_err(|error| failed(io::Error::other(error)))?;
    let head: String = toml.lines().map(|line| format!("# {line}").trim_end().to_owned() + "\n").collect();
    let sum = checksum([FIRST].into_iter().chain(head.lines()).chain(std::str::from_utf8(&body).unwrap_or_default().lines()));
    write_atomically(path, |file| {
        write!(file, "{FIRST}\n{CHECKSUM}\"{sum}\"\n{head}")?;
        file.write_all(&body)
    })
    .map_err(failed)?;
    Ok(sum)
}

/// Whether a file is one that [`write`] wrote, as a whole or in part.
pub fn is_baseline(path: &Path) -> bool {
    let mut start = vec![0; FIRST.len()];
    let mut read = || fs::File::open(path)?.read_exact(&mut start);
    path.extension().is_some_and(|extension| extension == "csv") && path.is_file() && read().is_ok() && start == FIRST.as_bytes()
}

fn checksum<'a>(lines: impl Iterator<Item = &'a str>) -> String {
    let mut hasher = blake3::Hasher::new();
    for line in lines {
        hasher.update(line.as_bytes());
        hasher.update(b"\n");
    }
    hasher.finalize().to_hex()[..32].to_owned()
}

/// A file as it was read; its rows are still text.
pub struct Sheet {
    path: PathBuf,
    /// Its head.
    pub head: Head,
    /// Its checksum, which [`Sheet::verify`] compares with its content.
    pub checksum: String,
    found: String,
    lines: u64,
    header: StringRecord,
    rows: Vec<StringRecord>,
}

/// Reads the file at `path` whose columns are `columns`; `None` when there is none.
///
/// # Errors
/// A file without a head, or with fewer or more rows than its head says.
pub fn read(path: &Path, kind: Kind, columns: &[&str]) -> Result<Option<Sheet>, BaselineError> {
    let bytes = match fs::read(path) {
        Ok(bytes) => bytes,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        Err(source) => return Err(BaselineError::File { path: path.to_owned(), source }),
    };
    let damaged = |problem: String| BaselineError::Damaged { path: path.to_owned(), problem };
    let text = String::from_utf8(bytes).map_err(|_| damaged("is no text; restore it, or bless anew".into()))?;
    let head: Vec<&str> = text.lines().take_while(|line| line.starts_with('#')).collect();
    let sum = head.get(1).and_then(|line| line.strip_prefix(CHECKSUM)).map(|sum| sum.trim().trim_matches('"').to_owned());
    let (Some(FIRST), Some(sum)) = (head.first().copied(), sum) else {
        return Err(damaged(
            "has no head with fingerprints: its first lines are gone or of an older version; restore it, or bless anew".into(),
        ));
    };
    let toml: String = head[2..].iter().map(|line| line.trim_start_matches("# ").trim_start_matches('#').to_owned() + "\n").collect();
    let wrong = |error: toml::de::Error| damaged(format!("its head means nothing ({}); restore it, or bless anew", error.message()));
    let mut parsed: Head = toml::from_str(&toml).map_err(wrong)?;
    for method in &mut parsed.method {
        let operator = method.label.split(':').next().unwrap_or_default();
        method.settings = present_settings(operator, &method.settings);
        method.label = present_label(&method.label);
    }
    if parsed.format != FORMAT || parsed.kind != kind {
        return Err(damaged(format!(
            "its head says format {} and {:?}, expected {FORMAT} and {kind:?}; bless anew",
            parsed.format, parsed.kind
        )));
    }
    let found = checksum([FIRST].into_iter().chain(text.lines().skip(2)));
    let lines = head.len() as u64;
    let body: usize = text.split_inclusive('\n').take(head.len()).map(str::len).sum();
    let mut csv = csv::ReaderBuilder::new().flexible(true).from_reader(text.get(body..).unwrap_or_default().as_bytes());
    let broken = |error: csv::Error| BaselineError::Row {
        path: path.to_owned(),
        line: lines + error.position().map_or(1, Position::line),
        column: "all".into(),
        problem: error.to_string(),
    };
    let header = csv.headers().map_err(broken)?.clone();
    if header.iter().ne(columns.iter().copied()) {
        let problem = format!("expected the columns {}", columns.join(","));
        return Err(BaselineError::Row { path: path.to_owned(), line: lines + 1, column: "all".into(), problem });
    }
    let rows = csv.records().collect::<Result<Vec<_>, _>>().map_err(broken)?;
    let expected: u64 = parsed.method.iter().map(|method| method.rows).sum();
    if rows.len() as u64 != expected {
        let rows = rows.len();
        return Err(damaged(format!("{rows} rows are there, its head says {expected}: rows were cut or added; restore it, or bless anew")));
    }
    Ok(Some(Sheet { path: path.to_owned(), head: parsed, checksum: sum, found, lines, header, rows }))
}

impl Sheet {
    /// The rows.
    pub fn rows(&self) -> impl Iterator<Item = Row<'_>> {
        self.rows.iter().map(|record| Row { sheet: self, record })
    }

    /// Whether the file is to the letter what was written.
    ///
    /// # Errors
    /// [`BaselineError::Damaged`] if not.
    pub fn verify(&self) -> Result<(), BaselineError> {
        if self.found == self.checksum {
            return Ok(());
        }
        let problem = "was edited after it was blessed: its checksum is another; restore it, or bless anew".to_owned();
        Err(BaselineError::Damaged { path: self.path.clone(), problem })
    }
}

/// A row of a file.
pub struct Row<'a> {
    sheet: &'a Sheet,
    record: &'a StringRecord,
}

impl<'a> Row<'a> {
    /// The text of a cell.
    pub fn text(&self, column: usize) -> &'a str {
        self.record.get(column).unwrap_or_default()
    }

    /// A number.
    ///
    /// # Errors
    /// Anything else, with its place.
    pub fn parse<T: std::str::FromStr>(&self, column: usize) -> Result<T, BaselineError> {
        self.text(column).parse().map_err(|_| self.wrong(column, "expected a number"))
    }

    /// A number, or nothing.
    ///
    /// # Errors
    /// Anything else, with its place.
    pub fn optional<T: std::str::FromStr>(&self, column: usize) -> Result<Option<T>, BaselineError> {
        if self.text(column).is_empty() { Ok(None) } else { self.parse(column).map(Some) }
    }

    /// A place, counted from 1, in the head's list of `count`; here from 0.
    ///
    /// # Errors
    /// One that the list does not have.
    pub fn place(&self, column: usize, count: usize) -> Result<usize, BaselineError> {
        let place: usize = self.parse(column)?;
        if (1..=count).contains(&place) {
            Ok(place - 1)
        } else {
            Err(self.wrong(column, &format!("expected 1 to {count}, as the head lists")))
        }
    }

    /// The mistake in a cell.
    pub fn wrong(&self, column: usize, expected: &str) -> BaselineError {
        BaselineError::Row {
            path: self.sheet.path.clone(),
            line: self.sheet.lines + self.record.position().map_or(0, Position::line),
            column: self.sheet.header.get(column).unwrap_or_default().to_owned(),
            problem: format!("found `{}`, {expected}", calibench_model::escape::message(self.text(column))),
        }
    }
}
