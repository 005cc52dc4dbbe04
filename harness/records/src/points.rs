//! Records: one tidy CSV a scenario. What measuring leaves for scoring and reporting.

use std::io::{Read, Write};
use std::sync::Arc;

use calibench_model::{PixelPoint, Rejection};

use crate::cells::{Cells, RecordError, open, write_row};
use crate::results::{MethodInfo, Outcome, PointResult, Trial};

/// The columns of a records file.
pub const COLUMNS: [&str; 13] =
    ["scenario", "trial", "view", "target", "method", "version", "metric", "value", "unit", "status", "reason", "seed", "revision"];

/// What all rows of a file share.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RunInfo {
    /// The scenario's name.
    pub scenario: String,
    /// The seed of the run.
    pub seed: u64,
    /// The code's revision.
    pub revision: String,
    /// Name and version of the detector that gave the approximate positions, where one did.
    pub detector: Option<(String, String)>,
}

/// Writes records, trial by trial.
pub struct RecordWriter<W: Write> {
    csv: csv::Writer<W>,
    run: RunInfo,
    methods: Vec<MethodInfo>,
}

impl<W: Write> RecordWriter<W> {
    /// Starts a file with its header and a row for each unavailable method.
    ///
    /// # Errors
    /// What the output refuses.
    pub fn new(output: W, run: RunInfo, methods: Vec<MethodInfo>) -> Result<Self, csv::Error> {
        let mut csv = csv::Writer::from_writer(output);
        csv.write_record(COLUMNS)?;
        if let Some((name, version)) = &run.detector {
            let (seed, nothing) = (run.seed.to_string(), "");
            let (status, reason) = ("detector", "gave the approximate positions");
            let cells: [&str; 13] =
                [&run.scenario, nothing, nothing, nothing, name, version, nothing, nothing, nothing, status, reason, &seed, &run.revision];
            write_row(&mut csv, cells)?;
        }
        let mut writer = Self { csv, run, methods };
        for method in 0..writer.methods.len() {
            if let Some(why) = writer.methods[method].unavailable.clone() {
                writer.row(["", "", ""], method, ["", "", ""], "unavailable", &why)?;
            }
        }
        Ok(writer)
    }

    /// Adds a trial: for each measured point its metrics x and y, dx and dy where the truth is known, its bound and the method's own standard deviation where
    /// there are such; for each rejected one a row.
    ///
    /// # Errors
    /// What the output refuses.
    pub fn trial(&mut self, trial: &Trial) -> Result<(), csv::Error> {
        let number = trial.number.to_string();
        for (view, why) in &trial.missed_views {
            for method in (0..self.methods.len()).filter(|&m| self.methods[m].unavailable.is_none()).collect::<Vec<_>>() {
                self.row([&number, view, ""], method, ["", "", ""], "missed", why)?;
            }
        }
        for point in &trial.points {
            let place = [&*number, &*point.view, &*point.target];
            match point.outcome {
                Outcome::Rejected(why) => self.row(place, point.method, ["x", "", "px"], "rejected", why.name())?,
                Outcome::Measured { position, error } => {
                    let status = if point.outcome.is_lost() { "lost" } else { "measured" };
                    let [dx, dy] = [error.map(|e| e.0), error.map(|e| e.1)];
                    let [x, y] = [Some(position.x), Some(position.y)];
                    let metrics = [("x", x), ("y", y), ("dx", dx), ("dy", dy), ("bound", point.bound), ("predicted", point.predicted)];
                    for (metric, value) in metrics {
                        if let Some(value) = value {
                            self.row(place, point.method, [metric, &value.to_string(), "px"], status, "")?;
                        }
                    }
                }
            }
        }
        Ok(())
    }

    /// Writes what is buffered.
    ///
    /// # Errors
    /// What the output refuses.
    pub fn finish(mut self) -> Result<(), csv::Error> {
        Ok(self.csv.flush()?)
    }

