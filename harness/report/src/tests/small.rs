//! A family of one scenario with two trials of two methods, and a published table.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use calibench_model::{PixelPoint, Rejection};
use calibench_records::compressor::Compressor;
use calibench_records::description::{self, Description, Study};
use calibench_records::figures::{FigureName, Group, Units};
use calibench_records::names::DESCRIPTION;
use calibench_records::points::{RecordWriter, RunInfo};
use calibench_records::results::{Figure, MethodInfo, Outcome, PointResult, Trial};
use calibench_records::statistics::running::Running;
use calibench_records::stored::{Table, open};
use tempfile::TempDir;

use crate::{Places, fill};

const NAME: &str = "small/scene";

const TABLE: &str = r#"
title = "Table 1: errors"
source = "Nobody 2000, p. 1"
unit = "px"
scenario = "small/scene"
method = "centroid:window=15"
columns = ["dx", "dy"]
findings = ["The figures are made up."]

[[set]]
name = "all"

[[set]]
name = "without a"
except = ["a"]

[[cell]]
row = "a"
column = "dx"
printed = "0.03"
metric = "dx"
kind = "prediction"
target = "a"

[[cell]]
row = "a"
column = "dy"
printed = "0.10"
metric = "dy"
kind = "prediction"
target = "a"

[[cell]]
row = "b"
column = "dx"
printed = "-0.01"
metric = "dx"
kind = "prediction"
target = "b"

[[cell]]
row = "b"
column = "dy"
printed = "7"
metric = "dy"
kind = "prediction"
target = "b"
not_comparable = "another axis"

[[cell]]
row = "all"
column = "dx"
printed = "0.022"
metric = "rmse_x"
kind = "prediction"

[[cell]]
row = "all"
column = "dy"
printed = "0.039"
metric = "rmse_xy"
kind = "prediction"
"#;

fn description() -> Description {
    Description {
        why: "Three discs.".into(),
        source: "ours".into(),
        notes: vec!["Nothing is rendered here.".into()],
        seed: 5,
        trials: 2,
        bound_window: 15,
        bound_window_discs: None,
        finders: Vec::new(),
        methods: vec!["pixel".into(), "centroid:window=15".into()],
        defaults: [("pixel".into(), "pixel".into()), ("centroid".into(), "centroid:window=15".into())].into(),
        study: Study::Scene,
        sweep: None,
    }
}

fn trial(number: u64, pixel: [(f64, f64); 3], centroid: [Option<(f64, f64)>; 3]) -> Trial {
    let truth = [("a", 13.0), ("b", 30.0), ("c", 47.0)];
    let measured = |at: f64, (dx, dy)| Outcome::Measured { position: PixelPoint::new(at + dx, 13.0 + dy), error: Some((dx, dy)) };
    let of = |method, outcomes: [Outcome; 3]| {
        truth.into_iter().zip(outcomes).map(move |((target, _), outcome)| PointResult::new("image", target, method, outcome))
    };
    let place = |index: usize| truth[index].1;
    let pixel = of(0, std::array::from_fn(|i| measured(place(i), pixel[i])));
    let rejected = Outcome::Rejected(Rejection::Border);
    let centroid = of(1, std::array::from_fn(|i| centroid[i].map_or(rejected, |error| measured(place(i), error))));
    Trial { number, points: pixel.chain(centroid).collect(), ..Trial::default() }
}

/// The family in a scratch folder.
pub struct Family {
    folder: TempDir,
}

/// A table in the folder of a run, to be filled.
pub fn new_table(folder: &Path, table: Table) -> Compressor<fs::File> {
    Compressor::new(fs::File::create(folder.join(table.file())).unwrap())
}

