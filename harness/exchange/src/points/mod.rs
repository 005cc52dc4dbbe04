//! Point files: image coordinates as CSV.

mod parallel;

use std::io::Read;
use std::path::Path;

use calibench_files::bounded;
use calibench_model::{Affine, Covariance, LostRows, PixelPoint, PointRef, Points, Start, TargetKind, escape};
use csv::StringRecord;
use thiserror::Error;

/// The columns that must be there; `x` and `y` in px, as in [`PixelPoint`].
pub const REQUIRED: [&str; 4] = ["image", "target", "x", "y"];
/// The columns of the covariance, px^2: all or none.
pub const COVARIANCE: [&str; 3] = ["sxx", "sxy", "syy"];
/// What is pictured and its affine start: `kind` alone, or all five.
pub const SHAPE: [&str; 5] = ["kind", "axx", "axy", "ayx", "ayy"];
/// What `measure` adds: when its output is read again, `status` says which rows have a position; the others are read over.
pub const RESULT: [&str; 3] = ["method", "status", "reason"];

/// The points of a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PointFile {
    /// The rows with a position, in the order of the file.
    pub points: Points,
    /// The rows without one because `measure` rejected them or could not try them.
    pub lost: LostRows,
}

/// What is wrong with a file of points, control or stations, and where.
#[derive(Debug, Error, PartialEq, Eq)]
#[error("{}{place}: {}", escape::name(file), escape::name(problem), place = place(*line, column.as_deref()))]
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
        (Some(line), Some(column)) => format!(":{line}, column `{}`", escape::name(column)),
        (Some(line), None) => format!(":{line}"),
        (None, Some(column)) => format!(", column `{}`", escape::name(column)),
        (None, None) => String::new(),
    }
}

/// Reads a point file: header `image,target,x,y`, optionally `sxx,sxy,syy` and `kind,axx,axy,ayx,ayy`, in any order. The truth that `render` writes beside an image
/// is one; what it has of hidden targets and of those outside is left out.
///
/// Coordinates are px in the frame of [`PixelPoint`], covariances px^2. Empty optional cells mean "not given". The output of `measure` is read as well: its
/// rejected and unavailable rows, which have no position, are counted and left out.
///
/// # Errors
/// The first mistake, with line and column: a missing or unknown column, a row of another length, a number that is none or not finite, an impossible covariance, an
/// unknown kind, a point given twice, no point at all.
pub fn read_points(path: &Path) -> Result<PointFile, PointFileError> {
    read_points_checked(path, &|_| Ok(()))
}

/// What a reader of a point file asks of each row with a position: `Ok`, or the column that is wrong and what was expected there.
pub type Check<'c> = &'c (dyn Fn(&PointRef<'_>) -> Result<(), (&'static str, String)> + Sync);

/// As [`read_points`], of rows that pass `check`.
///
/// # Errors
/// As [`read_points`]; the first row that `check` refuses, with line and column.
pub fn read_points_checked(path: &Path, check: Check<'_>) -> Result<PointFile, PointFileError> {
    let name = path.display().to_string();
    let text = bounded::table(path).map_err(|error| as_a_whole(&name, &error))?;
    not_empty(&name, parse(&name, &text, check)?)
}

/// As [`read_points`], from anything that can be read; `file` is its name in errors.
///
/// # Errors
/// As [`read_points`].
pub fn parse_points(file: &str, input: impl Read) -> Result<PointFile, PointFileError> {
    not_empty(file, parse_points_checked(file, input, &|_| Ok(()))?)
}

fn not_empty(file: &str, found: PointFile) -> Result<PointFile, PointFileError> {
    if found.points.is_empty() && found.lost.is_empty() {
        let problem = "holds no point; expected one row a point below the header".to_owned();
        return Err(PointFileError { file: file.to_owned(), line: None, column: None, problem });
    }
    Ok(found)
}

/// As [`parse_points`], of rows that pass `check`; there may be none.
///
/// # Errors
/// As [`parse_points`], but for a file without a row; the first row that `check` refuses, with line and column.
pub fn parse_points_checked(file: &str, input: impl Read, check: Check<'_>) -> Result<PointFile, PointFileError> {
    parse(file, &bounded::table_of(input).map_err(|error| as_a_whole(file, &error))?, check)
}

fn parse(file: &str, text: &[u8], check: Check<'_>) -> Result<PointFile, PointFileError> {
    match parallel::parse(file, text, check) {
        Some(found) => Ok(found),
        // Whatever is wrong is said with its line.
        None => in_turn(file, text, check),
    }
}

/// Why a file cannot be read.
pub(crate) fn as_a_whole(file: &str, error: &std::io::Error) -> PointFileError {
    PointFileError { file: file.to_owned(), line: None, column: None, problem: error.to_string() }
}