    fn row(&mut self, place: [&str; 3], method: usize, metric: [&str; 3], status: &str, reason: &str) -> Result<(), csv::Error> {
        let (label, version) = self.methods.get(method).map_or(("", ""), |m| (&*m.label, &*m.version));
        let seed = self.run.seed.to_string();
        let [trial, view, target] = place;
        let [metric, value, unit] = metric;
        let cells: [&str; 13] =
            [&self.run.scenario, trial, view, target, label, version, metric, value, unit, status, reason, &seed, &self.run.revision];
        write_row(&mut self.csv, cells)
    }
}

/// What a records file holds besides its trials.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RecordHead {
    /// What all rows share.
    pub run: RunInfo,
    /// The methods, in the order of their first row.
    pub methods: Vec<MethodInfo>,
}

/// Reads records and hands on one trial after the other with the methods met so far, which the trial's points index.
///
/// # Errors
/// A file that was not written by [`RecordWriter`].
pub fn read_records(input: impl Read, mut sink: impl FnMut(Trial, &[MethodInfo])) -> Result<RecordHead, RecordError> {
    let mut csv = open(input, &COLUMNS)?;
    let mut head = RecordHead { run: RunInfo::default(), methods: Vec::new() };
    let mut trial: Option<Trial> = None;
    for record in csv.records() {
        let record = record?;
        let row = Cells { record: &record, columns: &COLUMNS };
        if head.run.scenario.is_empty() {
            head.run = RunInfo { scenario: row.text(0).into(), seed: row.parse(11)?, revision: row.text(12).into(), detector: None };
        }
        if row.text(9) == "detector" {
            head.run.detector = Some((row.text(4).into(), row.text(5).into()));
            continue;
        }
        let method = method_index(&mut head.methods, &row);
        if row.text(9) == "unavailable" {
            let method = method.ok_or_else(|| row.wrong("a row without a method"))?;
            head.methods[method].unavailable = Some(row.text(10).to_owned());
            continue;
        }
        let number = row.parse(1)?;
        if trial.as_ref().is_some_and(|trial| trial.number != number) {
            trial.take().into_iter().try_for_each(|trial| whole(&trial, row.line()).map(|()| sink(trial, &head.methods)))?;
        }
        let trial = trial.get_or_insert_with(|| Trial { number, ..Trial::default() });
        let method = method.ok_or_else(|| row.wrong("a row without a method"))?;
        if row.text(9) == "missed" {
            // One row a method: the view is missed once.
            let missed = (row.text(2).into(), row.text(10).to_owned());
            if !trial.missed_views.contains(&missed) {
                trial.missed_views.push(missed);
            }
            continue;
        }
        add(trial, &row, method)?;
    }
    let end = csv.position().line();
    trial.into_iter().try_for_each(|trial| whole(&trial, end).map(|()| sink(trial, &head.methods)))?;
    Ok(head)
}

fn method_index(methods: &mut Vec<MethodInfo>, row: &Cells<'_>) -> Option<usize> {
    let (label, version) = (row.text(4), row.text(5));
    if label.is_empty() {
        return None;
    }
    let place = methods.iter().position(|m| &*m.label == label);
    Some(place.unwrap_or_else(|| {
        methods.push(MethodInfo { label: label.into(), version: version.into(), unavailable: None });
        methods.len() - 1
    }))
}

/// Both coordinates of the last point of a trial are there; else a row is missing on or before `line`.
fn whole(trial: &Trial, line: u64) -> Result<(), RecordError> {
    let wrong = |problem: &str| Err(RecordError::Row { line, problem: problem.to_owned() });
    match trial.points.last().map(|point| &point.outcome) {
        Some(Outcome::Measured { position, .. }) if position.y.is_nan() => wrong("the point that ends here has no y"),
        Some(Outcome::Measured { error: Some((_, dy)), .. }) if dy.is_nan() => wrong("the point that ends here has dx and no dy"),
        _ => Ok(()),
    }
}

