//! Trees of values with names, as YAML, XML, JSON and Python's literals have them.

use calibench_model::camera::ImageSize;

use super::CameraFileError;
use super::number::{finite, pixels, shortened};

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

impl Entry {
    /// The entry that has one of these names; two of them contradict each other.
    ///
    /// # Errors
    /// An entry without names, or with two of `names`.
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
    ///
    /// # Errors
    /// An entry that is no scalar.
    pub fn text(&self) -> Result<&str, CameraFileError> {
        match &self.value {
            Value::Scalar(text) => Ok(text.trim().trim_matches('"')),
            Value::List(_) | Value::Map(_) => Err(self.wrong("expected one value")),
        }
    }

    /// An error at this entry.
    pub fn wrong(&self, problem: &str) -> CameraFileError {
        CameraFileError::new(problem).on_line(self.line)
    }

    /// The entry called `name`, if there is one.
    ///
    /// # Errors
    /// An entry without names.
    pub fn key(&self, name: &str) -> Result<Option<&Self>, CameraFileError> {
        Ok(self.get(&[name])?.map(|(_, entry)| entry))
    }

    /// The entry called `name`.
    ///
    /// # Errors
    /// An entry without names, or without this one.
    pub fn required(&self, name: &str) -> Result<&Self, CameraFileError> {
        self.key(name)?.ok_or_else(|| self.wrong(&format!("has no `{name}`")))
    }

    /// Names and values.
    ///
    /// # Errors
    /// An entry without names.
    pub fn entries(&self) -> Result<&[(String, Self)], CameraFileError> {
        match &self.value {
            Value::Map(entries) => Ok(entries),
            Value::Scalar(_) | Value::List(_) => Err(self.wrong("expected names with values")),
        }
    }

    /// Values in a row.
    ///
    /// # Errors
    /// An entry that is no list.
    pub fn items(&self) -> Result<&[Self], CameraFileError> {
        match &self.value {
            Value::List(items) => Ok(items),
            Value::Scalar(_) | Value::Map(_) => Err(self.wrong("expected values in a row")),
        }
    }

    /// A finite number.
    ///
    /// # Errors
    /// An entry that is no scalar, or not a finite number.
    pub fn number(&self) -> Result<f64, CameraFileError> {
        finite(self.text()?).map_err(|error| error.on_line(self.line))
    }

    /// The number called `name`.
    ///
    /// # Errors
    /// A name that is missing, a value that is not a finite number.
    pub fn number_of(&self, name: &str) -> Result<f64, CameraFileError> {
        self.required(name)?.number().map_err(|error| error.of(name))
    }

    /// The number called `name`, or zero without it.
    ///
    /// # Errors
    /// A value that is not a finite number.
    pub fn number_or_zero(&self, name: &str) -> Result<f64, CameraFileError> {
        self.key(name)?.map_or(Ok(0.0), |entry| entry.number().map_err(|error| error.of(name)))
    }

    /// The text called `name`.
    ///
    /// # Errors
    /// A name that is missing, a value that is no scalar.
    pub fn text_of(&self, name: &str) -> Result<&str, CameraFileError> {
        self.required(name)?.text().map_err(|error| error.of(name))
    }

    /// Numbers in a row.
    ///
    /// # Errors
    /// An entry that is no list, a value that is not a finite number.
    pub fn row(&self) -> Result<Vec<f64>, CameraFileError> {
        self.items()?.iter().map(Self::number).collect()
    }

    /// Exactly `N` numbers in the row called `name`.
    ///
    /// # Errors
    /// A name that is missing, another count than `N`, a value that is not a finite number.
    pub fn row_of<const N: usize>(&self, name: &str) -> Result<[f64; N], CameraFileError> {
        let entry = self.required(name)?;
        let row = entry.row().map_err(|error| error.of(name))?;
        let found = row.len();
        row.try_into().map_err(|_| entry.wrong(&format!("expected {N} numbers, found {found}")).of(name))
    }

    /// Rows of numbers.
    ///
    /// # Errors
    /// An entry that is no list of lists of finite numbers.
    pub fn rows(&self) -> Result<Vec<Vec<f64>>, CameraFileError> {
        self.items()?.iter().map(Self::row).collect()
    }

    /// The size in two numbers of pixels.
    ///
    /// # Errors
    /// A name that is missing, a value that is no whole number of pixels.
    pub fn size_of(&self, width: &str, height: &str) -> Result<ImageSize, CameraFileError> {
        let side = |name: &str| {
            let entry = self.required(name)?;
            pixels(entry.text()?).map_err(|error| error.on_line(entry.line).of(name))
        };
        Ok(ImageSize { width: side(width)?, height: side(height)? })
    }

    /// The size in a row of two numbers.
    ///
    /// # Errors
    /// A name that is missing, another count than two, a value that is no whole number of pixels.
    pub fn size_in(&self, name: &str) -> Result<ImageSize, CameraFileError> {
        let entry = self.required(name)?;
        let side = |side: &Self| pixels(side.text()?).map_err(|error| error.on_line(side.line).of(name));
        match entry.items()? {
            [width, height] => Ok(ImageSize { width: side(width)?, height: side(height)? }),
            other => Err(entry.wrong(&format!("expected columns and rows, found {} values", other.len())).of(name)),
        }
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

/// Names that a note quotes at most.
const MOST_QUOTED: usize = 20;

/// A note on names that were not understood or have no place here, if there are any.
pub(super) fn all_left_out<'a>(names: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut names: Vec<String> = names.map(|name| format!("`{}`", shortened(name))).collect();
    let count = names.len();
    names.truncate(MOST_QUOTED);
    let more = if count > MOST_QUOTED { format!(" and {} more", count - MOST_QUOTED) } else { String::new() };
    let verb = if count == 1 { "was" } else { "were" };
    if count == 0 { Vec::new() } else { vec![format!("{}{more} {verb} left out", names.join(", "))] }
}

/// A note on a name that was not understood or has no place here.
pub(super) fn left_out(name: &str) -> String {
    format!("`{}` was left out", shortened(name))
}
