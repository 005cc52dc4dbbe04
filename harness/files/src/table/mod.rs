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

/// Writes a header and a row for each of `given`, made by `row` on all threads; the bytes do not depend on how many there are. They are those of
/// [`write_table`], but for the last digit of a number halfway between two that are equally short, which is even here.
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
        let cells = |text: &[u8]| String::from_utf8(text.to_vec()).unwrap().split(',').map(str::to_owned).collect::<Vec<_>>();
        let (together, one) = (cells(&together), cells(&one));
        let number = |text: &str| text.parse::<f64>().ok();
        let apart = |(a, b): &(&String, &String)| a != b && (a.len() != b.len() || number(a).is_none() || number(a) != number(b));
        assert_eq!(together.iter().zip(&one).find(apart), None);
        assert_eq!(together.len(), one.len());
        let (mut together, mut one) = (Vec::new(), Vec::new());
        write_rows(&mut together, &["name"], 3, |i, row| row.text(["", "a", ""][i])).unwrap();
        write_table(&mut one, &["name"], [[""], ["a"], [""]]).unwrap();
        assert_eq!((together.as_slice(), one.as_slice()), (&b"name\n\"\"\na\n\"\"\n"[..], &b"name\n\"\"\na\n\"\"\n"[..]));
        let short = write_rows(Vec::new(), &columns, 1, |_, row| row.whole(1)).unwrap_err();
        assert!(short.to_string().contains("1 cells"), "{short}");
    }
}
