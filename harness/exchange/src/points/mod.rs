//! Point files: image coordinates as CSV.

use std::collections::HashMap;
use std::fs::File;
use std::io::Read;
use std::path::Path;

use calibench_model::{Affine, Covariance, PixelPoint, Start, TargetKind};
use csv::StringRecord;
use thiserror::Error;

/// The columns that must be there.
pub const REQUIRED: [&str; 4] = ["image", "target", "x", "y"];
/// The columns of the covariance, px^2: all or none.
pub const COVARIANCE: [&str; 3] = ["sxx", "sxy", "syy"];
/// What is pictured and its affine start: `kind` alone, or all five.
pub const SHAPE: [&str; 5] = ["kind", "axx", "axy", "ayx", "ayy"];
/// What `measure` adds: when its output is read again, `status` says which rows have a position; the others are read over.
pub const RESULT: [&str; 3] = ["method", "status", "reason"];

/// One row of a point file.
#[derive(Clone, Debug, PartialEq)]
pub struct PointRow {
    /// The image's file name.
    pub image: String,
    /// The target's name.
    pub target: String,
    /// Position, kind, affine start and covariance.
    pub start: Start,
}

/// The points of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct PointFile {
    /// The rows with a position, in the order of the file.
    pub rows: Vec<PointRow>,
    /// How many rows had none because `measure` rejected them or could not try them: left out.
    pub without_position: usize,
    /// Those rows.
    pub lost: Vec<LostRow>,
}

/// A row without a position.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LostRow {
    /// The image's file name.
    pub image: String,
    /// The target's name.
    pub target: String,
    /// What `measure` says became of it: `rejected` or `unavailable`.
    pub status: String,
    /// Why, as `measure` says it.
    pub reason: String,
}

/// What is wrong with a file of points, control or stations, and where.
#[derive(Debug, Error, PartialEq, Eq)]
#[error("{file}{place}: {problem}", place = place(*line, column.as_deref()))]
pub struct PointFileError {
    /// The file.
    pub file: String,
    /// The line, counted from 1, where known.
    pub line: Option<u64>,
    /// The column's name, where one is meant.
    pub column: Option<String>,
    /// What was expected and what was found.
    pub problem: String,
}

fn place(line: Option<u64>, column: Option<&str>) -> String {
    match (line, column) {
        (Some(line), Some(column)) => format!(":{line}, column `{column}`"),
        (Some(line), None) => format!(":{line}"),
        (None, Some(column)) => format!(", column `{column}`"),
        (None, None) => String::new(),
    }
}

/// Reads a point file: header `image,target,x,y`, optionally `sxx,sxy,syy` and `kind,axx,axy,ayx,ayy`, in any order.
///
/// Coordinates are px in the frame of [`PixelPoint`], covariances px^2. Empty optional cells mean "not given". The output of `measure` is read as well: its
/// rejected and unavailable rows, which have no position, are counted and left out.
///
/// # Errors
/// The first mistake, with line and column: a missing or unknown column, a row of another length, a number that is none or not finite, an impossible covariance, an
/// unknown kind, a point given twice, no point at all.
pub fn read_points(path: &Path) -> Result<PointFile, PointFileError> {
    let name = path.display().to_string();
    let file = File::open(path).map_err(|e| PointFileError { file: name.clone(), line: None, column: None, problem: e.to_string() })?;
    parse_points(&name, file)
}

/// As [`read_points`], from anything that can be read; `file` is its name in errors.
///
/// # Errors
/// As [`read_points`].
pub fn parse_points(file: &str, mut input: impl Read) -> Result<PointFile, PointFileError> {
    let mut text = Vec::new();
    let unreadable = |e: std::io::Error| PointFileError { file: file.to_owned(), line: None, column: None, problem: e.to_string() };
    input.read_to_end(&mut text).map_err(unreadable)?;
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(&text[..]);
    let header = reader.headers().map_err(|error| csv_error(file, &error))?.clone();
    let columns = Columns::new(file, &header)?;
    let mut seen: HashMap<(String, String), u64> = HashMap::new();
    let mut rows = Vec::new();
    let mut lost = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| csv_error(file, &error))?;
        let line = line_of(&text, &record);
        let cells = Cells { file, columns: &columns, record: &record, line };
        if let Some(status @ ("rejected" | "unavailable")) = cells.text("status") {
            lost.push(cells.lost(status));
            continue;
        }
        let row = cells.row()?;
        if let Some(earlier) = seen.insert((row.image.clone(), row.target.clone()), line) {
            let problem = format!(
                "target `{}` of image `{}` is already on line {earlier}; expected each once{}",
                row.target,
                row.image,
                cells.several()
            );
            return Err(PointFileError { file: file.to_owned(), line: Some(line), column: None, problem });
        }
        rows.push(row);
    }
    if rows.is_empty() && lost.is_empty() {
        let problem = "holds no point; expected one row a point below the header".to_owned();
        return Err(PointFileError { file: file.to_owned(), line: None, column: None, problem });
    }
    Ok(PointFile { rows, without_position: lost.len(), lost })
}

/// The line of a record: the reader's own count starts at the empty lines before it.
pub(crate) fn line_of(text: &[u8], record: &StringRecord) -> u64 {
    let Some(position) = record.position() else { return 0 };
    let before = text[position.byte() as usize..].iter().take_while(|byte| matches!(byte, b'\n' | b'\r'));
    position.line() + before.filter(|byte| **byte == b'\n').count() as u64
}

