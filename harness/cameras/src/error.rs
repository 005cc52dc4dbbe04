//! What is wrong with a camera file, and where.

use calibench_model::escape;
use thiserror::Error;

/// What is wrong with a camera file, and where.
#[derive(Clone, Debug, Default, Error, PartialEq, Eq)]
#[error("{}{place}: {}", escape::name(file), escape::name(problem), place = escape::name(&self.place()))]
pub struct CameraFileError {
    /// The file.
    pub file: String,
    /// The line, counted from 1, where known.
    pub line: Option<u32>,
    /// The column, counted from 1, where known.
    pub column: Option<u32>,
    /// The element or key, where one is meant.
    pub element: Option<String>,
    /// What was expected and what was found.
    pub problem: String,
}

impl CameraFileError {
    /// A mistake whose place is not known yet.
    pub(super) fn new(problem: impl Into<String>) -> Self {
        Self { problem: problem.into(), ..Self::default() }
    }

    pub(super) fn on_line(self, line: usize) -> Self {
        Self { line: Some(line as u32), ..self }
    }

    pub(super) fn in_column(self, column: usize) -> Self {
        Self { column: Some(column as u32), ..self }
    }

    pub(super) fn of(self, element: impl Into<String>) -> Self {
        Self { element: Some(element.into()), ..self }
    }

    /// With the name of what holds the element.
    pub(super) fn in_key(self, key: &str) -> Self {
        let element = self.element.as_ref().map_or_else(|| key.to_owned(), |inner| format!("{key}.{inner}"));
        self.of(element)
    }

    pub(super) fn in_file(self, file: &str) -> Self {
        Self { file: file.to_owned(), ..self }
    }

    fn place(&self) -> String {
        let mut place = String::new();
        for number in [self.line, self.column].into_iter().flatten() {
            place.push_str(&format!(":{number}"));
        }
        if let Some(element) = &self.element {
            place.push_str(&format!(", `{element}`"));
        }
        place
    }
}
