//! What calibration systems made of classes of tasks, trial by trial: tables that are committed, one for each calibrator.

use std::fs::File;
use std::io::{self, Write};
use std::path::Path;

use serde::{Deserialize, Serialize};

/// The ending of the tables.
const ENDING: &str = "csv";
/// How an answered trial ends.
pub const ENDED: [&str; 4] = ["calibrated", "doubtful", "refused", "failed"];
/// The status of a calibrator that does not have the model that a class asks for.
pub const UNAVAILABLE: &str = "unavailable";

/// One calibrator's answer in one trial of one class.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Answered {
    /// The class: the name of a scenario.
    pub class: String,
    /// A digest of all that the answer depends on beside the system's version.
    pub digest: String,
    /// The system.
    pub system: String,
    /// Its version.
    pub version: String,
    /// Counted from 0.
    pub trial: u64,
    /// How it ended: one of [`ENDED`], or [`UNAVAILABLE`].
    pub status: String,
    /// Distance from the true camera over the frame after the best rotation, RMS, px.
    pub frame: Option<f64>,
    /// The same where something was measured, px.
    pub covered: Option<f64>,
    /// Error of a length of 100 mm, RMS, mm.
    pub length: Option<f64>,
    /// What is stated over the frame, RMS, px.
    pub stated: Option<f64>,
    /// Mean square of errors over the frame in stated standard deviations.
    pub z2: Option<f64>,
    /// The same of parameters.
    pub z2_parameters: Option<f64>,
    /// In photographs that were left out: distance of points from where their camera predicts them, after a resection from every other point, RMS (2D), px.
    #[serde(default)]
    pub held_out: Option<f64>,
    /// The same after a resection from one side of the board, px.
    #[serde(default)]
    pub across: Option<f64>,
    /// RMS of residuals as reported, px.
    pub rms: Option<f64>,
    /// Image points that were left out.
    pub left_out: usize,
    /// Whether it was wrong and said nothing.
    pub silent: bool,
    /// Processor's time from question to answer, s.
    pub seconds: Option<f64>,
    /// The most memory in use so far, MB.
    pub peak_mb: Option<f64>,
    /// What it said first.
    pub message: String,
}

/// A class of tasks, and what calibrators are told in it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Class {
    /// The name of its scenario.
    pub class: String,
    /// What it is to show.
    pub why: String,
    /// The camera model that is asked for.
    pub model: String,
    /// Whether it is of photographs, of which no truth is known.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub photographs: bool,
}

/// Where the classes stand beside the tables.
const CLASSES: &str = "classes.json";

/// The classes of a folder of tables; none where there is no such folder.
///
/// # Errors
/// A file that cannot be read, or is no list of classes.
pub fn read_classes(folder: &Path) -> io::Result<Vec<Class>> {
    let path = folder.join(CLASSES);
    match std::fs::read(&path) {
        Ok(bytes) => serde_json::from_slice(&bytes).map_err(|error| io::Error::other(format!("{}: {error}", path.display()))),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(Vec::new()),
        Err(error) => Err(io::Error::new(error.kind(), format!("{}: {error}", path.display()))),
    }
}

/// The file of the classes, and what it holds.
///
/// # Errors
/// None of what it is made for.
pub fn written_classes(classes: &[Class]) -> io::Result<(&'static str, Vec<u8>)> {
    let mut text = serde_json::to_vec_pretty(classes)?;
    text.push(b'\n');
    Ok((CLASSES, text))
}

/// The rows of a calibrator's table.
///
/// # Errors
/// A file that cannot be read, or whose rows are none of this table: file and line.
pub fn read(path: &Path) -> io::Result<Vec<Answered>> {
    let wrong = |error: csv::Error| io::Error::other(format!("{}: {error}", path.display()));
    let file = match File::open(path) {
        Ok(file) => file,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
        Err(error) => return Err(io::Error::new(error.kind(), format!("{}: {error}", path.display()))),
    };
    csv::Reader::from_reader(file).deserialize().collect::<Result<_, _>>().map_err(wrong)
}

