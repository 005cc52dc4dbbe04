//! Tables as CSV.

use std::io::{self, Write};

use calibench_model::escape;

/// Writes a header and rows, each with as many cells, names as [`escape::cell`] has them.
///
/// # Errors
/// What the output refuses; a row with another number of cells than the header.
pub fn write_table<R>(output: impl Write, columns: &[&str], rows: impl IntoIterator<Item = R>) -> io::Result<()>
where
    R: IntoIterator<Item: AsRef<str>>,
{
    let mut writer = csv::Writer::from_writer(output);
    writer.write_record(columns)?;
    rows.into_iter().try_for_each(|row| write_row(&mut writer, row))?;
    writer.flush()
}

/// Writes a row whose names no spreadsheet takes for formulas; the readers of points, control and stations undo that.
pub(crate) fn write_row<W: Write>(writer: &mut csv::Writer<W>, cells: impl IntoIterator<Item: AsRef<str>>) -> csv::Result<()> {
    cells.into_iter().try_for_each(|cell| writer.write_field(escape::cell(cell.as_ref()).as_bytes()))?;
    writer.write_record(None::<&[u8]>)
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
}
