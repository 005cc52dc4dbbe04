//! The records of a judgement: one tidy CSV beside the records of the corners.

use std::io::{self, Read, Write};
use std::sync::Arc;

use crate::cells::{Cells, RecordError, open, write_row};
use crate::once::Shared;
use crate::points::RunInfo;

/// The file's name in a folder that a user asked for.
pub const JUDGEMENT: &str = "judgement.csv";
/// The file's name in a scenario's folder of records, where it is compressed as all tables are.
pub const RECORDED_JUDGEMENT: &str = "judgement.csv.gz";

/// The columns of the file.
pub const COLUMNS: [&str; 13] =
    ["scenario", "method", "model", "measure", "place", "value", "sigma", "count", "unit", "status", "reason", "seed", "revision"];

/// What came of one measure at one place.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Row {
    /// The operator.
    pub method: Arc<str>,
    /// The camera model; empty for what concerns none.
    pub model: Arc<str>,
    /// What was measured; one of [`super::measure`].
    pub measure: Arc<str>,
    /// The view, the split, the place in the frame.
    pub place: Arc<str>,
    /// Its value, in [`Self::unit`].
    pub value: Option<f64>,
    /// Its predicted standard deviation, or what the value is compared with.
    pub sigma: Option<f64>,
    /// Corners or modes behind it.
    pub count: Option<usize>,
    /// The unit of both, as in `px`; empty for numbers.
    pub unit: Arc<str>,
    /// `found`, or what stood in its way: `rejected`, `missed`, `left out`, `failed`, `unavailable`.
    pub status: Arc<str>,
    /// The reason.
    pub reason: Arc<str>,
}

impl Row {
    /// A figure in px; one that is not finite is none.
    pub fn px(measure: &str, place: &str, value: f64) -> Self {
        if value.is_finite() {
            let found = Self { measure: measure.into(), place: place.into(), unit: "px".into(), status: "found".into(), ..Self::default() };
            Self { value: Some(value), ..found }
        } else {
            Self::without(measure, place, "failed", "the camera does not picture what is needed")
        }
    }

    /// A figure without a unit.
    pub fn plain(measure: &str, place: &str, value: f64) -> Self {
        Self { unit: "".into(), ..Self::px(measure, place, value) }
    }

    /// No figure, and why.
    pub fn without(measure: &str, place: &str, status: &str, reason: &str) -> Self {
        Self { measure: measure.into(), place: place.into(), status: status.into(), reason: reason.into(), ..Self::default() }
    }

    /// The same with what is predicted for it, in the unit of its value, where that is a number.
    #[must_use]
    pub fn beside(self, sigma: f64) -> Self {
        Self { sigma: Some(sigma).filter(|sigma| sigma.is_finite()), ..self }
    }

    /// The same with a count.
    #[must_use]
    pub fn of(self, count: usize) -> Self {
        Self { count: Some(count), ..self }
    }

    /// The same for an operator and a model.
    #[must_use]
    pub fn by(self, method: &Arc<str>, model: &Arc<str>) -> Self {
        Self { method: method.clone(), model: model.clone(), ..self }
    }
}

/// Writes rows.
///
/// # Errors
/// What the output refuses.
pub fn write_rows(output: impl Write, run: &RunInfo, rows: &[Row]) -> io::Result<()> {
    let seed = run.seed.to_string();
    let number = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
    let cells = |row: &Row| -> [String; 13] {
        let count = row.count.map_or(String::new(), |count| count.to_string());
        let [method, model, measure, place] = [&row.method, &row.model, &row.measure, &row.place].map(ToString::to_string);
        let [unit, status, reason] = [&row.unit, &row.status, &row.reason].map(ToString::to_string);
        let (value, sigma) = (number(row.value), number(row.sigma));
        [run.scenario.clone(), method, model, measure, place, value, sigma, count, unit, status, reason, seed.clone(), run.revision.clone()]
    };
    let mut writer = csv::Writer::from_writer(output);
    writer.write_record(COLUMNS)?;
    rows.iter().try_for_each(|row| write_row(&mut writer, cells(row)))?;
    writer.flush()
}

/// Reads what [`write_rows`] wrote, and what all rows share; of a file without a row that is nothing.
///
/// # Errors
/// A file of another form, rows of several runs.
pub fn read_rows(input: impl Read) -> Result<(RunInfo, Vec<Row>), RecordError> {
    let (mut run, mut rows, mut shared) = (RunInfo::default(), Vec::new(), Shared::new([0, 11, 12]));
    for record in open(input, &COLUMNS)?.records() {
        let record = record?;
        let cells = Cells { record: &record, columns: &COLUMNS };
        shared.check(&cells)?;
        if rows.is_empty() {
            run = RunInfo { scenario: cells.text(0).into(), seed: cells.parse(11)?, revision: cells.text(12).into(), detector: None };
        }
        let [method, model, measure, place] = [1, 2, 3, 4].map(|column| cells.text(column).into());
        let [unit, status, reason] = [8, 9, 10].map(|column| cells.text(column).into());
        let (value, sigma, count) = (cells.optional_number(5)?, cells.optional_number(6)?, cells.optional(7)?);
        rows.push(Row { method, model, measure, place, value, sigma, count, unit, status, reason });
    }
    Ok((run, rows))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_again() {
        let rows = vec![
            Row::px("holdout", "a, b.jpg", 0.1 + 0.2).beside(1.0 / 3.0).of(54).by(&"m".into(), &"opencv5".into()),
            Row::without("split", "1", "failed", "no, \"not\" determined"),
            Row::px("straight", "v", f64::NAN),
        ];
        assert!(rows[2].value.is_none(), "never NaN");
        let run = RunInfo { scenario: "f/s".into(), seed: 7, revision: "r".into(), detector: None };
        let mut bytes = Vec::new();
        write_rows(&mut bytes, &run, &rows).unwrap();
        assert_eq!(read_rows(&bytes[..]).unwrap(), (run, rows));
        assert!(read_rows(&b"a,b\n"[..]).is_err());
    }
}
