//! The lines of a text, of which one is in memory at a time.

use std::io::{BufRead, Read};

use super::{CameraFileError, Stop};

/// The longest line, bytes.
const LONGEST: u64 = 1 << 16;

/// Lines that are still to be read.
pub(super) struct Lines<R> {
    source: R,
    line: Vec<u8>,
    /// Lines so far.
    number: usize,
    /// The byte at which the next line begins.
    at: u64,
}

impl<R: BufRead> Lines<R> {
    /// Those of a text from its beginning; a byte order mark is none of it.
    pub fn new(source: R) -> Self {
        Self { source, line: Vec::new(), number: 0, at: 0 }
    }

    /// The number of the last line, counted from 1; 0 before the first.
    pub fn number(&self) -> usize {
        self.number
    }

    /// The byte at which the next line begins.
    pub fn at(&self) -> u64 {
        self.at
    }

    /// The next line, with its end.
    ///
    /// # Errors
    /// What is no text, with the line; a line that is too long for this.
    pub fn next(&mut self) -> Result<Option<&str>, Stop> {
        self.line.clear();
        let found = self.source.by_ref().take(LONGEST + 1).read_until(b'\n', &mut self.line)?;
        if found == 0 {
            return Ok(None);
        }
        self.number += 1;
        self.at += found as u64;
        if found as u64 > LONGEST {
            return Err(Stop::Whole(format!("line {} is longer than {LONGEST} bytes", self.number)));
        }
        let wrong = |what: &str| Stop::from(CameraFileError::new(format!("expected text{what}")).on_line(self.number));
        let text = std::str::from_utf8(&self.line).map_err(|_| wrong(" in UTF-8, found other bytes"))?;
        if text.contains('\0') {
            return Err(wrong(", found a zero byte"));
        }
        Ok(Some(if self.number == 1 { text.strip_prefix('\u{feff}').unwrap_or(text) } else { text }))
    }

    /// Passes over a line of numbers, however long.
    ///
    /// # Errors
    /// Bytes that no number has.
    pub fn pass(&mut self) -> Result<(), Stop> {
        loop {
            let bytes = self.source.fill_buf()?;
            let end = bytes.iter().position(|byte| *byte == b'\n');
            let line = &bytes[..end.unwrap_or(bytes.len())];
            if !line.is_ascii() || line.contains(&0) {
                return Err(Stop::Whole(format!("line {} holds more than numbers", self.number + 1)));
            }
            let (passed, is_end) = (line.len() + usize::from(end.is_some()), end.is_some() || bytes.is_empty());
            self.source.consume(passed);
            self.at += passed as u64;
            if is_end {
                self.number += 1;
                return Ok(());
            }
        }
    }
}
