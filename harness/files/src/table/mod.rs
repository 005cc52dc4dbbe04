//! Tables as CSV.

use std::io::{self, Write};

pub use csv_row::Row;

use crate::pipelined::pipelined;

mod csv_row;

/// Rows that one thread writes at a time.
const PIECE: usize = 1 << 10;
/// Pieces that wait in memory.
const BATCH: usize = 64;
/// Bytes that are handed on at once.
const LONG: usize = 1 << 14;

/// Writes a header and rows, each with as many cells, names as [`escape::cell`](calibench_model::escape::cell) has them: the readers of points, control and stations undo that.
///
/// # Errors
/// What the output refuses; a row with another number of cells than the header.
pub fn write_table<R>(mut output: impl Write, columns: &[&str], rows: impl IntoIterator<Item = R>) -> io::Result<()>
where
    R: IntoIterator<Item: AsRef<str>>,
{
    let mut piece = header(columns)?;
    for row in rows {
        row.into_iter().for_each(|cell| piece.text(cell.as_ref()));
        piece.end(columns.len())?;
        if piece.bytes().len() >= LONG {
            output.write_all(piece.bytes())?;
            piece = Row::default();
        }
    }
    output.write_all(piece.bytes())?;
    output.flush()
}

fn header(columns: &[&str]) -> io::Result<Row> {
    let mut header = Row::default();
    columns.iter().for_each(|column| header.text(column));
    header.end(columns.len())?;
    Ok(header)
}

/// Writes a header and `count` rows: [`write_made_rows`] of their numbers.
///
/// # Errors
/// As [`write_made_rows`].
pub fn write_rows(output: impl Write, columns: &[&str], count: usize, row: impl Fn(usize, &mut Row) + Sync) -> io::Result<()> {
    write_made_rows(output, columns, 0..count, |index, cells| row(*index, cells))
}

/// Writes a header and a row for each of `given`, made by `row` on all threads; the bytes do not depend on how many there are, and are those of [`write_table`].
///
/// # Errors
/// What the output refuses; a row with another number of cells than the header.
pub fn write_made_rows<R: Send>(
    mut output: impl Write,
    columns: &[&str],
    given: impl IntoIterator<Item = R>,
    row: impl Fn(&R, &mut Row) + Sync,
) -> io::Result<()> {
    let piece = |given: Vec<R>| {
        let mut piece = Row::default();
        for one in &given {
            row(one, &mut piece);
            piece.end(columns.len())?;
        }
        Ok(piece)
    };
    output.write_all(header(columns)?.bytes())?;
    let mut given = given.into_iter().fuse();
    let pieces = std::iter::from_fn(|| Some(given.by_ref().take(PIECE).collect()).filter(|piece: &Vec<R>| !piece.is_empty()));
    pipelined(pieces, BATCH, piece, |piece| output.write_all(piece.bytes()))?;
    output.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_as_long_as_the_header() {
        let mut text = Vec::new();
        write_table(&mut text, &["a", "b"], [["1", "x,y"]]).unwrap();
        assert_eq!(text, b"a,b\n1,\"x,y\"\n");
        text.clear();
        write_table(&mut text, &["a", "b"], [["=cmd", "-1.5"]]).unwrap();
        assert_eq!(text, b"a,b\n'=cmd,-1.5\n");
        assert!(write_table(&mut text, &["a", "b"], [["1"]]).is_err());
    }

    /// Half of the coordinates from 512 px on that were single precision lie halfway between two of 16 digits.
    #[test]
    fn the_last_digit_is_that_of_others_who_write_the_number() {
        let mut one = Row::default();
        let singles = (0..1 << 14).map(|i| f64::from(512.0_f32 + (i * 509) as f32 / 16384.0));
        let others =
            [600.0 + 2f64.powi(-14), -600.0 - 2f64.powi(-14), 2f64.powi(-14), 1.5, 0.0, -0.0, 9_007_199_254_740_991.0, 2f64.powi(60)];
        let written: Vec<f64> = singles.chain(others).collect();
        written.iter().for_each(|number| one.number(*number));
        let expected: Vec<String> = written.iter().map(f64::to_string).collect();
        assert_eq!(String::from_utf8(one.bytes().to_vec()).unwrap(), expected.join(","));
    }

    #[test]
    fn rows_made_on_all_threads_are_the_same_bytes() {
        let columns = ["name", "number", "count", "empty"];
        let name = |i: usize| ["a", "=b", "c,d", "e\"f", "", "g h", "two\nlines", "\u{e9}"][i % 8];
        let number = |i: usize| f64::from_bits((i as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15));
        let count = 3 * PIECE * BATCH / 2 + 7;
        let (mut together, mut one) = (Vec::new(), Vec::new());
        let row = |i: usize, row: &mut Row| {
            row.text(name(i));
            row.number(number(i));
            row.whole(i);
            row.text("");
        };
        write_rows(&mut together, &columns, count, row).unwrap();
        let cells = (0..count).map(|i| [name(i).to_owned(), number(i).to_string(), i.to_string(), String::new()]);
        write_table(&mut one, &columns, cells).unwrap();
        let first = together.split(|byte| *byte == b'\n').zip(one.split(|byte| *byte == b'\n')).find(|(a, b)| a != b);
        assert_eq!(first.map(|(a, b)| [a, b].map(String::from_utf8_lossy)), None);
        assert_eq!(together.len(), one.len());
        let (mut together, mut one) = (Vec::new(), Vec::new());
        write_rows(&mut together, &["name"], 3, |i, row| row.text(["", "a", ""][i])).unwrap();
        write_table(&mut one, &["name"], [[""], ["a"], [""]]).unwrap();
        assert_eq!((together.as_slice(), one.as_slice()), (&b"name\n\"\"\na\n\"\"\n"[..], &b"name\n\"\"\na\n\"\"\n"[..]));
        let short = write_rows(Vec::new(), &columns, 1, |_, row| row.whole(1)).unwrap_err();
        assert!(short.to_string().contains("1 cells"), "{short}");
    }
}
