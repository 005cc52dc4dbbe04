//! Tables as CSV.

use std::io::{self, Write};

/// Writes a header and rows, each with as many cells.
///
/// # Errors
/// What the output refuses; a row with another number of cells than the header.
pub fn write_table<R>(output: impl Write, columns: &[&str], rows: impl IntoIterator<Item = R>) -> io::Result<()>
where
    R: IntoIterator<Item: AsRef<[u8]>>,
{
    let mut writer = csv::Writer::from_writer(output);
    writer.write_record(columns)?;
    rows.into_iter().try_for_each(|row| writer.write_record(row))?;
    writer.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_as_long_as_the_header() {
        let mut text = Vec::new();
        write_table(&mut text, &["a", "b"], [["1", "x,y"]]).unwrap();
        assert_eq!(text, b"a,b\n1,\"x,y\"\n");
        assert!(write_table(&mut text, &["a", "b"], [["1"]]).is_err());
    }
}
