//! Measured points, written.

use std::fmt::Write as _;
use std::io::{self, Write};

use calibench_model::{Measurement, Rejection, Start, escape};

use crate::points::{COVARIANCE, PointRef, REQUIRED, RESULT, SHAPE};

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
    let mut writer = Rows::new(output, &[&REQUIRED[..], &COVARIANCE, &SHAPE, &RESULT])?;
    for row in rows {
        let (position, covariance, status, reason) = match &row.outcome {
            Outcome::Measured(found) => (Some(found.position), found.covariance, "measured", ""),
            Outcome::Rejected(rejection) => (None, None, "rejected", rejection.name()),
            Outcome::Unavailable(why) => (None, None, "unavailable", why.as_str()),
        };
        writer.names([row.given.image, row.given.target])?;
        writer.numbers(position.map(|p| [p.x, p.y]))?;
        writer.numbers(covariance.map(|s| [s.sxx, s.sxy, s.syy]))?;
        writer.shape(&row.given.start)?;
        writer.names([row.method, status, reason])?;
        writer.end()?;
    }
    writer.csv.flush()
}

/// Writes a point file without covariances: image, target, x, y and the shape.
///
/// # Errors
/// What the output refuses.
pub fn write_points<'a>(output: impl Write, rows: impl IntoIterator<Item = PointRef<'a>>) -> io::Result<()> {
    let mut writer = Rows::new(output, &[&REQUIRED[..], &SHAPE])?;
    for row in rows {
        writer.names([row.image, row.target])?;
        writer.numbers(Some([row.start.position.x, row.start.position.y]))?;
        writer.shape(&row.start)?;
        writer.end()?;
    }
    writer.csv.flush()
}

/// Rows, cell by cell: a file may have ten million of them.
struct Rows<W: Write> {
    csv: csv::Writer<W>,
    digits: String,
}

impl<W: Write> Rows<W> {
    fn new(output: W, header: &[&[&str]]) -> io::Result<Self> {
        let mut csv = csv::Writer::from_writer(output);
        csv.write_record(header.concat())?;
        Ok(Self { csv, digits: String::new() })
    }

    fn names<const N: usize>(&mut self, names: [&str; N]) -> io::Result<()> {
        Ok(names.into_iter().try_for_each(|name| self.csv.write_field(escape::cell(name).as_bytes()))?)
    }

    fn numbers<const N: usize>(&mut self, values: Option<[f64; N]>) -> io::Result<()> {
        for i in 0..N {
            self.digits.clear();
            if let Some(values) = values {
                // Writing to a String cannot fail.
                let _ = write!(self.digits, "{}", values[i]);
            }
            self.csv.write_field(&self.digits)?;
        }
        Ok(())
    }

    fn shape(&mut self, start: &Start) -> io::Result<()> {
        self.digits.clear();
        if let Some(kind) = start.kind {
            let _ = write!(self.digits, "{kind}");
        }
        self.csv.write_field(&self.digits)?;
        self.numbers(start.affine.map(|a| [a.axx, a.axy, a.ayx, a.ayy]))
    }

    fn end(&mut self) -> io::Result<()> {
        Ok(self.csv.write_record(None::<&[u8]>)?)
    }
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
