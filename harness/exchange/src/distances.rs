//! Files of distances: lengths between targets, as of scale bars, as CSV.

use std::io::Read;
use std::path::Path;

use calibench_model::MeasuredDistance;

use crate::csv_named_rows::{Form, Row, wrong};
use crate::points::PointFileError;

const PARTNER: &str = "target_b";

const FORM: Form = Form {
    what: "file of distances",
    key: "target_a",
    partner: Some(PARTNER),
    group: None,
    required: &["distance", "sigma"],
    optional: &[],
    others: false,
    passed_over: &[],
};

/// Reads distances: header `target_a,target_b,distance,sigma` in any order, lengths and their standard deviations in object units.
///
/// # Errors
/// The first mistake, with line and column: a missing or unknown column, a number that is none, a distance or standard deviation that is not positive, a
/// target with itself, a pair given twice, no row at all.
pub fn read_distances(path: &Path) -> Result<Vec<MeasuredDistance>, PointFileError> {
    FORM.read(path, distance)
}

/// As [`read_distances`], from anything that can be read; `file` is its name in errors.
///
/// # Errors
/// As [`read_distances`].
pub fn parse_distances(file: &str, input: impl Read) -> Result<Vec<MeasuredDistance>, PointFileError> {
    FORM.parse(file, input, distance)
}

fn distance(file: &str, row: Row) -> Result<MeasuredDistance, PointFileError> {
    let wrong = |column: &str, problem: String| Err(wrong(file, Some(row.line), Some(column), problem));
    let (value, sigma) = (row.numbers[0], row.numbers[1]);
    if row.name == row.partner {
        return wrong(PARTNER, format!("is `{}` too; expected another target", row.partner));
    }
    if value <= 0.0 {
        return wrong("distance", format!("expected a positive length, found `{value}`"));
    }
    if sigma <= 0.0 {
        return wrong("sigma", format!("expected a positive standard deviation, found `{sigma}`"));
    }
    Ok(MeasuredDistance { targets: [row.name, row.partner], value, sigma })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_have_two_names_a_length_and_a_sigma() {
        let rows = parse_distances("d.csv", &b"sigma,target_b,target_a,distance\n0.01,507,506,1389.688\n0.02,506,508,10\n"[..]).unwrap();
        let expected = |a: &str, b: &str, value, sigma| MeasuredDistance { targets: [a.into(), b.into()], value, sigma };
        assert_eq!(rows, [expected("506", "507", 1389.688, 0.01), expected("508", "506", 10.0, 0.02)]);
    }

    #[test]
    fn mistakes_have_a_line_and_a_column() {
        for (text, expected) in [
            (
                "target_a,distance,sigma\na,1,2\n",
                "d.csv:1, column `target_b`: missing in the header; every file of distances has target_a,target_b,distance,sigma",
            ),
            (
                "target_a,target_b,distance,sigma,x\na,b,1,2,3\n",
                "d.csv:1, column `x`: unknown; file of distances has target_a, target_b, distance, sigma",
            ),
            ("target_a,target_b,distance,sigma\na,a,1,2\n", "d.csv:2, column `target_b`: is `a` too; expected another target"),
            ("target_a,target_b,distance,sigma\na,,1,2\n", "d.csv:2, column `target_b`: is empty; expected a name"),
            ("target_a,target_b,distance,sigma\na,b,0,2\n", "d.csv:2, column `distance`: expected a positive length, found `0`"),
            ("target_a,target_b,distance,sigma\na,b,1,-2\n", "d.csv:2, column `sigma`: expected a positive standard deviation, found `-2`"),
            (
                "target_a,target_b,distance,sigma\na,b,1,2\nb,a,1,2\n",
                "d.csv:3, column `target_a`: `b` and `a` are already on line 2; expected each pair once",
            ),
            ("target_a,target_b,distance,sigma\n", "d.csv: holds no row"),
        ] {
            let error = parse_distances("d.csv", text.as_bytes()).unwrap_err().to_string();
            assert!(error.starts_with(expected), "{error}");
        }
    }
}
