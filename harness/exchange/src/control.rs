//! Control files: object coordinates as CSV.

use std::io::{self, Read, Write};
use std::path::Path;

use calibench_files::write_table;
use calibench_model::{ControlDisc, ControlRow};

use crate::board_corners::BOARD_COLUMNS;
use crate::csv_named_rows::{Form, Row, wrong};
use crate::points::PointFileError;

/// The columns of a table of intersected points beside those of a control file: how good each point is.
pub const POINT_QUALITY_COLUMNS: [&str; 6] = ["images", "angle_deg", "sigma0_px", "redundancy", "rejected", "note"];

const SIGMAS: [&str; 3] = ["sX", "sY", "sZ"];
const RADIUS: [&str; 1] = ["radius"];
const NORMAL: [&str; 3] = ["nX", "nY", "nZ"];

/// What tables of intersected points and of measured boards have beside.
const PASSED_OVER: [&str; 13] = {
    let ([a, b, c, d, e, f], [g, h, i, j, k, l, m]) = (POINT_QUALITY_COLUMNS, BOARD_COLUMNS);
    [a, b, c, d, e, f, g, h, i, j, k, l, m]
};

const FORM: Form = Form {
    what: "control file",
    key: "target",
    partner: None,
    group: None,
    required: &["X", "Y", "Z"],
    optional: &[&SIGMAS, &RADIUS, &NORMAL],
    others: false,
    passed_over: &PASSED_OVER,
};

/// Reads a control file: header `target,X,Y,Z`, optionally `sX,sY,sZ`, and of discs `radius` and `nX,nY,nZ`, in any order; rows may leave each of these groups
/// empty. The columns that `intersect` and files of measured boards have beside them are passed over.
///
/// # Errors
/// The first mistake, with line and column: a missing or unknown column, a number that is none, a standard deviation or radius that is not positive, a normal
/// without length or without a radius, a target given twice, no row at all.
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

/// Writes a control file; the columns of standard deviations, radii and normals are there if a row has them.
///
/// # Errors
/// What the output refuses.
pub fn write_control<'a>(output: impl Write, rows: impl IntoIterator<Item = &'a ControlRow>) -> io::Result<()> {
    let rows: Vec<&ControlRow> = rows.into_iter().collect();
    let any = |has: fn(&ControlRow) -> bool| rows.iter().any(|row| has(row));
    let has_normal = |row: &ControlRow| row.disc.as_ref().is_some_and(|disc| disc.normal.is_some());
    let there = [any(|row| row.sigmas.is_some()), any(|row| row.disc.is_some()), any(has_normal)];
    let columns = FORM.optional.iter().zip(&there).filter(|(_, there)| **there).flat_map(|(group, _)| *group);
    let columns: Vec<&str> = std::iter::once(&FORM.key).chain(FORM.required).chain(columns).copied().collect();
    let cells = |row: &ControlRow| {
        let group = |(numbers, columns): (Option<Vec<f64>>, &&[&str])| {
            numbers.map_or_else(|| vec![String::new(); columns.len()], |numbers| numbers.iter().map(f64::to_string).collect())
        };
        let optional = groups(row).into_iter().zip(FORM.optional).zip(&there).filter(|(_, there)| **there).flat_map(|(it, _)| group(it));
        let numbers = row.position.iter().map(f64::to_string).chain(optional);
        std::iter::once(row.target.clone()).chain(numbers).collect::<Vec<String>>()
    };
    write_table(output, &columns, rows.into_iter().map(cells))
}

/// The numbers of a row's optional groups.
fn groups(row: &ControlRow) -> [Option<Vec<f64>>; 3] {
    let disc = row.disc.as_ref();
    [row.sigmas.map(Vec::from), disc.map(|disc| vec![disc.radius]), disc.and_then(|disc| disc.normal).map(Vec::from)]
}

