//! Rows of CSV as bytes.

use std::io::{self, Write};

use calibench_model::escape;

/// Rows that are written cell by cell.
#[derive(Debug, Default)]
pub struct Row {
    bytes: Vec<u8>,
    cells: usize,
}

impl Row {
    /// A name or a word, as [`escape::cell`] has it, quoted where it must be.
    pub fn text(&mut self, text: &str) {
        self.next();
        let cell = escape::cell(text);
        if !cell.contains([',', '"', '\n', '\r']) {
            return self.bytes.extend_from_slice(cell.as_bytes());
        }
        self.bytes.push(b'"');
        self.bytes.extend_from_slice(cell.replace('"', "\"\"").as_bytes());
        self.bytes.push(b'"');
    }

    /// A number with the fewest digits from which it is read back, without an exponent: as `{number}` writes it.
    pub fn number(&mut self, number: f64) {
        self.next();
        let mut buffer = ryu::Buffer::new();
        let shortest = buffer.format(number);
        if number.is_finite() && !shortest.contains('e') && !is_halfway(number, shortest) {
            self.bytes.extend_from_slice(shortest.strip_suffix(".0").unwrap_or(shortest).as_bytes());
        } else {
            let _ = write!(self.bytes, "{number}");
        }
    }

    /// A number of things.
    pub fn whole(&mut self, number: usize) {
        self.next();
        let _ = write!(self.bytes, "{number}");
    }

    fn next(&mut self) {
        if self.cells > 0 {
            self.bytes.push(b',');
        }
        self.cells += 1;
    }

    pub(super) fn end(&mut self, expected: usize) -> io::Result<()> {
        let cells = std::mem::take(&mut self.cells);
        // A lone empty cell would be an empty line, which readers pass over.
        if cells == 1 && self.bytes.last().is_none_or(|byte| *byte == b'\n') {
            self.bytes.extend_from_slice(b"\"\"");
        }
        self.bytes.push(b'\n');
        let wrong = || io::Error::new(io::ErrorKind::InvalidData, format!("a row of {cells} cells below a header of {expected}"));
        if cells == expected { Ok(()) } else { Err(wrong()) }
    }

    pub(super) fn bytes(&self) -> &[u8] {
        &self.bytes
    }
}

/// Whether a number lies halfway between two that are as short as `shortest`, of which others may write the other one: in decimals it has one digit more, a 5.
fn is_halfway(number: f64, shortest: &str) -> bool {
    let decimals = shortest.split_once('.').map_or(0, |(_, decimals)| decimals.len() as i32);
    let bits = number.to_bits();
    let (exponent, mantissa) = ((bits >> 52 & 0x7ff) as i32, bits & ((1 << 52) - 1) | 1 << 52);
    // So many binary places it has, and as many decimals.
    let places = 1075 - exponent - mantissa.trailing_zeros() as i32;
    places == decimals + 1
}
