//! Records of points: one tidy CSV a run, a row a point. What measuring leaves for scoring and reporting.

use std::io::{Read, Write};

use calibench_model::{PixelPoint, Rejection};

use csv::StringRecord;

use crate::cells::{Cells, RecordError, open, write_row};
use crate::interned::Names;
use crate::results::{MethodInfo, Outcome, PointResult, Trial};

/// The columns of a records file.
pub const COLUMNS: [&str; 17] = [
    "scenario",
    "trial",
    "view",
    "target",
    "method",
    "version",
    "x",
    "y",
    "dx",
    "dy",
    "bound",
    "predicted",
    "unit",
    "status",
    "reason",
    "seed",
    "revision",
];

const SCENARIO: usize = 0;
const TRIAL: usize = 1;
const VIEW: usize = 2;
const TARGET: usize = 3;
const METHOD: usize = 4;
const VERSION: usize = 5;
const X: usize = 6;
const Y: usize = 7;
const DX: usize = 8;
const DY: usize = 9;
const BOUND: usize = 10;
const PREDICTED: usize = 11;
const STATUS: usize = 13;
const REASON: usize = 14;
const SEED: usize = 15;
const REVISION: usize = 16;

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
    seed: String,
    methods: Vec<MethodInfo>,
}

/// Where and of which method a row is: trial, view, target, method, version.
type Place<'a> = [&'a str; 5];

/// The numbers of a point that was not measured.
const NONE: [String; 6] = [const { String::new() }; 6];

impl<W: Write> RecordWriter<W> {
    /// Starts a file with its header and a row for each unavailable method.
    ///
    /// # Errors
    /// What the output refuses.
    pub fn new(output: W, run: RunInfo, methods: Vec<MethodInfo>) -> Result<Self, csv::Error> {
        let mut csv = csv::Writer::from_writer(output);
        csv.write_record(COLUMNS)?;
        let mut writer = Self { csv, seed: run.seed.to_string(), run, methods: Vec::new() };
        if let Some((name, version)) = writer.run.detector.clone() {
            writer.row(["", "", "", &name, &version], &NONE, "", "detector", "gave the approximate positions")?;
        }
        for MethodInfo { label, version, unavailable } in &methods {
            if let Some(why) = unavailable {
                writer.row(["", "", "", label, version], &NONE, "", "unavailable", why)?;
            }
        }
        writer.methods = methods;
        Ok(writer)
    }

    /// Says of every available method that it is adjusted and measures no point: a row each, before all trials, so that records name their methods.
    ///
    /// # Errors
    /// What the output refuses.
    pub fn adjusted_alone(&mut self) -> Result<(), csv::Error> {
        let methods = std::mem::take(&mut self.methods);
        for MethodInfo { label, version, .. } in methods.iter().filter(|method| method.unavailable.is_none()) {
            self.row(["", "", "", label, version], &NONE, "", "adjusted", "measures no point")?;
        }
        self.methods = methods;
        Ok(())
    }

    /// Adds a trial: a row for each point, with its errors where the truth is known, its bound and the method's own standard deviation where there are
    /// such, or with the reason why it was rejected. Coordinates and errors have nine decimals, standard deviations six significant digits.
    ///
    /// # Errors
    /// What the output refuses.
    pub fn trial(&mut self, trial: &Trial) -> Result<(), csv::Error> {
        let number = trial.number.to_string();
        let methods = std::mem::take(&mut self.methods);
        for (view, why) in &trial.missed_views {
            for method in methods.iter().filter(|method| method.unavailable.is_none()) {
                self.row([&number, view, "", &method.label, &method.version], &NONE, "", "missed", why)?;
            }
        }
        for point in &trial.points {
            let (label, version) = methods.get(point.method).map_or(("", ""), |m| (&*m.label, &*m.version));
            let place = [&*number, &*point.view, &*point.target, label, version];
            match point.outcome {
                Outcome::Rejected(why) => self.row(place, &NONE, "px", "rejected", why.name())?,
                Outcome::Measured { position, error } => {
                    let status = if point.outcome.is_lost() { "lost" } else { "measured" };
                    let [dx, dy] = [error.map(|e| e.0), error.map(|e| e.1)];
                    let [x, y, dx, dy] = [Some(position.x), Some(position.y), dx, dy].map(|at| at.map_or_else(String::new, coordinate));
                    let [bound, predicted] = [point.bound, point.predicted].map(|sigma| sigma.map_or_else(String::new, deviation));
                    self.row(place, &[x, y, dx, dy, bound, predicted], "px", status, "")?;
                }
            }
        }
        self.methods = methods;
        Ok(())
    }