pub(crate) fn csv_error(file: &str, error: &csv::Error) -> PointFileError {
    let problem = match error.kind() {
        csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
            format!("expected {expected_len} cells as in the header, found {len}")
        }
        csv::ErrorKind::Utf8 { .. } => "expected UTF-8 text".to_owned(),
        _ => error.to_string(),
    };
    PointFileError { file: file.to_owned(), line: error.position().map(csv::Position::line), column: None, problem }
}

/// Where each known column stands.
struct Columns(HashMap<String, usize>);

impl Columns {
    fn new(file: &str, header: &StringRecord) -> Result<Self, PointFileError> {
        let wrong = |column: &str, problem: String| {
            Err(PointFileError { file: file.to_owned(), line: Some(1), column: Some(column.to_owned()), problem })
        };
        let known: Vec<&str> = [&REQUIRED[..], &COVARIANCE, &SHAPE, &RESULT].concat();
        let mut places = HashMap::new();
        for (index, name) in header.iter().enumerate() {
            if !known.contains(&name) {
                return wrong(name, format!("unknown; known are {}", known.join(", ")));
            }
            if places.insert(name.to_owned(), index).is_some() {
                return wrong(name, "stands in the header twice".to_owned());
            }
        }
        let groups = [&REQUIRED[..], &COVARIANCE, &SHAPE[1..]];
        for (group, required) in groups.into_iter().zip([true, false, false]) {
            let missing: Vec<&str> = group.iter().copied().filter(|name| !places.contains_key(*name)).collect();
            if !missing.is_empty() && (required || missing.len() < group.len()) {
                let why = if required { "every point file has" } else { "these go together:" };
                return wrong(missing[0], format!("missing in the header; {why} {}", group.join(",")));
            }
        }
        Ok(Self(places))
    }
}

/// One record, read cell by cell.
struct Cells<'a> {
    file: &'a str,
    columns: &'a Columns,
    record: &'a StringRecord,
    line: u64,
}

impl Cells<'_> {
    fn row(&self) -> Result<PointRow, PointFileError> {
        let kind = self.text("kind").map(|name| name.parse::<TargetKind>().map_err(|e| self.wrong("kind", e.to_string()))).transpose()?;
        let position = PixelPoint::new(self.required_number("x")?, self.required_number("y")?);
        let affine = self.group(&SHAPE[1..])?.map(|a| Affine { axx: a[0], axy: a[1], ayx: a[2], ayy: a[3] });
        let covariance = self.group(&COVARIANCE)?.map(|s| Covariance { sxx: s[0], sxy: s[1], syy: s[2] });
        if let Some(impossible) = covariance.filter(|covariance| !covariance.is_valid()) {
            let Covariance { sxx, sxy, syy } = impossible;
            let problem = format!("no covariance: expected sxx, syy >= 0 and sxy^2 <= sxx syy, found {sxx}, {sxy}, {syy}");
            return Err(self.wrong("sxx", problem));
        }
        let start = Start { position, kind, affine, covariance };
        Ok(PointRow { image: self.required_text("image")?, target: self.required_text("target")?, start })
    }

    fn lost(&self, status: &str) -> LostRow {
        let text = |column: &str| self.text(column).unwrap_or_default().to_owned();
        LostRow { image: text("image"), target: text("target"), status: status.to_owned(), reason: text("reason") }
    }

    /// What to do about a point that stands twice because several methods measured it.
    fn several(&self) -> &'static str {
        if self.text("method").is_some() { " (the file holds the results of several methods: keep those of one)" } else { "" }
    }

    fn text(&self, column: &str) -> Option<&str> {
        self.columns.0.get(column).and_then(|&index| self.record.get(index)).filter(|text| !text.is_empty())
    }

    fn required_text(&self, column: &str) -> Result<String, PointFileError> {
        self.text(column).map(str::to_owned).ok_or_else(|| self.wrong(column, "is empty; expected a name".into()))
    }

    fn number(&self, column: &str) -> Result<Option<f64>, PointFileError> {
        let Some(text) = self.text(column) else { return Ok(None) };
        match text.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(Some(number)),
            _ => Err(self.wrong(column, format!("expected a finite number with a decimal point, found `{text}`"))),
        }
    }

    fn required_number(&self, column: &str) -> Result<f64, PointFileError> {
        self.number(column)?.ok_or_else(|| self.wrong(column, "is empty; expected a number".into()))
    }

    /// All numbers of a group, or `None` if all its cells are empty or absent.
    fn group(&self, names: &[&str]) -> Result<Option<Vec<f64>>, PointFileError> {
        let numbers = names.iter().map(|name| self.number(name)).collect::<Result<Vec<_>, _>>()?;
        if numbers.iter().all(Option::is_none) {
            return Ok(None);
        }
        let required = names.iter().map(|name| self.required_number(name));
        required.collect::<Result<Vec<_>, _>>().map(Some)
    }

    fn wrong(&self, column: &str, problem: String) -> PointFileError {
        PointFileError { file: self.file.to_owned(), line: Some(self.line), column: Some(column.to_owned()), problem }
    }
}

#[cfg(test)]
mod tests;
