//! Control files: object coordinates as CSV.

use std::io::{self, Read, Write};
use std::path::Path;

use crate::csv_named_rows::{Form, Row, wrong};
use crate::points::PointFileError;
use crate::table::write_row;

/// The columns of a table of intersected points beside those of a control file: how good each point is.
pub const POINT_QUALITY_COLUMNS: [&str; 6] = ["images", "angle_deg", "sigma0_px", "redundancy", "rejected", "note"];

const FORM: Form = Form {
    what: "control file",
    key: "target",
    required: &["X", "Y", "Z"],
    optional: &["sX", "sY", "sZ"],
    others: false,
    passed_over: &POINT_QUALITY_COLUMNS,
};

/// A point of known object coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct ControlRow {
    /// The target's name.
    pub target: String,
    /// X, Y, Z, object units.
    pub position: [f64; 3],
    /// Standard deviations of X, Y, Z, object units; `None` where the file gives none.
    pub sigmas: Option<[f64; 3]>,
}

/// Reads a control file: header `target,X,Y,Z`, optionally `sX,sY,sZ`, in any order; rows may leave their standard deviations empty. The columns that
/// `intersect` writes beside them are passed over.
///
/// # Errors
/// The first mistake, with line and column: a missing or unknown column, a number that is none, a standard deviation that is not positive, a target given
/// twice, no row at all.
pub fn read_control(path: &Path) -> Result<Vec<ControlRow>, PointFileError> {
    FORM.read(path, control)
}

/// As [`read_control`], from anything that can be read; `file` is its name in errors.
///
/// # Errors
/// As [`read_control`].
pub fn parse_control(file: &str, input: impl Read) -> Result<Vec<ControlRow>, PointFileError> {
    FORM.parse(file, input, control)
}

/// Writes a control file; the columns of the standard deviations are there if a row has them.
///
/// # Errors
/// What the output refuses.
pub fn write_control<'a>(output: impl Write, rows: impl IntoIterator<Item = &'a ControlRow>) -> io::Result<()> {
    let rows: Vec<&ControlRow> = rows.into_iter().collect();
    let with_sigmas = rows.iter().any(|row| row.sigmas.is_some());
    let mut writer = csv::Writer::from_writer(output);
    let columns = std::iter::once(&FORM.key).chain(FORM.required).chain(FORM.optional.iter().filter(|_| with_sigmas));
    writer.write_record(columns)?;
    for row in rows {
        let sigmas = row.sigmas.map_or_else(|| vec![String::new(); 3], |sigmas| sigmas.iter().map(f64::to_string).collect());
        let numbers = row.position.iter().map(f64::to_string).chain(sigmas.into_iter().filter(|_| with_sigmas));
        write_row(&mut writer, std::iter::once(row.target.clone()).chain(numbers))?;
    }
    writer.flush()
}

fn control(file: &str, row: Row) -> Result<ControlRow, PointFileError> {
    let three = |numbers: &Vec<f64>| [numbers[0], numbers[1], numbers[2]];
    let sigmas = row.optional.as_ref().map(three);
    if let Some(axis) = sigmas.and_then(|sigmas| sigmas.iter().position(|sigma| *sigma <= 0.0)) {
        let problem = "expected a positive standard deviation; leave all three empty for a point without".to_owned();
        return Err(wrong(file, Some(row.line), Some(FORM.optional[axis]), problem));
    }
    Ok(ControlRow { target: row.name, position: three(&row.numbers), sigmas })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn error(text: &str) -> String {
        parse_control("c.csv", text.as_bytes()).unwrap_err().to_string()
    }

    #[test]
    fn what_is_written_is_read_again() {
        let rows = parse_control("c", &b"Z,target,X,Y,sX,sY,sZ\n3,a,1,2,0.1,0.2,0.3\n6,\"b,c\",4,5,,,\n"[..]).unwrap();
        assert_eq!(rows[0], ControlRow { target: "a".into(), position: [1.0, 2.0, 3.0], sigmas: Some([0.1, 0.2, 0.3]) });
        assert_eq!((rows[1].target.as_str(), rows[1].sigmas), ("b,c", None));
        let mut text = Vec::new();
        write_control(&mut text, &rows).unwrap();
        assert_eq!(parse_control("c", &text[..]).unwrap(), rows);
        let mut text = Vec::new();
        write_control(&mut text, &rows[1..]).unwrap();
        assert_eq!(String::from_utf8(text).unwrap(), "target,X,Y,Z\n\"b,c\",4,5,6\n");
    }

    #[test]
    fn a_table_of_intersected_points_is_a_control_file() {
        let header = format!("target,X,Y,Z,sX,sY,sZ,{}", POINT_QUALITY_COLUMNS.join(","));
        let rows = parse_control("c", format!("{header}\na,1,2,3,0.1,0.2,0.3,2,11.5,0.3,1,,does not fit\n").as_bytes()).unwrap();
        assert_eq!(rows, [ControlRow { target: "a".into(), position: [1.0, 2.0, 3.0], sigmas: Some([0.1, 0.2, 0.3]) }]);
    }

    #[test]
    fn mistakes_have_a_line_and_a_column() {
        for (text, expected) in [
            ("target,X,Y\na,1,2\n", "c.csv:1, column `Z`: missing in the header; every control file has target,X,Y,Z"),
            ("target,X,Y,Z,sX\na,1,2,3,4\n", "c.csv:1, column `sY`: missing in the header; these go together: sX,sY,sZ"),
            ("target,X,Y,Z,x\na,1,2,3,4\n", "c.csv:1, column `x`: unknown; control file has target, X, Y, Z, sX, sY, sZ"),
            ("target,X,X,Y,Z\na,1,2,3,4\n", "c.csv:1, column `X`: stands in the header twice"),
            ("target,X,Y,Z\na,1,2,3\na,1,2,3\n", "c.csv:3, column `target`: `a` is already on line 2; expected each target once"),
            ("target,X,Y,Z\na,1,2,NaN\n", "c.csv:2, column `Z`: expected a finite number with a decimal point, found `NaN`"),
            ("target,X,Y,Z\n,1,2,3\n", "c.csv:2, column `target`: is empty; expected a name"),
            ("target,X,Y,Z\na,1,,3\n", "c.csv:2, column `Y`: is empty; expected a number"),
            ("target,X,Y,Z\na,1,2\n", "c.csv:2: expected 4 cells as in the header, found 3"),
            ("target,X,Y,Z\n", "c.csv: holds no row; expected one for each target below the header"),
            ("target,X,Y,Z,sX,sY,sZ\na,1,2,3,1,0,1\n", "c.csv:2, column `sY`: expected a positive standard deviation"),
            ("target,X,Y,Z,sX,sY,sZ\na,1,2,3,1,,1\n", "c.csv:2, column `sY`: is empty; expected a number"),
        ] {
            assert!(error(text).starts_with(expected), "{text}: {}", error(text));
        }
    }
}