    /// Ends the file and gives back its output.
    ///
    /// # Errors
    /// What the output refuses.
    pub fn finish(self) -> Result<W, csv::Error> {
        Ok(self.csv.into_inner().map_err(csv::IntoInnerError::into_error)?)
    }

    fn row(&mut self, place: Place<'_>, numbers: &[String; 6], unit: &str, status: &str, reason: &str) -> Result<(), csv::Error> {
        let head = [&*self.run.scenario].into_iter().chain(place);
        let tail = [unit, status, reason, &self.seed, &self.run.revision];
        write_row(&mut self.csv, head.chain(numbers.iter().map(String::as_str)).chain(tail))
    }
}

/// To how many parts of a pixel coordinates and errors are written: far more than an operator finds, in files a third smaller than with every digit.
const PARTS: f64 = 1e9;

/// A coordinate or an error, to nine decimals.
fn coordinate(px: f64) -> String {
    // Dividing by a power of ten gives the number nearest to the decimals; adding zero turns -0 into 0.
    let rounded = (px * PARTS).round() / PARTS + 0.0;
    (if rounded.is_finite() { rounded } else { px }).to_string()
}

/// A standard deviation, to six significant digits.
fn deviation(px: f64) -> String {
    format!("{px:.5e}").parse().map_or_else(|_| px.to_string(), |rounded: f64| rounded.to_string())
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
    let (mut trial, mut names, mut last, mut record) = (None::<Trial>, Known::default(), 0, StringRecord::new());
    while csv.read_record(&mut record)? {
        let row = Cells { record: &record, columns: &COLUMNS };
        if head.run.scenario.is_empty() {
            head.run = RunInfo {
                scenario: row.text(SCENARIO).into(),
                seed: row.parse(SEED)?,
                revision: row.text(REVISION).into(),
                detector: None,
            };
        }
        if row.text(STATUS) == "detector" {
            head.run.detector = Some((row.text(METHOD).into(), row.text(VERSION).into()));
            continue;
        }
        let method = method_index(&mut head.methods, &row, last)?;
        last = method;
        if row.text(STATUS) == "unavailable" {
            head.methods[method].unavailable = Some(row.text(REASON).to_owned());
            continue;
        }
        if row.text(STATUS) == "adjusted" {
            continue;
        }
        let number = row.parse(TRIAL)?;
        if trial.as_ref().is_some_and(|trial| trial.number != number) {
            trial.take().into_iter().for_each(|trial| sink(trial, &head.methods));
        }
        add(trial.get_or_insert_with(|| Trial { number, ..Trial::default() }), &row, method, &mut names)?;
    }
    trial.into_iter().for_each(|trial| sink(trial, &head.methods));
    Ok(head)
}

/// `last` is the place of the method of the row before: mostly it is the same.
fn method_index(methods: &mut Vec<MethodInfo>, row: &Cells<'_>, last: usize) -> Result<usize, RecordError> {
    let (label, version) = (row.text(METHOD), row.text(VERSION));
    if label.is_empty() {
        return Err(row.wrong("a row without a method"));
    }
    if methods.get(last).is_some_and(|method| &*method.label == label) {
        return Ok(last);
    }
    let place = methods.iter().position(|m| &*m.label == label);
    Ok(place.unwrap_or_else(|| {
        methods.push(MethodInfo { label: label.into(), version: version.into(), unavailable: None });
        methods.len() - 1
    }))
}

/// Names of views and targets, each of which is kept once.
#[derive(Default)]
struct Known {
    views: Names,
    targets: Names,
}