/// Adds a row to a trial; the rows of one point follow each other.
fn add(trial: &mut Trial, row: &Cells<'_>, method: usize) -> Result<(), RecordError> {
    let (view, target) = (row.text(2), row.text(3));
    if row.text(9) == "rejected" {
        whole(trial, row.line())?;
        let why = Rejection::ALL.into_iter().find(|why| why.name() == row.text(10));
        let why = why.ok_or_else(|| row.wrong("unknown reason"))?;
        trial.points.push(PointResult::new(view, target, method, Outcome::Rejected(why)));
        return Ok(());
    }
    let value = row.number(7)?;
    if row.text(6) == "x" {
        whole(trial, row.line())?;
        let share = |old: Option<&Arc<str>>, new: &str| old.filter(|old| &***old == new).cloned().unwrap_or_else(|| new.into());
        let view = share(trial.points.last().map(|p| &p.view), view);
        let outcome = Outcome::Measured { position: PixelPoint::new(value, f64::NAN), error: None };
        trial.points.push(PointResult::new(view, target, method, outcome));
        return Ok(());
    }
    let last = trial.points.last_mut().filter(|p| p.method == method && &*p.target == target && &*p.view == view);
    let Some(PointResult { outcome: Outcome::Measured { position, error }, bound, predicted, .. }) = last else {
        return Err(row.wrong("a metric without its point"));
    };
    match row.text(6) {
        "y" => position.y = value,
        "dx" => *error = Some((value, f64::NAN)),
        "dy" => error.as_mut().ok_or_else(|| row.wrong("a dy without its dx"))?.1 = value,
        "bound" => *bound = Some(value),
        "predicted" => *predicted = Some(value),
        _ => return Err(row.wrong("unknown metric")),
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn example() -> (Vec<MethodInfo>, Vec<Trial>) {
        let info =
            |label: &str, why: Option<&str>| MethodInfo { label: label.into(), version: "1".into(), unavailable: why.map(str::to_owned) };
        let point = |method, target: &str, outcome| PointResult::new("v", target, method, outcome);
        let measured = |x: f64, error| Outcome::Measured { position: PixelPoint::new(x, 1.0 / 3.0), error };
        let trials = vec![
            Trial {
                number: 0,
                points: vec![
                    PointResult {
                        bound: Some(0.012_345),
                        predicted: Some(1.0 / 7.0),
                        ..point(1, "a", measured(0.1 + 0.2, Some((1e-17, -3.5))))
                    },
                    point(1, "b", Outcome::Rejected(Rejection::NoCorner)),
                    point(2, "a", measured(7.0, None)),
                ],
                missed_views: vec![("w".into(), "no board, sorry".into())],
                ..Trial::default()
            },
            Trial { number: 3, points: vec![point(2, "a", measured(-1.0, Some((0.5, 0.25))))], ..Trial::default() },
        ];
        (vec![info("absent", Some("not built")), info("m:w=1,k=2", None), info("n", None)], trials)
    }

    #[test]
    fn what_is_written_is_read_again_to_the_last_bit() {
        let (methods, trials) = example();
        let detector = Some(("board".into(), "2".into()));
        let run = RunInfo { scenario: "f/s".into(), seed: 9, revision: "abc".into(), detector };
        let mut bytes = Vec::new();
        let mut writer = RecordWriter::new(&mut bytes, run.clone(), methods.clone()).unwrap();
        trials.iter().for_each(|trial| writer.trial(trial).unwrap());
        writer.finish().unwrap();
        let mut again = Vec::new();
        let head = read_records(&bytes[..], |trial, _| again.push(trial)).unwrap();
        assert_eq!(head, RecordHead { run, methods });
        assert_eq!(again, trials);
        assert!(String::from_utf8(bytes).unwrap().contains(",lost,"), "3.5 px off is lost");
    }

    #[test]
    fn other_files_are_refused() {
        assert!(read_records(&b"a,b\n1,2\n"[..], |_, _| ()).is_err());
        for (rows, expected) in [
            ("s,0,v,t,m,1,dx,1,px,measured,,0,r\n", "line 2: a metric without its point"),
            ("s,,,,,,,,,unavailable,why,0,r\n", "line 2: a row without a method"),
            ("s,0,v,t,m,1,x,1e999,px,measured,,0,r\n", "line 2: column `value` holds `1e999`"),
            ("s,0,v,t,m,1,x,NaN,px,measured,,0,r\n", "line 2: column `value` holds `NaN`"),
            ("s,0,v,t,m,1,x,1,px,measured,,0,r\ns,0,v,u,m,1,x,1,px,measured,,0,r\n", "line 3: the point that ends here has no y"),
            ("s,0,v,t,m,1,x,1,px,measured,,0,r\n", "line 3: the point that ends here has no y"),
            ("s,0,v,t,m,1,x,1,px,measured,,0,r\ns,0,v,t,m,1,dy,1,px,measured,,0,r\n", "line 3: a dy without its dx"),
        ] {
            let text = format!("{}\n{rows}", COLUMNS.join(","));
            let error = read_records(text.as_bytes(), |_, _| ()).unwrap_err().to_string();
            assert!(error.contains(expected), "{rows}: {error}");
        }
    }

    #[test]
    fn names_are_no_formulas_and_are_read_again() {
        let (methods, mut trials) = example();
        trials[0].points[0].target = "=HYPERLINK(\"x\")".into();
        trials[0].points[2].target = "-12".into();
        let mut bytes = Vec::new();
        let mut writer = RecordWriter::new(&mut bytes, RunInfo::default(), methods).unwrap();
        trials.iter().for_each(|trial| writer.trial(trial).unwrap());
        writer.finish().unwrap();
        let text = String::from_utf8(bytes.clone()).unwrap();
        assert!(text.contains(",\"'=HYPERLINK(") && text.contains(",v,-12,") && !text.contains(",=") && !text.contains(",\"="), "{text}");
        let mut again = Vec::new();
        read_records(&bytes[..], |trial, _| again.push(trial)).unwrap();
        assert_eq!(again, trials);
    }

    /// The second row must go on with the point of the first: the same view, target and method.
    #[test]
    fn a_metric_belongs_to_the_point_above_it() {
        let read = |row: &str| {
            let text = format!("{}\ns,0,v,t,m,1,x,1,px,measured,,0,r\n{row}", COLUMNS.join(","));
            let mut found = Vec::new();
            read_records(text.as_bytes(), |trial, _| found.extend(trial.points)).map(|_| found)
        };
        let own = read("s,0,v,t,m,1,y,2,px,measured,,0,r\n").unwrap();
        let outcome = Outcome::Measured { position: PixelPoint::new(1.0, 2.0), error: None };
        assert_eq!(own, [PointResult::new("v", "t", 0, outcome)]);
        for other in ["s,0,w,t,m,1,y,2,px,measured,,0,r\n", "s,0,v,u,m,1,y,2,px,measured,,0,r\n", "s,0,v,t,n,1,y,2,px,measured,,0,r\n"] {
            let error = read(other).unwrap_err().to_string();
            assert!(error.contains("line 3: a metric without its point"), "{other}: {error}");
        }
        let cut = read("s,0,v,t,m,1,y,2,px,measured,,0,r\ns,0,v,t,m,1,dx,1,px,measured,,0,r\n").unwrap_err().to_string();
        assert!(cut.contains("the point that ends here has dx and no dy"), "{cut}");
    }

    #[test]
    fn points_keep_their_own_view() {
        let measured = |view: &str, x: f64| {
            PointResult::new(view, "t", 0, Outcome::Measured { position: PixelPoint::new(x, -x), error: Some((x, 0.25)) })
        };
        let points = vec![measured("v", 0.5), measured("w", 0.75), measured("w", 1.0), measured("v", 0.125)];
        let trials = [Trial { points: points.clone(), ..Trial::default() }, Trial { number: 1, points, ..Trial::default() }];
        let methods = vec![MethodInfo { label: "m".into(), version: "1".into(), unavailable: None }];
        let mut bytes = Vec::new();
        let mut writer = RecordWriter::new(&mut bytes, RunInfo { scenario: "s".into(), ..RunInfo::default() }, methods).unwrap();
        trials.iter().for_each(|trial| writer.trial(trial).unwrap());
        writer.finish().unwrap();
        let mut again = Vec::new();
        read_records(&bytes[..], |trial, _| again.push(trial)).unwrap();
        assert_eq!(again, trials);
    }
}