fn control(file: &str, row: Row) -> Result<ControlRow, PointFileError> {
    let wrong = |column: &str, problem: &str| Err(wrong(file, Some(row.line), Some(column), problem.to_owned()));
    let sigmas = row.optional(0);
    if let Some(axis) = sigmas.and_then(|sigmas: [f64; 3]| sigmas.iter().position(|sigma| *sigma <= 0.0)) {
        return wrong(SIGMAS[axis], "expected a positive standard deviation; leave all three empty for a point without");
    }
    let normal = row.optional(2);
    let disc = match (row.optional(1), normal) {
        (Some([radius]), _) if radius <= 0.0 => return wrong(RADIUS[0], "expected a positive radius; leave it empty for what is no disc"),
        (Some(_), Some([0.0, 0.0, 0.0])) => {
            return wrong(NORMAL[0], "expected a normal with a length; leave all three empty for a disc without");
        }
        (None, Some(_)) => return wrong(RADIUS[0], "is empty; expected the radius of the disc whose normal this is"),
        (Some([radius]), normal) => Some(Box::new(ControlDisc { radius, normal })),
        (None, None) => None,
    };
    let position = [row.numbers[0], row.numbers[1], row.numbers[2]];
    Ok(ControlRow { target: row.name, position, sigmas, disc })
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
        assert_eq!(rows[0], ControlRow { sigmas: Some([0.1, 0.2, 0.3]), ..ControlRow::new("a", [1.0, 2.0, 3.0]) });
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
        assert_eq!(rows, [ControlRow { sigmas: Some([0.1, 0.2, 0.3]), ..ControlRow::new("a", [1.0, 2.0, 3.0]) }]);
    }

    #[test]
    fn discs_say_how_large_they_are_and_how_they_lie() {
        let text = "target,X,Y,Z,radius,nX,nY,nZ\na,1,2,3,10,0,0.5,-1\nb,4,5,6,7.5,,,\nc,7,8,9,,,,\n";
        let rows = parse_control("c", text.as_bytes()).unwrap();
        let discs: Vec<Option<ControlDisc>> = rows.iter().map(|row| row.disc.as_deref().copied()).collect();
        let with_normal = ControlDisc { radius: 10.0, normal: Some([0.0, 0.5, -1.0]) };
        assert_eq!(discs, [Some(with_normal), Some(ControlDisc { radius: 7.5, normal: None }), None]);
        let mut written = Vec::new();
        write_control(&mut written, &rows).unwrap();
        assert_eq!(String::from_utf8(written).unwrap(), text);
    }

    #[test]
    fn mistakes_have_a_line_and_a_column() {
        for (text, expected) in [
            ("target,X,Y\na,1,2\n", "c.csv:1, column `Z`: missing in the header; every control file has target,X,Y,Z"),
            ("target,X,Y,Z,sX\na,1,2,3,4\n", "c.csv:1, column `sY`: missing in the header; these go together: sX,sY,sZ"),
            (
                "target,X,Y,Z,x\na,1,2,3,4\n",
                "c.csv:1, column `x`: unknown; control file has target, X, Y, Z, sX, sY, sZ, radius, nX, nY, nZ",
            ),
            ("target,X,X,Y,Z\na,1,2,3,4\n", "c.csv:1, column `X`: stands in the header twice"),
            ("target,X,Y,Z\na,1,2,3\na,1,2,3\n", "c.csv:3, column `target`: `a` is already on line 2; expected each target once"),
            ("target,X,Y,Z\na,1,2,NaN\n", "c.csv:2, column `Z`: expected a finite number with a decimal point, found `NaN`"),
            ("target,X,Y,Z\n,1,2,3\n", "c.csv:2, column `target`: is empty; expected a name"),
            ("target,X,Y,Z\na,1,,3\n", "c.csv:2, column `Y`: is empty; expected a number"),
            ("target,X,Y,Z\na,1,2\n", "c.csv:2: expected 4 cells as in the header, found 3"),
            ("target,X,Y,Z\n", "c.csv: holds no row; expected one for each target below the header"),
            ("target,X,Y,Z,sX,sY,sZ\na,1,2,3,1,0,1\n", "c.csv:2, column `sY`: expected a positive standard deviation"),
            ("target,X,Y,Z,sX,sY,sZ\na,1,2,3,1,,1\n", "c.csv:2, column `sY`: is empty; expected a number"),
            ("target,X,Y,Z,radius\na,1,2,3,0\n", "c.csv:2, column `radius`: expected a positive radius"),
            ("target,X,Y,Z,nX,nY,nZ\na,1,2,3,0,0,1\n", "c.csv:2, column `radius`: is empty; expected the radius"),
            ("target,X,Y,Z,radius,nX,nY,nZ\na,1,2,3,5,0,0,0\n", "c.csv:2, column `nX`: expected a normal with a length"),
            ("target,X,Y,Z,radius,nX,nZ\na,1,2,3,5,0,0\n", "c.csv:1, column `nY`: missing in the header; these go together: nX,nY,nZ"),
        ] {
            assert!(error(text).starts_with(expected), "{text}: {}", error(text));
        }
    }
}