/// Adds a row to its trial.
fn add(trial: &mut Trial, row: &Cells<'_>, method: usize, names: &mut Known) -> Result<(), RecordError> {
    let view = names.views.get(row.text(VIEW));
    let outcome = match row.text(STATUS) {
        "missed" => {
            // One row a method: the view is missed once.
            let missed = (view, row.text(REASON).to_owned());
            if !trial.missed_views.contains(&missed) {
                trial.missed_views.push(missed);
            }
            return Ok(());
        }
        "rejected" => {
            let why = Rejection::ALL.into_iter().find(|why| why.name() == row.text(REASON));
            Outcome::Rejected(why.ok_or_else(|| row.wrong("unknown reason"))?)
        }
        "measured" | "lost" => {
            let error = match (row.optional_number(DX)?, row.optional_number(DY)?) {
                (Some(dx), Some(dy)) => Some((dx, dy)),
                (None, None) => None,
                _ => return Err(row.wrong("one of `dx` and `dy` without the other")),
            };
            Outcome::Measured { position: PixelPoint::new(row.number(X)?, row.number(Y)?), error }
        }
        _ => return Err(row.bad(STATUS)),
    };
    let (bound, predicted) = (row.optional_number(BOUND)?, row.optional_number(PREDICTED)?);
    let target = names.targets.get(row.text(TARGET));
    trial.points.push(PointResult { bound, predicted, ..PointResult::new(view, target, method, outcome) });
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn example() -> (Vec<MethodInfo>, Vec<Trial>) {
        let info =
            |label: &str, why: Option<&str>| MethodInfo { label: label.into(), version: "1".into(), unavailable: why.map(str::to_owned) };
        let point = |method, target: &str, outcome| PointResult::new("v", target, method, outcome);
        let measured = |x: f64, error| Outcome::Measured { position: PixelPoint::new(x, 0.333_333_333), error };
        let trials = vec![
            Trial {
                number: 0,
                points: vec![
                    PointResult {
                        bound: Some(0.012_345),
                        predicted: Some(0.142_857),
                        ..point(1, "a", measured(0.3, Some((-0.000_000_001, -3.5))))
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
    fn digits_are_those_that_are_worth_something() {
        for (px, expected) in
            [(0.1 + 0.2, "0.3"), (-1e-17, "0"), (1.0 / 3.0, "0.333333333"), (-2_500.123_456_789_6, "-2500.12345679"), (1e-9, "0.000000001")]
        {
            assert_eq!(coordinate(px), expected);
        }
        // What is out of all bounds stays a number.
        assert_eq!(coordinate(1e300).parse::<f64>().unwrap(), 1e300);
        for (px, expected) in [(1.0 / 7.0, "0.142857"), (0.000_012_345_678, "0.0000123457"), (12.5, "12.5"), (0.0, "0")] {
            assert_eq!(deviation(px), expected);
        }
    }

    #[test]
    fn what_is_written_is_read_again() {
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
    fn methods_without_points_are_named() {
        let (methods, _) = example();
        let run = RunInfo { scenario: "f/s".into(), seed: 9, revision: "abc".into(), detector: None };
        let mut bytes = Vec::new();
        let mut writer = RecordWriter::new(&mut bytes, run.clone(), methods.clone()).unwrap();
        writer.adjusted_alone().unwrap();
        writer.trial(&Trial::default()).unwrap();
        writer.finish().unwrap();
        let head = read_records(&bytes[..], |_, _| panic!("there is no point")).unwrap();
        assert_eq!(head, RecordHead { run, methods });
    }

    #[test]
    fn other_files_are_refused() {
        assert!(read_records(&b"a,b\n1,2\n"[..], |_, _| ()).is_err());
        for (rows, expected) in [
            ("s,0,v,t,,1,1,2,,,,,px,measured,,0,r\n", "line 2: a row without a method"),
            ("s,,,,,,,,,,,,,unavailable,why,0,r\n", "line 2: a row without a method"),
            ("s,0,v,t,m,1,1,2,,,,,px,found,,0,r\n", "line 2: column `status` holds `found`"),
            ("s,0,v,t,m,1,,,,,,,px,rejected,luck,0,r\n", "line 2: unknown reason"),
            ("s,0,v,t,m,1,1e999,2,,,,,px,measured,,0,r\n", "line 2: column `x` holds `1e999`"),
            ("s,0,v,t,m,1,1,NaN,,,,,px,measured,,0,r\n", "line 2: column `y` holds `NaN`"),
            ("s,0,v,t,m,1,1,,,,,,px,measured,,0,r\n", "line 2: column `y` holds ``"),
            ("s,0,v,t,m,1,1,2,,0.5,,,px,measured,,0,r\n", "line 2: one of `dx` and `dy` without the other"),
            ("s,0,v,t,m,1,1,2,0.5,,,,px,measured,,0,r\n", "line 2: one of `dx` and `dy` without the other"),
            ("s,0,v,t,m,1,1,2,,,inf,,px,measured,,0,r\n", "line 2: column `bound` holds `inf`"),
            ("s,-1,v,t,m,1,1,2,,,,,px,measured,,0,r\n", "line 2: column `trial` holds `-1`"),
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
