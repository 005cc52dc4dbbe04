//! Files of lengths by which measuring is tested, as CSV.

use std::io::Read;
use std::path::Path;

use calibench_model::TestLength;

use crate::csv_named_rows::{Form, Row, wrong};
use crate::points::PointFileError;

const MEASURED: [&str; 1] = ["measured"];

const FORM: Form = Form {
    what: "file of lengths",
    key: "from",
    partner: Some("to"),
    group: Some("line"),
    required: &["calibrated", "sigma"],
    optional: &[&MEASURED],
    others: false,
    passed_over: &[],
};

/// Reads lengths of an acceptance test: header `line,from,to,calibrated,sigma` and, unless they follow from measured points, `measured`, in any order; object
/// units. The standard uncertainty `sigma` is 0 where a length is taken as exact.
///
/// # Errors
/// The first mistake, with line and column: a missing or unknown column, a number that is none, a length that is not positive, a negative standard uncertainty, a
/// target with itself, a pair given twice in a measurement line, no row at all.
pub fn read_lengths(path: &Path) -> Result<Vec<TestLength>, PointFileError> {
    FORM.read(path, length)
}

/// As [`read_lengths`], from anything that can be read; `file` is its name in errors.
///
/// # Errors
/// As [`read_lengths`].
pub fn parse_lengths(file: &str, input: impl Read) -> Result<Vec<TestLength>, PointFileError> {
    FORM.parse(file, input, length)
}

fn length(file: &str, row: Row) -> Result<TestLength, PointFileError> {
    let wrong = |column: &str, problem: String| Err(wrong(file, Some(row.line), Some(column), problem));
    let (calibrated, sigma) = (row.numbers[0], row.numbers[1]);
    let measured = row.optional(0).map(|[measured]| measured);
    if row.name == row.partner {
        return wrong("to", format!("is `{}` too; expected another target", row.partner));
    }
    for (column, value) in [("calibrated", Some(calibrated)), (MEASURED[0], measured)] {
        if let Some(value) = value.filter(|value| *value <= 0.0) {
            return wrong(column, format!("expected a positive length, found `{value}`"));
        }
    }
    if sigma < 0.0 {
        return wrong("sigma", format!("expected a standard uncertainty, or 0 for a length that is taken as exact, found `{sigma}`"));
    }
    Ok(TestLength { line: row.group, targets: [row.name, row.partner], calibrated, sigma, measured })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_have_a_line_two_names_and_what_was_measured() {
        let text = "measured,line,from,to,calibrated,sigma\n100.1,1,a,b,100,0.01\n,1,a,c,200,0\n200.2,2,c,a,200,0.01\n";
        let rows = parse_lengths("l.csv", text.as_bytes()).unwrap();
        let of = |line: &str, [a, b]: [&str; 2], calibrated, sigma, measured| TestLength {
            line: line.into(),
            targets: [a.into(), b.into()],
            calibrated,
            sigma,
            measured,
        };
        // A bar that is moved has its names again in another line.
        let expected = [
            of("1", ["a", "b"], 100.0, 0.01, Some(100.1)),
            of("1", ["a", "c"], 200.0, 0.0, None),
            of("2", ["c", "a"], 200.0, 0.01, Some(200.2)),
        ];
        assert_eq!(rows, expected);
        assert_eq!(parse_lengths("l", &b"line,from,to,calibrated,sigma\n1,a,b,5,0\n"[..]).unwrap()[0].measured, None);
    }

    #[test]
    fn mistakes_have_a_line_and_a_column() {
        let row = |row: &str| format!("line,from,to,calibrated,sigma,measured\n{row}\n");
        for (text, expected) in [
            (
                "from,to,calibrated,sigma\na,b,1,2\n".into(),
                "l.csv:1, column `line`: missing in the header; every file of lengths has line,from,to,calibrated,sigma",
            ),
            (row(",a,b,1,2,1"), "l.csv:2, column `line`: is empty; expected a name"),
            (row("1,a,a,1,2,1"), "l.csv:2, column `to`: is `a` too; expected another target"),
            (row("1,a,b,0,2,1"), "l.csv:2, column `calibrated`: expected a positive length, found `0`"),
            (row("1,a,b,1,2,-1"), "l.csv:2, column `measured`: expected a positive length, found `-1`"),
            (row("1,a,b,1,-2,1"), "l.csv:2, column `sigma`: expected a standard uncertainty, or 0"),
            (
                row("1,a,b,1,2,1\n2,a,b,1,2,1\n1,b,a,1,2,1"),
                "l.csv:4, column `from`: `b` and `a` are already on line 2; expected each pair once in each line",
            ),
        ] {
            let error = parse_lengths("l.csv", text.as_bytes()).unwrap_err().to_string();
            assert!(error.starts_with(expected), "{error}");
        }
    }
}