impl Family {
    pub fn new() -> Self {
        let family = Self { folder: tempfile::tempdir().unwrap() };
        let records = family.folder.path().join("records").join(NAME);
        fs::create_dir_all(&records).unwrap();
        fs::create_dir_all(family.folder.path().join("published/small")).unwrap();
        fs::write(family.folder.path().join("published/small/table-1.toml"), TABLE).unwrap();
        let info = |label: &str| MethodInfo { label: label.into(), version: "1".into(), unavailable: None };
        let run = RunInfo { scenario: NAME.into(), seed: 5, revision: "r".into(), detector: None };
        let file = new_table(family.records().parent().unwrap(), Table::Points);
        let mut writer = RecordWriter::new(file, run, vec![info("pixel"), info("centroid:window=15")]).unwrap();
        let first = [Some((0.03, 0.04)), Some((-0.01, 0.02)), None];
        let second = [Some((0.05, 0.0)), Some((3.0, 4.0)), Some((0.02, -0.02))];
        writer.trial(&trial(0, [(0.3, 0.4), (0.0, 0.0), (0.0, 0.5)], first)).unwrap();
        writer.trial(&trial(1, [(0.0, 0.1), (0.1, 0.0), (-0.4, 0.3)], second)).unwrap();
        writer.finish().unwrap().finish().unwrap();
        family.describe(&description());
        family
    }

    /// The records of points as plain CSV.
    pub fn text(&self) -> String {
        std::io::read_to_string(open(&self.records()).unwrap()).unwrap()
    }

    /// Puts plain CSV in the place of a table of the run.
    pub fn put(&self, table: Table, text: &str) {
        let mut file = new_table(self.records().parent().unwrap(), table);
        file.write_all(text.as_bytes()).unwrap();
        file.finish().unwrap();
    }

    pub fn records(&self) -> PathBuf {
        self.folder.path().join("records").join(NAME).join(Table::Points.file())
    }

    /// Three trials in place of two.
    pub fn ask_for_three_trials(&self) {
        self.describe(&Description { trials: 3, ..description() });
    }

    fn describe(&self, scenario: &Description) {
        let file = fs::File::create(self.records().with_file_name(DESCRIPTION)).unwrap();
        description::write(file, scenario).unwrap();
    }

    fn write(&self) -> Result<PathBuf, String> {
        let at = |name: &str| self.folder.path().join(name);
        let places = Places {
            records: at("records"),
            published: at("published"),
            cameras: at("cameras"),
            league: at("league"),
            reports: at("reports"),
        };
        fill(&places, "small", &[NAME.to_owned()]).and_then(crate::Filled::put).map_err(|error| error.to_string())?;
        Ok(at("reports/small/README.md"))
    }

    pub fn page(&self) -> String {
        fs::read_to_string(self.write().unwrap()).unwrap()
    }

    /// Why there is no page, without the scratch folder's path.
    pub fn message(&self) -> String {
        self.write().unwrap_err().replace(&self.folder.path().display().to_string(), "")
    }
}

/// The first line of a page that begins so.
pub fn line<'a>(page: &'a str, start: &str) -> &'a str {
    page.lines().find(|line| line.starts_with(start)).unwrap_or_else(|| panic!("no line begins with {start}\n{page}"))
}

/// What values of trials have in common.
pub fn running(values: &[f64]) -> Running {
    let mut running = Running::default();
    values.iter().for_each(|value| running.add(*value));
    running
}

/// The first row of any table that begins with these cells.
pub fn row(page: &str, start: &[&str]) -> Vec<String> {
    let rows = page.lines().filter(|line| line.starts_with('|'));
    let mut cells = rows.map(|line| line.trim_matches('|').split('|').map(|cell| cell.trim().to_owned()).collect::<Vec<_>>());
    cells.find(|cells| cells.iter().zip(start).all(|(cell, start)| cell == start)).unwrap_or_else(|| panic!("no row {start:?}\n{page}"))
}

/// A figure by its name in files, in a unit that it has.
pub fn figure(group: Group, name: &str, value: f64) -> Figure {
    let name = FigureName::parse(group, name).unwrap();
    let unit = match name.quantity().entry().units {
        Units::One(unit) | Units::Either(&[unit, ..]) => unit,
        Units::Object => "m",
        _ => "",
    };
    Figure::plain(name, value, unit)
}
