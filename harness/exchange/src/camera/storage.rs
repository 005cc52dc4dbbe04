//! What OpenCV's FileStorage holds, in YAML or XML alike.

use super::CameraFileError;
use super::number::{finite, shortened};

/// A value of a file and where it stands.
#[derive(Debug)]
pub(super) struct Entry {
    pub line: usize,
    pub value: Value,
}

/// A value.
#[derive(Debug)]
pub(super) enum Value {
    /// A number or a text; in XML the numbers of a matrix, too.
    Scalar(String),
    /// Values in a row.
    List(Vec<Entry>),
    /// Values with names, each once.
    Map(Vec<(String, Entry)>),
}

/// A matrix of numbers.
#[derive(Debug)]
pub(super) struct Matrix {
    pub rows: usize,
    pub columns: usize,
    /// Row by row.
    pub data: Vec<f64>,
}

impl Entry {
    /// The entry that has one of these names; two of them contradict each other.
    pub fn get<'a>(&'a self, names: &[&str]) -> Result<Option<(&'a str, &'a Self)>, CameraFileError> {
        let Value::Map(entries) = &self.value else { return Err(self.wrong("expected names with values")) };
        let mut found = entries.iter().filter(|(name, _)| names.contains(&name.as_str()));
        let first = found.next();
        match (first, found.next()) {
            (Some((one, _)), Some((name, other))) => Err(other.wrong(&format!("says again what `{one}` said")).of(name)),
            _ => Ok(first.map(|(name, entry)| (name.as_str(), entry))),
        }
    }

    /// The text of a scalar.
    pub fn text(&self) -> Result<&str, CameraFileError> {
        match &self.value {
            Value::Scalar(text) => Ok(text.trim().trim_matches('"')),
            Value::List(_) | Value::Map(_) => Err(self.wrong("expected one value")),
        }
    }

    /// The matrix: `rows`, `cols`, `dt` and as many numbers in `data`; at most `most`.
    pub fn matrix(&self, most: usize) -> Result<Matrix, CameraFileError> {
        let part = |name: &str| self.get(&[name])?.ok_or_else(|| self.wrong(&format!("has no `{name}`; expected rows, cols, dt, data")));
        let side = |name: &str| {
            let (_, entry) = part(name)?;
            let wrong = || entry.wrong("expected a whole number from 1").of(name);
            entry.text()?.parse::<usize>().ok().filter(|&n| n > 0).ok_or_else(wrong)
        };
        let (rows, columns) = (side("rows")?, side("cols")?);
        let count = rows.checked_mul(columns).filter(|&count| count <= most);
        let count = count.ok_or_else(|| self.wrong(&format!("is {rows} x {columns}; expected no more than {most} numbers")))?;
        let (_, kind) = part("dt")?;
        let single = match kind.text()? {
            "d" => false,
            "f" => true,
            other => return Err(kind.wrong(&format!("expected d or f, found `{}`", shortened(other))).of("dt")),
        };
        let (_, data) = part("data")?;
        let data = data.numbers(count, &format!("{rows} x {columns}"), single).map_err(|error| error.of("data"))?;
        Ok(Matrix { rows, columns, data })
    }

    fn numbers(&self, count: usize, shape: &str, single: bool) -> Result<Vec<f64>, CameraFileError> {
        let one = |line: usize, word: &str| {
            let number = finite(word).map_err(|error| error.on_line(line))?;
            // What the file's own tool would hold.
            Ok(if single { f64::from(number as f32) } else { number })
        };
        let wrong = |found: usize| Err(self.wrong(&format!("expected {count} numbers for {shape}, found {found}")));
        match &self.value {
            Value::Scalar(text) => match text.split_whitespace().count() {
                found if found == count => text.split_whitespace().map(|word| one(self.line, word)).collect(),
                found => wrong(found),
            },
            Value::List(list) if list.len() == count => list.iter().map(|entry| one(entry.line, entry.text()?)).collect(),
            Value::List(list) => wrong(list.len()),
            Value::Map(_) => Err(self.wrong("expected numbers")),
        }
    }

    /// An error at this entry.
    pub fn wrong(&self, problem: &str) -> CameraFileError {
        CameraFileError::new(problem).on_line(self.line)
    }
}

/// `entries` as a map; a name that stands twice is a mistake.
pub(super) fn map(entries: Vec<(String, Entry)>) -> Result<Value, CameraFileError> {
    let mut names: Vec<(&str, usize)> = entries.iter().map(|(name, entry)| (name.as_str(), entry.line)).collect();
    names.sort_unstable();
    if let Some(pair) = names.windows(2).find(|pair| pair[0].0 == pair[1].0) {
        let problem = format!("stands twice, first on line {}", pair[0].1);
        return Err(CameraFileError::new(problem).on_line(pair[1].1).of(shortened(pair[1].0)));
    }
    Ok(Value::Map(entries))
}
