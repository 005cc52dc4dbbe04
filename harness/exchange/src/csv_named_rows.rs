//! Sheets of named rows and numbers as CSV, with errors that say line and column.

use std::collections::HashMap;
use std::io::Read;
use std::path::Path;

use calibench_files::bounded;
use calibench_model::escape;
use calibench_model::points::Names;
use csv::StringRecord;

use crate::points::{PointFileError, as_a_whole, csv_error, line_of};

/// The columns of a kind of sheet.
pub(crate) struct Form {
    /// What it is called in messages.
    pub(crate) what: &'static str,
    /// The column with the name of a row, of which each is there once.
    pub(crate) key: &'static str,
    /// The column with a second name, of rows that stand for a pair: then each pair is there once, in whichever order.
    pub(crate) partner: Option<&'static str>,
    /// The column with what rows belong to, where names are told apart within it alone.
    pub(crate) group: Option<&'static str>,
    /// Columns of numbers that must be there.
    pub(crate) required: &'static [&'static str],
    /// Groups of columns of numbers that may be there, each whole or not at all.
    pub(crate) optional: &'static [&'static [&'static str]],
    /// Columns of other names are read over.
    pub(crate) others: bool,
    /// Columns that are passed over, since this program's own tables have them.
    pub(crate) passed_over: &'static [&'static str],
}

/// A row: its name, its numbers, and of each optional group those that it has.
pub(crate) struct Row {
    pub(crate) line: u64,
    pub(crate) name: String,
    /// The second name, or nothing.
    pub(crate) partner: String,
    /// What the row belongs to, or nothing.
    pub(crate) group: String,
    pub(crate) numbers: Vec<f64>,
    optional: Vec<Option<Vec<f64>>>,
}

impl Row {
    /// The numbers of an optional group, if the row has them.
    pub(crate) fn optional<const N: usize>(&self, group: usize) -> Option<[f64; N]> {
        self.optional.get(group)?.as_deref()?.try_into().ok()
    }
}

impl Form {
    /// Reads a file.
    pub(crate) fn read<T>(&self, path: &Path, made: impl FnMut(&str, Row) -> Result<T, PointFileError>) -> Result<Vec<T>, PointFileError> {
        let name = path.display().to_string();
        let text = bounded::table(path).map_err(|error| as_a_whole(&name, &error))?;
        self.parse_text(&name, &text, made)
    }

    /// Reads a text and makes something of each row; `file` is its name in errors.
    pub(crate) fn parse<T>(
        &self,
        file: &str,
        input: impl Read,
        made: impl FnMut(&str, Row) -> Result<T, PointFileError>,
    ) -> Result<Vec<T>, PointFileError> {
        self.parse_text(file, &bounded::table_of(input).map_err(|error| as_a_whole(file, &error))?, made)
    }

