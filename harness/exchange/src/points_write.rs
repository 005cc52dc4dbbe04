//! Measured points, written.

use std::io::{self, Write};

use calibench_model::{Measurement, Rejection, Start};

use crate::points::{COVARIANCE, PointRow, REQUIRED, RESULT, SHAPE};

/// One measured, rejected or unmeasurable point.
#[derive(Clone, Debug)]
pub struct MeasuredRow<'a> {
    /// The point as it was given.
    pub given: &'a PointRow,
    /// The method's label.
    pub method: &'a str,
    /// What became of it.
    pub outcome: Outcome,
}

/// What became of a point.
#[derive(Clone, Debug)]
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
    let mut writer = csv::Writer::from_writer(output);
    writer.write_record([&REQUIRED[..], &COVARIANCE, &SHAPE, &RESULT].concat())?;
    for row in rows {
        writer.write_record(cells(&row))?;
    }
    writer.flush()
}

/// Writes a point file without covariances: image, target, x, y and the shape.
///
/// # Errors
/// What the output refuses.
pub fn write_points<'a>(output: impl Write, rows: impl IntoIterator<Item = &'a PointRow>) -> io::Result<()> {
    let mut writer = csv::Writer::from_writer(output);
    writer.write_record([&REQUIRED[..], &SHAPE].concat())?;
    for row in rows {
        let mut cells = vec![row.image.clone(), row.target.clone()];
        numbers(&mut cells, Some([row.start.position.x, row.start.position.y]));
        shape(&mut cells, &row.start);
        writer.write_record(cells)?;
    }
    writer.flush()
}

fn shape(cells: &mut Vec<String>, start: &Start) {
    cells.push(start.kind.map_or(String::new(), |kind| kind.to_string()));
    numbers(cells, start.affine.map(|a| [a.axx, a.axy, a.ayx, a.ayy]));
}

fn cells(row: &MeasuredRow<'_>) -> Vec<String> {
    let mut cells = vec![row.given.image.clone(), row.given.target.clone()];
    let (position, covariance, status, reason) = match &row.outcome {
        Outcome::Measured(found) => (Some(found.position), found.covariance, "measured", String::new()),
        Outcome::Rejected(rejection) => (None, None, "rejected", rejection.to_string()),
        Outcome::Unavailable(why) => (None, None, "unavailable", why.clone()),
    };
    numbers(&mut cells, position.map(|p| [p.x, p.y]));
    numbers(&mut cells, covariance.map(|s| [s.sxx, s.sxy, s.syy]));
    shape(&mut cells, &row.given.start);
    cells.extend([row.method.to_owned(), status.to_owned(), reason]);
    cells
}

fn numbers<const N: usize>(cells: &mut Vec<String>, values: Option<[f64; N]>) {
    match values {
        Some(values) => cells.extend(values.iter().map(ToString::to_string)),
        None => cells.extend(std::iter::repeat_n(String::new(), N)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::points::parse_points;
    use calibench_model::{Covariance, PixelPoint};

    #[test]
    fn what_is_written_is_read_again() {
        let given = parse_points("p", &b"image,target,x,y,kind,axx,axy,ayx,ayy\ni,\"a,b\",1,2,disc,3,4,5,6\n"[..]).unwrap().rows;
        let found =
            Measurement { position: PixelPoint::new(0.1 + 0.2, -1e-9), covariance: Some(Covariance { sxx: 1e-7, sxy: 0.0, syy: 2.0 }) };
        let mut text = Vec::new();
        let row = |outcome| MeasuredRow { given: &given[0], method: "m:k=1,j=2", outcome };
        write_measured(&mut text, [row(Outcome::Measured(found))]).unwrap();
        let again = parse_points("q", &text[..]).unwrap().rows;
        assert_eq!((again[0].start.position, again[0].start.covariance), (found.position, found.covariance));
        assert_eq!((&again[0].target, again[0].start.affine), (&given[0].target, given[0].start.affine));
        let mut text = Vec::new();
        write_measured(&mut text, [row(Outcome::Rejected(Rejection::Border)), row(Outcome::Unavailable("no".into()))]).unwrap();
        let text = String::from_utf8(text).unwrap();
        let mut points = Vec::new();
        write_points(&mut points, &given).unwrap();
        assert_eq!(parse_points("r", &points[..]).unwrap().rows, given);
        assert!(text.contains("\"m:k=1,j=2\",rejected,border\n") && text.contains("unavailable,no\n"), "{text}");
    }
}