/// Reads row by row up to the first mistake.
fn in_turn(file: &str, text: &[u8], check: Check<'_>) -> Result<PointFile, PointFileError> {
    let mut found = PointFile { points: Points::with_capacity(most_rows(text)), lost: LostRows::default() };
    let end = read_rows(file, text, text, check, &mut found);
    if let Some((earlier, later)) = found.points.twice() {
        let mut reader = reader(text);
        let columns = Columns::new(file, reader.headers().map_err(|error| csv_error(file, &error))?)?;
        let [earlier_line, line] = [earlier, later].map(|index| line_of_row(text, &columns, index));
        let PointRef { image, target, .. } = found.points.row(later);
        let several = if columns.0[METHOD].is_some() { " (the file holds the results of several methods: keep those of one)" } else { "" };
        let problem = format!("target `{target}` of image `{image}` is already on line {earlier_line}; expected each once{several}");
        return Err(PointFileError { file: file.to_owned(), line: Some(line), column: None, problem });
    }
    end.map(|()| found)
}

/// A row takes eight bytes at least, as in `a,b,1,2`.
#[expect(clippy::naive_bytecount, reason = "a hundredth of what parsing takes")]
fn most_rows(text: &[u8]) -> usize {
    text.iter().filter(|byte| **byte == b'\n').count().min(text.len() / 8)
}

fn reader<R: Read>(input: R) -> csv::Reader<R> {
    csv::ReaderBuilder::new().trim(csv::Trim::Headers).from_reader(input)
}

/// Adds the rows below the header of `input` to `found`; `text` is the file as a whole, in which lines are counted.
fn read_rows(file: &str, input: impl Read, text: &[u8], check: Check<'_>, found: &mut PointFile) -> Result<(), PointFileError> {
    let mut reader = reader(input);
    let columns = Columns::new(file, reader.headers().map_err(|error| csv_error(file, &error))?)?;
    let mut record = StringRecord::new();
    while reader.read_record(&mut record).map_err(|error| csv_error(file, &error))? {
        let cells = Cells { file, columns: &columns, record: &record, text };
        if let Some([status, reason]) = columns.lost(&record) {
            let name = |column: usize| escape::from_cell(cells.text(column).unwrap_or_default());
            found.lost.push([name(IMAGE), name(TARGET), status, reason]);
            continue;
        }
        let row = cells.row()?;
        check(&row).map_err(|(column, problem)| cells.wrong(KNOWN.iter().position(|known| *known == column).unwrap_or(TARGET), problem))?;
        found.points.push(row.image, row.target, row.start);
    }
    Ok(())
}

/// The line of the point `index` of a text that was read up to there.
fn line_of_row(text: &[u8], columns: &Columns, index: usize) -> u64 {
    let mut reader = csv::Reader::from_reader(text);
    reader
        .records()
        .filter_map(Result::ok)
        .filter(|record| columns.lost(record).is_none())
        .nth(index)
        .map_or(0, |record| line_of(text, &record))
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

/// Where each known column stands: [`REQUIRED`], [`COVARIANCE`], [`SHAPE`] and [`RESULT`], in this order.
struct Columns([Option<usize>; KNOWN.len()]);

const KNOWN: [&str; 16] =
    ["image", "target", "x", "y", "sxx", "sxy", "syy", "kind", "axx", "axy", "ayx", "ayy", "method", "status", "reason", "visibility"];
/// What the truth of a rendered image holds beside `visibility`, and is not needed here.
const TRUTH: [&str; 11] =
    ["ellipse_x", "ellipse_y", "semi_major", "semi_minor", "angle_deg", "X", "Y", "Z", "size_px", "room_px", "warning"];
/// Of such a truth, targets of which there is nothing to measure.
const UNSEEN: [&str; 2] = ["hidden", "outside"];
/// And of which there is.
const SEEN: [&str; 2] = ["visible", "clipped"];
const IMAGE: usize = 0;
const TARGET: usize = 1;
const X: usize = 2;
const Y: usize = 3;
const SXX: usize = 4;
const KIND: usize = 7;
const AXX: usize = 8;
const METHOD: usize = 12;
const STATUS: usize = 13;
const REASON: usize = 14;
const VISIBILITY: usize = 15;

impl Columns {
    fn new(file: &str, header: &StringRecord) -> Result<Self, PointFileError> {
        let wrong = |column: &str, problem: String| {
            Err(PointFileError { file: file.to_owned(), line: Some(1), column: Some(column.to_owned()), problem })
        };
        let mut places = [None; KNOWN.len()];
        for (index, name) in header.iter().enumerate() {
            let Some(known) = KNOWN.iter().position(|known| *known == name) else {
                // X, Y and Z of a file that is no truth would be taken for nothing without a word.
                if TRUTH.contains(&name) && header.iter().any(|other| other == KNOWN[VISIBILITY]) {
                    continue;
                }
                return wrong(name, format!("unknown; known are {}", KNOWN.join(", ")));
            };
            if places[known].replace(index).is_some() {
                return wrong(name, "stands in the header twice".to_owned());
            }
        }
        for (group, required) in [(IMAGE..=Y, true), (SXX..=SXX + 2, false), (AXX..=AXX + 3, false)] {
            let names = &KNOWN[group.clone()];
            let missing: Vec<&str> = group.filter(|&known| places[known].is_none()).map(|known| KNOWN[known]).collect();
            if !missing.is_empty() && (required || missing.len() < names.len()) {
                let why = if required { "every point file has" } else { "these go together:" };
                return wrong(missing[0], format!("missing in the header; {why} {}", names.join(",")));
            }
        }
        Ok(Self(places))
    }

    fn text<'r>(&self, record: &'r StringRecord, column: usize) -> Option<&'r str> {
        self.0[column].and_then(|place| record.get(place)).map(str::trim).filter(|text| !text.is_empty())
    }

    /// Status and reason of a row without a position: one that `measure` rejected, or a truth of what is not seen.
    fn lost<'r>(&self, record: &'r StringRecord) -> Option<[&'r str; 2]> {
        match (self.text(record, STATUS), self.text(record, VISIBILITY)) {
            (Some(status @ ("rejected" | "unavailable")), _) => Some([status, self.text(record, REASON).unwrap_or_default()]),
            (_, Some(unseen)) if UNSEEN.contains(&unseen) => Some(["unavailable", unseen]),
            _ => None,
        }
    }
}