    fn parse_text<T>(
        &self,
        file: &str,
        text: &[u8],
        mut made: impl FnMut(&str, Row) -> Result<T, PointFileError>,
    ) -> Result<Vec<T>, PointFileError> {
        let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::Headers).from_reader(text);
        let header = reader.headers().map_err(|error| csv_error(file, &error))?.clone();
        let places = self.places(file, &header)?;
        let (mut rows, mut seen, mut lines, mut record) = (Vec::new(), Names::default(), Vec::new(), StringRecord::new());
        while reader.read_record(&mut record).map_err(|error| csv_error(file, &error))? {
            let line = line_of(text, &record);
            let row = self.row(&Cells { file, places: &places, record: &record, line })?;
            let place = match self.partner {
                None => seen.place(&row.name),
                Some(_) => {
                    let pair = [row.name.as_str().min(&row.partner), row.name.as_str().max(&row.partner)];
                    seen.place(&format!("{:?}", [&row.group, pair[0], pair[1]]))
                }
            };
            if let Some(earlier) = lines.get(place) {
                let within = self.group.map_or_else(String::new, |group| format!(" in each {group}"));
                let problem = match self.partner {
                    None => format!("`{}` is already on line {earlier}; expected each {} once", row.name, self.key),
                    Some(_) => {
                        format!("`{}` and `{}` are already on line {earlier}; expected each pair once{within}", row.name, row.partner)
                    }
                };
                return Err(wrong(file, Some(line), Some(self.key), problem));
            }
            lines.push(line);
            rows.push(made(file, row)?);
        }
        let empty = || wrong(file, None, None, format!("holds no row; expected one for each {} below the header", self.key));
        if rows.is_empty() { Err(empty()) } else { Ok(rows) }
    }

    fn columns(&self) -> Vec<&'static str> {
        self.group.into_iter().chain([self.key]).chain(self.partner).chain(self.required.iter().copied()).collect()
    }

    fn places(&self, file: &str, header: &StringRecord) -> Result<HashMap<String, usize>, PointFileError> {
        let known = [self.columns(), self.optional.concat()].concat();
        let mut places = HashMap::new();
        for (index, name) in header.iter().enumerate() {
            if !known.contains(&name) && !self.others && !self.passed_over.contains(&name) {
                return Err(wrong(file, Some(1), Some(name), format!("unknown; {} has {}", self.what, known.join(", "))));
            }
            if places.insert(name.to_owned(), index).is_some() {
                return Err(wrong(file, Some(1), Some(name), "stands in the header twice".into()));
            }
        }
        if let Some(missing) = self.columns().into_iter().find(|name| !places.contains_key(*name)) {
            let problem = format!("missing in the header; every {} has {}", self.what, self.columns().join(","));
            return Err(wrong(file, Some(1), Some(missing), problem));
        }
        for group in self.optional {
            let absent: Vec<_> = group.iter().copied().filter(|name| !places.contains_key(*name)).collect();
            if !absent.is_empty() && absent.len() < group.len() {
                let problem = format!("missing in the header; these go together: {}", group.join(","));
                return Err(wrong(file, Some(1), Some(absent[0]), problem));
            }
        }
        Ok(places)
    }

    fn row(&self, cells: &Cells<'_>) -> Result<Row, PointFileError> {
        let named = |column: &str| {
            let name = cells.text(column).ok_or_else(|| cells.wrong(column, "is empty; expected a name".into()))?;
            Ok(escape::from_cell(name).to_owned())
        };
        let named_if = |column: Option<&str>| Ok::<_, PointFileError>(column.map(named).transpose()?.unwrap_or_default());
        let (group, name, partner) = (named_if(self.group)?, named(self.key)?, named_if(self.partner)?);
        let numbers = self.required.iter().map(|column| cells.number(column)).collect::<Result<_, _>>()?;
        let of = |columns: &&[&str]| {
            let given = columns.iter().any(|column| cells.text(column).is_some());
            given.then(|| columns.iter().map(|column| cells.number(column)).collect::<Result<_, _>>()).transpose()
        };
        let optional = self.optional.iter().map(of).collect::<Result<_, _>>()?;
        Ok(Row { line: cells.line, name, partner, group, numbers, optional })
    }
}

/// The largest coordinate, object units: the squares and products of larger ones lose their digits against all others.
const LARGEST: f64 = 1e12;

struct Cells<'a> {
    file: &'a str,
    places: &'a HashMap<String, usize>,
    record: &'a StringRecord,
    line: u64,
}

impl Cells<'_> {
    fn text(&self, column: &str) -> Option<&str> {
        self.places.get(column).and_then(|&index| self.record.get(index)).map(str::trim).filter(|text| !text.is_empty())
    }

    fn number(&self, column: &str) -> Result<f64, PointFileError> {
        let text = self.text(column).ok_or_else(|| self.wrong(column, "is empty; expected a number".into()))?;
        let number = text.parse::<f64>().ok().filter(|number| number.is_finite());
        let number = number.ok_or_else(|| self.wrong(column, format!("expected a finite number with a decimal point, found `{text}`")))?;
        if number.abs() <= LARGEST {
            Ok(number)
        } else {
            Err(self.wrong(column, format!("is beyond {LARGEST:e}, found `{text}`: no coordinate is")))
        }
    }

    fn wrong(&self, column: &str, problem: String) -> PointFileError {
        wrong(self.file, Some(self.line), Some(column), problem)
    }
}

/// An error with its place.
pub(crate) fn wrong(file: &str, line: Option<u64>, column: Option<&str>, problem: String) -> PointFileError {
    PointFileError { file: file.to_owned(), line, column: column.map(str::to_owned), problem }
}
