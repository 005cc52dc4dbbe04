//! Measured points, written.

use std::io::{self, Write};

use calibench_files::table::{Row, write_made_rows};
use calibench_model::{Measurement, PointRef, Rejection, Start};

use crate::points::{COVARIANCE, REQUIRED, RESULT, SHAPE};

/// One measured, rejected or unmeasurable point.
#[derive(Clone, Debug)]
pub struct MeasuredRow<'a> {
    /// The point as it was given.
    pub given: PointRef<'a>,
    /// The method's label.
    pub method: &'a str,
    /// Measured, rejected or unavailable.
    pub outcome: Outcome,
}

/// The status of a point.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// Measured.
    Measured(Measurement),
    /// Seen and rejected.
    Rejected(Rejection),
    /// Never tried, and why.
    Unavailable(String),
}

/// Writes the columns of a point file and `method,status,reason`, one row for every row given, in that order.
///
/// Rejected and unavailable points have empty coordinates. Numbers are written with all their digits.
///
/// # Errors
/// What the output refuses.
pub fn write_measured<'a>(output: impl Write, rows: impl IntoIterator<Item = MeasuredRow<'a>>) -> io::Result<()> {
    let columns = [&REQUIRED[..], &COVARIANCE, &SHAPE, &RESULT].concat();
    write_made_rows(output, &columns, rows, |row, cells| {
        let (position, covariance, status, reason) = match &row.outcome {
            Outcome::Measured(found) => (Some(found.position), found.covariance, "measured", ""),
            Outcome::Rejected(rejection) => (None, None, "rejected", rejection.name()),
            Outcome::Unavailable(why) => (None, None, "unavailable", why.as_str()),
        };
        texts(cells, [row.given.image, row.given.target]);
        numbers(cells, position.map(|p| [p.x, p.y]));
        numbers(cells, covariance.map(|s| [s.sxx, s.sxy, s.syy]));
        shape(cells, &row.given.start);
        texts(cells, [row.method, status, reason]);
    })
}

/// Writes a point file without covariances: image, target, x, y and the shape.
///
/// # Errors
/// What the output refuses.
pub fn write_points<'a>(output: impl Write, rows: impl IntoIterator<Item = PointRef<'a>>) -> io::Result<()> {
    write_made_rows(output, &[&REQUIRED[..], &SHAPE].concat(), rows, |row, cells| {
        texts(cells, [row.image, row.target]);
        numbers(cells, Some([row.start.position.x, row.start.position.y]));
        shape(cells, &row.start);
    })
}

fn texts<const N: usize>(cells: &mut Row, texts: [&str; N]) {
    texts.into_iter().for_each(|text| cells.text(text));
}

/// Empty cells where there are none.
fn numbers<const N: usize>(cells: &mut Row, values: Option<[f64; N]>) {
    match values {
        Some(values) => values.into_iter().for_each(|value| cells.number(value)),
        None => texts(cells, [""; N]),
    }
}

fn shape(cells: &mut Row, start: &Start) {
    cells.text(&start.kind.map_or_else(String::new, |kind| kind.to_string()));
    numbers(cells, start.affine.map(|a| [a.axx, a.axy, a.ayx, a.ayy]));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::points::parse_points;
    use calibench_model::{Covariance, PixelPoint};

    #[test]
    fn what_is_written_is_read_again() {
        let text = b"image,target,x,y,kind,axx,axy,ayx,ayy\n'=i,\"a,b\",1,2,disc,3,4,5,6\n";
        let given = parse_points("p", &text[..]).unwrap().points;
        assert_eq!(given.row(0).image, "=i");
        let found =
            Measurement { position: PixelPoint::new(0.1 + 0.2, -1e-9), covariance: Some(Covariance { sxx: 1e-7, sxy: 0.0, syy: 2.0 }) };
        let mut text = Vec::new();
        let row = |outcome| MeasuredRow { given: given.row(0), method: "m:k=1,j=2", outcome };
        write_measured(&mut text, [row(Outcome::Measured(found))]).unwrap();
        let again = parse_points("q", &text[..]).unwrap().points;
        let (again, given_row) = (again.row(0), given.row(0));
        assert_eq!((again.start.position, again.start.covariance), (found.position, found.covariance));
        assert_eq!((again.image, again.target, again.start.affine), (given_row.image, given_row.target, given_row.start.affine));
        let mut text = Vec::new();
        write_measured(&mut text, [row(Outcome::Rejected(Rejection::Border)), row(Outcome::Unavailable("no".into()))]).unwrap();
        let text = String::from_utf8(text).unwrap();
        let mut points = Vec::new();
        write_points(&mut points, given.rows()).unwrap();
        assert_eq!(parse_points("r", &points[..]).unwrap().points, given);
        assert!(text.contains("\"m:k=1,j=2\",rejected,border\n") && text.contains("unavailable,no\n"), "{text}");
        assert!(text.contains("\n'=i,"), "no formula: {text}");
    }
}