/// The largest image coordinate, px: no image is a tenth as wide.
const FARTHEST: f64 = 1e7;

/// One record, read cell by cell.
struct Cells<'a> {
    file: &'a str,
    columns: &'a Columns,
    record: &'a StringRecord,
    text: &'a [u8],
}

impl<'a> Cells<'a> {
    fn row(&self) -> Result<PointRef<'a>, PointFileError> {
        if let Some(word) = self.text(VISIBILITY).filter(|word| !SEEN.contains(word)) {
            return Err(self.wrong(VISIBILITY, format!("found `{word}`; expected {}", [SEEN, UNSEEN].concat().join(", "))));
        }
        let kind = self.text(KIND).map(|name| name.parse::<TargetKind>().map_err(|e| self.wrong(KIND, e.to_string()))).transpose()?;
        let position = PixelPoint::new(self.coordinate(X)?, self.coordinate(Y)?);
        let affine = self.group(AXX)?.map(|[axx, axy, ayx, ayy]| Affine { axx, axy, ayx, ayy });
        let covariance = self.group(SXX)?.map(|[sxx, sxy, syy]| Covariance { sxx, sxy, syy });
        if let Some(impossible) = covariance.filter(|covariance| !covariance.is_valid()) {
            let Covariance { sxx, sxy, syy } = impossible;
            let problem = format!("no covariance: expected sxx, syy >= 0 and sxy^2 <= sxx syy, found {sxx}, {sxy}, {syy}");
            return Err(self.wrong(SXX, problem));
        }
        let start = Start { kind, affine, covariance, ..Start::at(position) };
        Ok(PointRef { image: self.required_name(IMAGE)?, target: self.required_name(TARGET)?, start })
    }

    fn text(&self, column: usize) -> Option<&'a str> {
        self.columns.text(self.record, column)
    }

    fn required_name(&self, column: usize) -> Result<&'a str, PointFileError> {
        self.text(column).map(escape::from_cell).ok_or_else(|| self.wrong(column, "is empty; expected a name".into()))
    }

    fn number(&self, column: usize) -> Result<Option<f64>, PointFileError> {
        let Some(text) = self.text(column) else { return Ok(None) };
        match text.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(Some(number)),
            _ => Err(self.wrong(column, format!("expected a finite number with a decimal point, found `{text}`"))),
        }
    }

    fn required_number(&self, column: usize) -> Result<f64, PointFileError> {
        self.number(column)?.ok_or_else(|| self.wrong(column, "is empty; expected a number".into()))
    }

    /// An image coordinate, px.
    fn coordinate(&self, column: usize) -> Result<f64, PointFileError> {
        let number = self.required_number(column)?;
        let far =
            || self.wrong(column, format!("is {number} px; expected an image coordinate, at most {FARTHEST:e} px from the first pixel"));
        if number.abs() <= FARTHEST { Ok(number) } else { Err(far()) }
    }

    /// The numbers of a group of columns, or `None` if all its cells are empty or absent.
    fn group<const N: usize>(&self, first: usize) -> Result<Option<[f64; N]>, PointFileError> {
        if (first..first + N).all(|column| self.text(column).is_none()) {
            return Ok(None);
        }
        let mut numbers = [0.0; N];
        for (number, column) in numbers.iter_mut().zip(first..) {
            *number = self.required_number(column)?;
        }
        Ok(Some(numbers))
    }

    fn line(&self) -> u64 {
        line_of(self.text, self.record)
    }

    fn wrong(&self, column: usize, problem: String) -> PointFileError {
        PointFileError { file: self.file.to_owned(), line: Some(self.line()), column: Some(KNOWN[column].to_owned()), problem }
    }
}

#[cfg(test)]
mod tests;
