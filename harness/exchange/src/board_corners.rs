//! Files of measured boards: their corners as CSV, which are control files too.

use std::io::{self, Read, Write};
use std::path::Path;

use calibench_files::write_table;
use calibench_model::BoardCorner;

use crate::csv_named_rows::{Form, Row, wrong};
use crate::points::PointFileError;

const COVARIANCES: [&str; 3] = ["cXY", "cXZ", "cYZ"];
const NOMINAL: [&str; 3] = ["X0", "Y0", "Z0"];
const PHOTOGRAPHS: [&str; 1] = ["photographs"];

/// The columns of a file of a measured board beside those of a control file.
pub(crate) const BOARD_COLUMNS: [&str; 7] = ["cXY", "cXZ", "cYZ", "X0", "Y0", "Z0", "photographs"];

const FORM: Form = Form {
    what: "board file",
    key: "target",
    partner: None,
    group: None,
    required: &["X", "Y", "Z", "sX", "sY", "sZ"],
    optional: &[&COVARIANCES, &NOMINAL, &PHOTOGRAPHS],
    others: false,
    passed_over: &[],
};

/// Reads a file of a measured board: header `target,X,Y,Z,sX,sY,sZ`, optionally `cXY,cXZ,cYZ` (covariances), `X0,Y0,Z0` (nominal places) and `photographs`, in any order.
///
/// # Errors
/// The first mistake, with line and column: a missing or unknown column, a number that is none, a standard deviation that is not positive, a covariance beyond
/// those of its standard deviations, a corner given twice, no row at all.
pub fn read_board_corners(path: &Path) -> Result<Vec<BoardCorner>, PointFileError> {
    FORM.read(path, |file, row| corner(file, &row))
}

/// As [`read_board_corners`], from anything that can be read; `file` is its name in errors.
///
/// # Errors
/// As [`read_board_corners`].
pub fn parse_board_corners(file: &str, input: impl Read) -> Result<Vec<BoardCorner>, PointFileError> {
    FORM.parse(file, input, |file, row| corner(file, &row))
}

/// Writes a file of a measured board; columns that no row has are left out.
///
/// # Errors
/// What the output refuses.
pub fn write_board_corners(output: impl Write, corners: &[BoardCorner]) -> io::Result<()> {
    let groups = |corner: &BoardCorner| {
        let photographs = corner.photographs.map(|count| vec![count as f64]);
        [corner.covariances.map(Vec::from), corner.nominal.map(Vec::from), photographs]
    };
    let there: [bool; 3] = std::array::from_fn(|group| corners.iter().any(|corner| groups(corner)[group].is_some()));
    let optional = FORM.optional.iter().zip(there).filter(|(_, there)| *there).flat_map(|(group, _)| *group);
    let columns: Vec<&str> = std::iter::once(&FORM.key).chain(FORM.required).chain(optional).copied().collect();
    let cells = |corner: &BoardCorner| {
        let known = corner.position.iter().chain(&corner.sigmas).map(f64::to_string).collect::<Vec<_>>();
        let optional =
            groups(corner).into_iter().zip(FORM.optional).zip(there).filter(|(_, there)| *there).flat_map(|((group, columns), _)| {
                group.map_or_else(|| vec![String::new(); columns.len()], |numbers| numbers.iter().map(f64::to_string).collect())
            });
        std::iter::once(corner.target.clone()).chain(known).chain(optional).collect::<Vec<String>>()
    };
    write_table(output, &columns, corners.iter().map(cells))
}

