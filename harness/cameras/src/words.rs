//! Numbers between white space, however they stand in lines.

use crate::CameraFileError;
use crate::number::{finite, shortened};

/// What of a text is still to be read.
pub(crate) struct Words<'a> {
    rest: &'a str,
    /// The line of the word that was read last, counted from 1.
    line: usize,
}

impl<'a> Words<'a> {
    pub(crate) const fn new(text: &'a str) -> Self {
        Self { rest: text, line: 1 }
    }

    /// The next word; `what` is named if there is none.
    pub(crate) fn word(&mut self, what: &str) -> Result<&'a str, CameraFileError> {
        let begin = self.rest.find(|c: char| !c.is_ascii_whitespace()).unwrap_or(self.rest.len());
        self.line += self.rest[..begin].matches('\n').count();
        self.rest = &self.rest[begin..];
        if self.rest.is_empty() {
            return Err(CameraFileError::new(format!("ends before {what}; it was cut off or its counts are wrong")).on_line(self.line));
        }
        let end = self.rest.find(|c: char| c.is_ascii_whitespace()).unwrap_or(self.rest.len());
        let (word, rest) = self.rest.split_at(end);
        self.rest = rest;
        Ok(word)
    }

    /// The next word, a finite number.
    pub(crate) fn number(&mut self, what: &str) -> Result<f64, CameraFileError> {
        let word = self.word(what)?;
        finite(word).map_err(|error| self.wrong(error, what))
    }

    /// So many numbers.
    pub(crate) fn numbers<const N: usize>(&mut self, what: &str) -> Result<[f64; N], CameraFileError> {
        let mut found = [0.0; N];
        for slot in &mut found {
            *slot = self.number(what)?;
        }
        Ok(found)
    }

    /// The next word, a whole number from zero.
    pub(crate) fn whole(&mut self, what: &str) -> Result<usize, CameraFileError> {
        let word = self.word(what)?;
        let wrong = || CameraFileError::new(format!("expected a whole number, found `{}`", shortened(word)));
        word.parse().map_err(|_| self.wrong(wrong(), what))
    }

    /// A mistake in the word that was read last.
    pub(crate) fn wrong(&self, error: CameraFileError, what: &str) -> CameraFileError {
        error.on_line(self.line).of(what)
    }

    /// That nothing follows.
    pub(crate) fn ends(mut self) -> Result<(), CameraFileError> {
        match self.word("") {
            Err(_) => Ok(()),
            Ok(word) => Err(CameraFileError::new(format!("expected the end of the file, found `{}`", shortened(word))).on_line(self.line)),
        }
    }
}