/// Writes rows as a table, to four digits: trial by trial in the order given.
///
/// # Errors
/// What the file system refuses.
pub fn write(out: impl Write, rows: &[Answered]) -> io::Result<()> {
    let mut writer = csv::Writer::from_writer(out);
    for row in rows {
        let short = |value: Option<f64>| value.filter(|value| value.is_finite()).map(four);
        writer.serialize(Answered {
            frame: short(row.frame),
            covered: short(row.covered),
            length: short(row.length),
            stated: short(row.stated),
            z2: short(row.z2),
            z2_parameters: short(row.z2_parameters),
            held_out: short(row.held_out),
            across: short(row.across),
            rms: short(row.rms),
            seconds: short(row.seconds),
            peak_mb: short(row.peak_mb),
            ..row.clone()
        })?;
    }
    writer.flush()
}

/// A number to four significant digits.
fn four(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

/// All tables of a folder with their calibrators' names, by these; none of a folder that is not there.
///
/// # Errors
/// As [`read`].
pub fn read_all(folder: &Path) -> io::Result<Vec<(String, Vec<Answered>)>> {
    let entries = match std::fs::read_dir(folder) {
        Ok(entries) => entries.collect::<Result<Vec<_>, _>>()?,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
        Err(error) => return Err(error),
    };
    let mut paths: Vec<_> =
        entries.into_iter().map(|entry| entry.path()).filter(|path| path.extension().is_some_and(|own| own == ENDING)).collect();
    paths.sort();
    let named = |path: std::path::PathBuf| {
        let name = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
        read(&path).map(|rows| (name, rows))
    };
    paths.into_iter().map(named).collect()
}

/// The median of errors of trials; one without a camera is infinitely far off. `None` of no trials.
pub fn median(errors: impl IntoIterator<Item = Option<f64>>) -> Option<f64> {
    let mut all: Vec<f64> = errors.into_iter().map(|error| error.unwrap_or(f64::INFINITY)).collect();
    all.sort_by(f64::total_cmp);
    let n = all.len();
    if n % 2 == 1 { Some(all[n / 2]) } else { (n > 0).then(|| f64::midpoint(all[n / 2 - 1], all[n / 2])) }
}

/// The file of a calibrator's table in its folder.
pub fn file_of(calibrator: &str) -> String {
    format!("{calibrator}.{ENDING}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(trial: u64) -> Answered {
        Answered {
            class: "league/good".into(),
            digest: "d".into(),
            system: "s".into(),
            version: "1".into(),
            trial,
            status: "calibrated".into(),
            frame: Some(0.123_456),
            covered: Some(12_345.6),
            stated: Some(f64::NAN),
            z2: Some(1.0),
            rms: Some(0.1),
            left_out: 3,
            silent: true,
            seconds: Some(0.5),
            message: "says \"a, b\"".into(),
            ..Answered::default()
        }
    }

    #[test]
    fn a_trial_without_a_camera_counts_in_the_median() {
        assert_eq!(median([]), None);
        assert_eq!(median([Some(3.0), None, Some(1.0)]), Some(3.0));
        assert_eq!(median([Some(3.0), Some(1.0)]), Some(2.0));
        assert_eq!(median([Some(3.0), None]), Some(f64::INFINITY));
    }

    #[test]
    fn tables_are_read_as_they_are_written_to_four_digits() {
        let folder = std::env::temp_dir().join(format!("calibench-league-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let path = folder.join(file_of("one"));
        write(File::create(&path).unwrap(), &[row(0), row(1)]).unwrap();
        let kept = |trial| Answered { frame: Some(0.1235), covered: Some(12_350.0), stated: None, ..row(trial) };
        assert_eq!(read_all(&folder).unwrap(), [("one".to_owned(), vec![kept(0), kept(1)])]);
        std::fs::write(&path, "class,trial\na,b\n").unwrap();
        let error = read(&path).unwrap_err().to_string();
        assert!(error.contains("one.csv") && error.contains("line"), "{error}");
        std::fs::remove_dir_all(&folder).unwrap();
        assert!(read(&path).unwrap().is_empty() && read_all(&folder).unwrap().is_empty());
    }
}
