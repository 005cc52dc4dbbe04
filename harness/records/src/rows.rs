//! Rows of a CSV file of records, read without a copy of each cell.

use std::collections::HashMap;
use std::io::{self, Read};
use std::sync::Arc;

use memchr::{memchr, memchr_iter};

use crate::cells::{Cells, RecordError};

/// What is read at once, bytes.
const BLOCK: usize = 1 << 16;

/// A file whose header has been checked, row by row.
pub(crate) struct Rows<'c, R> {
    input: R,
    columns: &'c [&'c str],
    /// What is read lies between `start` and `end`.
    buffer: Vec<u8>,
    start: usize,
    end: usize,
    /// The line at `start`, counted from 1.
    line: u64,
    /// A row in which quotes are doubled, with single ones.
    plain: String,
    /// Where its cells begin and end.
    spans: Vec<(usize, usize)>,
}

impl<'c, R: Read> Rows<'c, R> {
    /// Reads the header.
    ///
    /// # Errors
    /// What cannot be read, another header than `columns`.
    pub(crate) fn new(input: R, columns: &'c [&'c str]) -> Result<Self, RecordError> {
        let (plain, spans) = (String::new(), Vec::with_capacity(columns.len()));
        let mut rows = Self { input, columns, buffer: vec![0; BLOCK], start: 0, end: 0, line: 1, plain, spans };
        let is_header = rows.row()?.is_some_and(|header| (0..columns.len()).all(|column| header.text(column) == columns[column]));
        if !is_header || rows.spans.len() != columns.len() {
            return Err(RecordError::Row { line: 1, problem: format!("expected the columns {}", columns.join(",")) });
        }
        Ok(rows)
    }

    /// The next row; `None` at the end.
    ///
    /// # Errors
    /// What cannot be read, a row of more or fewer cells than the header has.
    pub(crate) fn next(&mut self) -> Result<Option<Cells<'_>>, RecordError> {
        let wanted = self.columns.len();
        let Some(row) = self.row()? else { return Ok(None) };
        let found = row.count();
        if found == wanted { Ok(Some(row)) } else { Err(row.wrong(&format!("found {found} cells, expected {wanted}"))) }
    }

    /// The next row that is not empty, however many cells it has.
    fn row(&mut self) -> Result<Option<Cells<'_>>, RecordError> {
        let (from, to, is_quoted) = loop {
            let Some((length, quotes)) = self.length().map_err(csv::Error::from)? else { return Ok(None) };
            let from = self.start;
            self.start += length;
            let row = &self.buffer[from..self.start];
            let row = row.strip_suffix(b"\n").unwrap_or(row);
            let row = row.strip_suffix(b"\r").unwrap_or(row);
            if !row.is_empty() {
                break (from, from + row.len(), quotes > 0);
            }
            self.line += 1;
        };
        let line = self.line;
        let row = &self.buffer[from..to];
        self.line += memchr_iter(b'\n', &self.buffer[from..self.start]).count().max(1) as u64;
        let row = std::str::from_utf8(row).map_err(|_| RecordError::Row { line, problem: "not UTF-8".into() })?;
        self.spans.clear();
        let text = if !is_quoted {
            split(row, &mut self.spans);
            row
        } else if split_quoted(row, &mut self.spans) {
            row
        } else {
            (self.plain, self.spans) = unquoted(row);
            &self.plain
        };
        Ok(Some(Cells { text, spans: &self.spans, line, columns: self.columns }))
    }

    /// The bytes of the next row with what ends it, and how many quotes are in it: a line break between quotes is part of a cell.
    fn length(&mut self) -> io::Result<Option<(usize, usize)>> {
        let (mut seen, mut quotes) = (0, 0);
        loop {
            let new = &self.buffer[self.start + seen..self.end];
            let found = memchr(b'\n', new);
            let part = &new[..found.map_or(new.len(), |at| at + 1)];
            quotes += memchr_iter(b'"', part).count();
            seen += part.len();
            if found.is_some() && quotes.is_multiple_of(2) {
                return Ok(Some((seen, quotes)));
            }
            if found.is_none() && !self.fill()? {
                return Ok((seen > 0).then_some((seen, quotes)));
            }
        }
    }

    /// Reads on; whether there was more.
    fn fill(&mut self) -> io::Result<bool> {
        self.buffer.copy_within(self.start..self.end, 0);
        (self.start, self.end) = (0, self.end - self.start);
        if self.end == self.buffer.len() {
            self.buffer.resize(2 * self.buffer.len(), 0);
        }
        loop {
            match self.input.read(&mut self.buffer[self.end..]) {
                Ok(count) => {
                    self.end += count;
                    return Ok(count > 0);
                }
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
    }
}

/// The cells of a row in which nothing is quoted.
fn split(row: &str, spans: &mut Vec<(usize, usize)>) {
    let mut start = 0;
    for comma in memchr_iter(b',', row.as_bytes()) {
        spans.push((start, comma));
        start = comma + 1;
    }
    spans.push((start, row.len()));
}

/// The cells of a row in which cells are quoted, without their quotes; whether they are all there: not where a quote is doubled or stands alone.
fn split_quoted(row: &str, spans: &mut Vec<(usize, usize)>) -> bool {
    let bytes = row.as_bytes();
    let mut start = 0;
    loop {
        let end = if bytes.get(start) == Some(&b'"') {
            let Some(length) = memchr(b'"', &bytes[start + 1..]) else { return false };
            let close = start + 1 + length;
            spans.push((start + 1, close));
            close + 1
        } else {
            let end = memchr(b',', &bytes[start..]).map_or(bytes.len(), |length| start + length);
            spans.push((start, end));
            end
        };
        match bytes.get(end) {
            None => return true,
            Some(b',') => start = end + 1,
            Some(_) => return false,
        }
    }
}

/// The cells of a row one after the other, and where each begins and ends. A doubled quote in a quoted cell is one.
fn unquoted(row: &str) -> (String, Vec<(usize, usize)>) {
    let (mut plain, mut spans, mut rest) = (String::with_capacity(row.len()), Vec::new(), row);
    loop {
        let start = plain.len();
        if let Some(quoted) = rest.strip_prefix('"') {
            rest = quoted;
            loop {
                // Without an end it goes as far as the file.
                let (inside, after) = rest.split_once('"').unwrap_or((rest, ""));
                plain.push_str(inside);
                rest = after;
                let Some(more) = rest.strip_prefix('"') else { break };
                plain.push('"');
                rest = more;
            }
        }
        let (cell, after) = rest.split_once(',').map_or((rest, None), |(cell, after)| (cell, Some(after)));
        plain.push_str(cell);
        spans.push((start, plain.len()));
        match after {
            None => return (plain, spans),
            Some(after) => rest = after,
        }
    }
}

/// Names, each of which is kept once. They come in the same order again and again: the one that is next is tried first, after the one that was last.
#[derive(Default)]
pub(crate) struct Names {
    order: Vec<Arc<str>>,
    places: HashMap<Arc<str>, usize>,
    last: usize,
}

impl Names {
    pub(crate) fn get(&mut self, name: &str) -> Arc<str> {
        for guess in [self.last, self.last + 1] {
            if self.order.get(guess).is_some_and(|known| **known == *name) {
                self.last = guess;
                return self.order[guess].clone();
            }
        }
        self.last = self.places.get(name).copied().unwrap_or_else(|| {
            let new: Arc<str> = name.into();
            self.order.push(new.clone());
            self.places.insert(new, self.order.len() - 1);
            self.order.len() - 1
        });
        self.order[self.last].clone()
    }
}

/// The number nearest to a decimal one, as [`str::parse`] finds it. Of up to 2^53 and a power of ten that is exact one division is right by itself (Clinger 1990).
pub(crate) fn decimal(text: &str) -> Option<f64> {
    short(text.as_bytes()).or_else(|| text.parse().ok())
}

/// Powers of ten that are exact.
const POWERS: [f64; 23] =
    [1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22];
/// As many bytes hold no more digits than 64 bits do.
const MOST: usize = 18;

fn short(bytes: &[u8]) -> Option<f64> {
    let (is_negative, bytes) = bytes.strip_prefix(b"-").map_or((false, bytes), |rest| (true, rest));
    let (mut value, mut power, mut digits, mut is_fraction) = (0_u64, 0_i32, 0, false);
    let mut rest = bytes;
    while let [byte, after @ ..] = rest {
        match byte {
            b'0'..=b'9' if digits < MOST => {
                value = 10 * value + u64::from(byte - b'0');
                power -= i32::from(is_fraction);
                digits += 1;
            }
            b'.' if !is_fraction => is_fraction = true,
            b'e' if digits > 0 => {
                power += exponent(after)?;
                break;
            }
            _ => return None,
        }
        rest = after;
    }
    if digits == 0 || value > 1 << 53 {
        return None;
    }
    let scale = POWERS.get(power.unsigned_abs() as usize)?;
    let size = if power < 0 { value as f64 / scale } else { value as f64 * scale };
    Some(if is_negative { -size } else { size })
}

/// Of at most two digits.
fn exponent(bytes: &[u8]) -> Option<i32> {
    let (sign, digits) = match bytes {
        [b'-', digits @ ..] => (-1, digits),
        [b'+', digits @ ..] => (1, digits),
        digits => (1, digits),
    };
    let digit = |byte: u8| byte.is_ascii_digit().then(|| i32::from(byte - b'0'));
    match *digits {
        [one] => Some(sign * digit(one)?),
        [ten, one] => Some(sign * (10 * digit(ten)? + digit(one)?)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Hands on so many bytes at once.
    struct Slow<'a>(&'a [u8], usize);

    impl Read for Slow<'_> {
        fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
            let count = self.1.min(self.0.len()).min(into.len());
            into[..count].copy_from_slice(&self.0[..count]);
            self.0 = &self.0[count..];
            Ok(count)
        }
    }

    fn read(bytes: &[u8], at_once: usize) -> Result<Vec<(u64, Vec<String>)>, String> {
        let mut rows = Rows::new(Slow(bytes, at_once), &["a", "b", "c"]).map_err(|error| error.to_string())?;
        let mut all = Vec::new();
        while let Some(row) = rows.next().map_err(|error| error.to_string())? {
            all.push((row.line(), (0..3).map(|column| row.text(column).to_owned()).collect()));
        }
        Ok(all)
    }

    /// As the crate that writes records reads them.
    fn known(bytes: &[u8]) -> Vec<(u64, Vec<String>)> {
        let mut csv = csv::Reader::from_reader(bytes);
        let row = |row: csv::StringRecord| (row.position().unwrap().line(), row.iter().map(str::to_owned).collect());
        csv.records().map(|record| row(record.unwrap())).collect()
    }

    #[test]
    fn rows_are_those_of_any_reader_of_csv() {
        let long = "x".repeat(3 * BLOCK);
        let texts = [
            "a,b,c\n1,2,3\n,,\n\u{e9},\u{1f4f7},z\n".to_owned(),
            "a,b,c\r\n1,2,3\r\n\r\n\n4,5,6".to_owned(),
            "a,b,c\n\"1,5\",\"say \"\"no\"\"\",\"two\nlines\"\n4,\"\",\"\"\"\"\n7,8,9\n".to_owned(),
            format!("a,b,c\n{long},1,\"{long}\"\n2,3,4\n"),
            "a,b,c\n".to_owned(),
        ];
        for text in &texts {
            for at_once in [1, 7, 1 << 20] {
                if at_once == 1 && text.len() > BLOCK {
                    continue;
                }
                assert_eq!(read(text.as_bytes(), at_once).unwrap(), known(text.as_bytes()), "{at_once}: {}", &text[..20.min(text.len())]);
            }
        }
    }

    #[test]
    fn what_is_no_such_file_is_told_with_its_line() {
        for (bytes, expected) in [
            (&b""[..], "line 1: expected the columns a,b,c"),
            (b"a,b\n", "line 1: expected the columns a,b,c"),
            (b"a,b,d\n", "line 1: expected the columns a,b,c"),
            (b"a,b,c,d\n", "line 1: expected the columns a,b,c"),
            (b"a,b,c\n1,2,3\n\n1,2\n", "line 4: found 2 cells, expected 3"),
            (b"a,b,c\n1,\"2\n2\",3\n1,2,3,4\n", "line 4: found 4 cells, expected 3"),
            (b"a,b,c\n1,\xff,3\n", "line 2: not UTF-8"),
            (b"a,b,c\n1,\"2,3\n4,5,6\n", "line 2: found 2 cells, expected 3"),
        ] {
            let found = read(bytes, 64).unwrap_err();
            assert!(found.starts_with(expected), "{found}");
        }
    }

    #[test]
    fn a_name_is_kept_once_in_whatever_order_it_comes() {
        let mut names = Names::default();
        let came = ["a", "b", "c", "a", "b", "c", "b", "b", "a", "", "c", "d", "a"];
        let kept: Vec<Arc<str>> = came.iter().map(|name| names.get(name)).collect();
        for (a, name) in kept.iter().zip(came) {
            assert_eq!(&**a, name);
            assert!(kept.iter().all(|b| Arc::ptr_eq(a, b) == (a == b)));
        }
    }

    #[test]
    fn numbers_are_those_that_parse_finds() {
        let mut state = 7_u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            state >> 11
        };
        for _ in 0..20_000 {
            let (bits, digits) = (next(), next() % 12);
            let value = (bits as f64 / (1_u64 << 52) as f64 - 0.5) * 10_f64.powi(digits as i32 - 6);
            for text in [
                format!("{value:.9}"),
                format!("{value:.8e}"),
                value.to_string(),
                format!("{value:.*}", digits as usize),
                format!("{bits}"),
            ] {
                assert_eq!(decimal(&text).map(f64::to_bits), text.parse().ok().map(f64::to_bits), "{text}");
            }
        }
        for text in [
            "",
            "-",
            ".",
            "-.",
            "5.",
            ".5",
            "-0",
            "0.0",
            "1e",
            "1e+",
            "1e5",
            "1E5",
            "+1",
            "1e-400",
            "1e999",
            "inf",
            "NaN",
            "1_0",
            "1.2.3",
            "e5",
            " 1",
            "0x1",
            "9007199254740993",
            "123456789012345678901",
            "1e22",
            "1e23",
            "1e-22",
            "0.1e2",
        ] {
            assert_eq!(decimal(text).map(f64::to_bits), text.parse::<f64>().ok().map(f64::to_bits), "{text}");
        }
    }
}