fn corner(file: &str, row: &Row) -> Result<BoardCorner, PointFileError> {
    let wrong = |column: &str, problem: &str| Err(wrong(file, Some(row.line), Some(column), problem.to_owned()));
    let [x, y, z, sx, sy, sz] = row.numbers[..] else { return wrong(FORM.key, "expected six numbers") };
    let sigmas = [sx, sy, sz];
    if let Some(axis) = sigmas.iter().position(|sigma| *sigma <= 0.0) {
        return wrong(FORM.required[3 + axis], "expected a positive standard deviation");
    }
    let covariances: Option<[f64; 3]> = row.optional(0);
    let most = [sx * sy, sx * sz, sy * sz];
    let beyond = covariances.and_then(|all| all.iter().zip(most).position(|(covariance, most)| covariance.abs() > most * (1.0 + 1e-9)));
    if let Some(place) = beyond {
        return wrong(COVARIANCES[place], "is larger than its standard deviations allow");
    }
    let photographs: Option<[f64; 1]> = row.optional(2);
    let photographs = match photographs {
        Some([count]) if count < 0.0 || count.fract() != 0.0 => return wrong(PHOTOGRAPHS[0], "expected a whole number of photographs"),
        found => found.map(|[count]| count as usize),
    };
    Ok(BoardCorner { target: row.name.clone(), position: [x, y, z], sigmas, covariances, nominal: row.optional(1), photographs })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::parse_control;

    const TEXT: &str = "target,X,Y,Z,sX,sY,sZ,cXY,cXZ,cYZ,X0,Y0,Z0,photographs\n\
                        r1c1,0.1,-0.2,0.3,0.01,0.02,0.03,0.0001,0,-0.0002,0,0,0,13\n";

    #[test]
    fn what_is_written_is_read_again_and_is_control_too() {
        let rows = parse_board_corners("b.csv", TEXT.as_bytes()).unwrap();
        assert_eq!((rows[0].covariances, rows[0].photographs), (Some([1e-4, 0.0, -2e-4]), Some(13)));
        let mut written = Vec::new();
        write_board_corners(&mut written, &rows).unwrap();
        assert_eq!(String::from_utf8(written).unwrap(), TEXT);
        let control = parse_control("b.csv", TEXT.as_bytes()).unwrap();
        assert_eq!((control[0].position, control[0].sigmas), ([0.1, -0.2, 0.3], Some([0.01, 0.02, 0.03])));
        let short = "target,X,Y,Z,sX,sY,sZ\na,1,2,3,0.1,0.1,0.1\n";
        let rows = parse_board_corners("b.csv", short.as_bytes()).unwrap();
        let mut written = Vec::new();
        write_board_corners(&mut written, &rows).unwrap();
        assert_eq!(String::from_utf8(written).unwrap(), short);
    }

    #[test]
    fn mistakes_have_a_line_and_a_column() {
        let head = "target,X,Y,Z,sX,sY,sZ";
        for (text, expected) in [
            (
                "target,X,Y,Z\na,1,2,3\n".to_owned(),
                "b.csv:1, column `sX`: missing in the header; every board file has target,X,Y,Z,sX,sY,sZ",
            ),
            (format!("{head}\na,1,2,inf,1,1,1\n"), "b.csv:2, column `Z`: expected a finite number"),
            (format!("{head}\na,1,2,3,1,0,1\n"), "b.csv:2, column `sY`: expected a positive standard deviation"),
            (format!("{head}\na,1,2,3,1,1,1\na,1,2,3,1,1,1\n"), "b.csv:3, column `target`: `a` is already on line 2"),
            (format!("{head},cXY,cXZ,cYZ\na,1,2,3,1,1,1,0,2,0\n"), "b.csv:2, column `cXZ`: is larger than its standard deviations allow"),
            (format!("{head},photographs\na,1,2,3,1,1,1,2.5\n"), "b.csv:2, column `photographs`: expected a whole number"),
            (format!("{head},value\na,1,2,3,1,1,1,2\n"), "b.csv:1, column `value`: unknown"),
            (format!("{head}\n"), "b.csv: holds no row"),
        ] {
            let error = parse_board_corners("b.csv", text.as_bytes()).unwrap_err().to_string();
            assert!(error.starts_with(expected), "{text}: {error}");
        }
    }
}
