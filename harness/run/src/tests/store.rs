//! Records in their folder.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use calibench_measure::Registry;
use calibench_records::figures::Group;
use calibench_records::names::{cell_folder, cell_run};
use calibench_records::results::{Outcome, PointResult};
use calibench_records::stored::{read_adjustments, read_points};
use calibench_scenario::Scenario;

use super::{NAME, SCENARIO, scenario, trials};
use crate::Order;
use crate::store::{RecordsFolder, SweepPlan, run, run_sweep};
use crate::{Plan, RunError};

fn stored(records: &Path, scenario: &Scenario) -> Result<u64, RunError> {
    run(&RecordsFolder::open(records, &scenario.name, None)?, &Plan::new(scenario, crate::Tools::default(), PathBuf::new()), "r1", &|| ())
}

/// Names and contents of all files below a folder.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_dir() {
            found.extend(files(&path).into_iter().map(|(below, bytes)| (format!("{name}/{below}"), bytes)));
        } else {
            found.insert(name, std::fs::read(&path).unwrap());
        }
    }
    found
}

/// A point with the digits that records have: nine decimals of errors, and of true positions, to which they are added; six of standard deviations.
fn written(point: &PointResult) -> String {
    let outcome = match point.outcome {
        Outcome::Measured { position, error: Some((x, y)) } => {
            format!("{:.9} {:.9} {x:.9} {y:.9}", position.x - x, position.y - y)
        }
        Outcome::Measured { position, error: None } => format!("{:.9} {:.9}", position.x, position.y),
        Outcome::Rejected(why) => why.name().to_owned(),
    };
    let [bound, predicted] = [point.bound, point.predicted].map(|sigma| sigma.map(|sigma| format!("{sigma:.5e}")));
    format!("{} {} {} {outcome} {bound:?} {predicted:?}", point.view, point.target, point.method).replace("-0.000000000", "0.000000000")
}

#[test]
fn what_is_stored_is_what_the_run_gave() {
    let (scenario, parent) = (scenario(&[]), tempfile::tempdir().unwrap());
    assert_eq!(stored(parent.path(), &scenario).unwrap(), 2 * 4 * 12, "two methods, four views, twelve targets");
    let folder = parent.path().join(NAME);
    assert_eq!(files(&folder)["scenario.toml"], SCENARIO.as_bytes());
    let mut again = Vec::new();
    let head = read_points(&folder, NAME, |trial, _| again.push(trial.points)).unwrap();
    assert_eq!((head.run.scenario.as_str(), head.run.seed, head.run.revision.as_str()), (NAME, 3, "r1"));
    assert_eq!(head.methods.iter().map(|method| &*method.label).collect::<Vec<_>>(), ["pixel", "forstner:window=9"]);
    let run = trials(&scenario, 3);
    assert_eq!(again.len(), 1, "of later trials the adjustments alone are kept");
    assert_eq!(again[0].iter().map(written).collect::<Vec<_>>(), run[0].points.iter().map(written).collect::<Vec<_>>());
    let mut rows = Vec::new();
    read_adjustments(&folder, NAME, |row| rows.push(row)).unwrap();
    for (number, trial) in run.iter().enumerate() {
        for calibrated in &trial.calibrations {
            let (method, set) = (["pixel", "forstner:window=9"][calibrated.method], ["c,x0,y0", "c"][calibrated.set]);
            for figure in calibrated.outcome.as_ref().unwrap() {
                let mut found = rows.iter().filter(|row| (row.trial, &*row.method, &*row.set) == (number as u64, method, set));
                let numbers =
                    found.find_map(|row| row.figure.as_ref().ok().filter(|(name, _)| *name == figure.name).map(|(_, numbers)| numbers));
                let numbers = numbers.unwrap_or_else(|| panic!("no row of {}", figure.name));
                // Nine significant digits of values, six of the others.
                let near = |read: f64, given: f64, digits: i32| (read - given).abs() <= 5.001 * 10_f64.powi(-digits) * given.abs();
                assert!(near(numbers.value, figure.value, 9), "{}: {numbers:?} {figure:?}", figure.name);
                for (read, given) in [(numbers.sigma, figure.sigma), (numbers.error, figure.error)] {
                    assert_eq!(read.is_some(), given.is_some());
                    assert!(read.zip(given).is_none_or(|(read, given)| near(read, given, 6)), "{}: {numbers:?} {figure:?}", figure.name);
                }
            }
        }
    }
    assert!(rows.iter().any(|row| row.group == Group::Check));
}

#[test]
fn a_second_run_replaces_the_first_and_one_that_fails_leaves_it() {
    let parent = tempfile::tempdir().unwrap();
    stored(parent.path(), &scenario(&[])).unwrap();
    let before = files(parent.path());
    stored(parent.path(), &scenario(&[])).unwrap();
    assert!(files(parent.path()) == before, "the same seed gives the same bytes");
    // A camera file that has gone since the scenario was read.
    let mut broken = scenario(&[("seed = 3", "seed = 4")]);
    let calibench_scenario::Subject::Views(views) = &mut broken.subject else { panic!("views") };
    views.camera_file = Some(parent.path().join("gone.toml"));
    assert!(stored(parent.path(), &broken).is_err());
    assert!(files(parent.path()) == before, "nothing of a failed run is left");
    stored(parent.path(), &scenario(&[("seed = 3", "seed = 4")])).unwrap();
    let after = files(parent.path());
    assert!(after.keys().eq(before.keys()) && after != before);
}

#[test]
fn a_sweep_s_cells_have_a_folder_each_and_share_their_noise() {
    let text =
        format!("{SCENARIO}\n[sweep]\n\"calibration.floor_px\" = [0.0, 0.2]\n").replace("control_sigma", "floor_px = 0.0\ncontrol_sigma");
    let scenario =
        calibench_scenario::parse(NAME, "wall.toml", &text, &Registry::builtin()).unwrap_or_else(|problems| panic!("{problems}"));
    let registry = Registry::builtin();
    let order = Order {
        scenario: &scenario,
        methods: &[],
        seed: None,
        trials: None,
        tools: crate::Tools::default(),
        data: PathBuf::new(),
        reuse: None,
        registry: &registry,
        stop: None,
    };
    let plan = SweepPlan { order: &order, sweep: scenario.sweep.as_ref().unwrap() };
    let parent = tempfile::tempdir().unwrap();
    let steps = std::sync::atomic::AtomicU64::new(0);
    let count = || {
        steps.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
    };
    run_sweep(&RecordsFolder::open(parent.path(), NAME, None).unwrap(), &plan, "r1", &count).unwrap();
    assert_eq!(steps.into_inner(), 2);
    let folder = parent.path().join(NAME);
    let stored = files(&folder);
    assert_eq!(stored["scenario.toml"], text.as_bytes());
    let points = |index: usize| {
        let mut found = Vec::new();
        let name = cell_run(NAME, &plan.sweep.label(index));
        read_points(&cell_folder(&folder, index), &name, |trial, _| found.push(trial.points)).unwrap();
        found
    };
    let (a, b) = (points(0), points(1));
    let other = read_points(&cell_folder(&folder, 1), &cell_run(NAME, &plan.sweep.label(0)), |_, _| ()).unwrap_err().to_string();
    assert!(other.contains("expected those of `small/wall@"), "{other}");
    assert_eq!(a, b, "the floor concerns the adjustment, the points are the same");
    assert_ne!(stored["cell-0001/calibrations.csv.gz"], stored["cell-0002/calibrations.csv.gz"]);
}

fn is_image(name: &str) -> bool {
    Path::new(name).extension().is_some_and(|extension| extension == "png")
}

/// Records that a run with a store writes, whatever of it is there, are those of one without, images and all; and a second run leaves them.
#[test]
fn records_are_the_same_with_a_store_and_left_where_they_are_right() {
    let scenario = super::views::coded();
    let place = |parent: &Path| RecordsFolder::open(parent, NAME, None).unwrap();
    let plain = tempfile::tempdir().unwrap();
    run(&place(plain.path()), &Plan::new(&scenario, crate::Tools::default(), PathBuf::new()), "r1", &|| ()).unwrap();
    let expected = files(plain.path());
    assert!(expected.keys().filter(|name| is_image(name)).count() > 1, "{:?}", expected.keys());
    let (kept, parent) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let again = |asked: Option<&[usize]>| {
        let (store, tally) = (calibench_store::Store::open(kept.path(), 1 << 30, false), crate::reuse::Tally::default());
        let reuse = Some(crate::reuse::Reuse { store: &store, program: "p", tally: &tally });
        let plan = Plan { asked, reuse, ..Plan::new(&scenario, crate::Tools::default(), PathBuf::new()) };
        if asked.is_some() {
            // For its entries alone.
            crate::reuse::run(&plan, &|| (), &mut |_| Ok(())).unwrap();
        } else {
            run(&place(parent.path()), &plan, "r1", &|| ()).unwrap();
            assert!(files(parent.path()) == expected);
        }
        [tally.found(), tally.computed(), tally.unchanged()]
    };
    assert_eq!(again(Some(&[1])), [0, 1, 0]);
    assert_eq!(again(None), [1, 1, 0], "one method, and the images");
    assert_eq!(again(None), [0, 0, 1], "nothing at all");
    // Another's hand in them: written anew, from what is there.
    let image =
        parent.path().join(NAME).join(expected.keys().find(|name| is_image(name)).map(|name| name.rsplit('/').next().unwrap()).unwrap());
    std::fs::remove_file(&image).unwrap();
    assert_eq!(again(None), [2, 0, 0]);
    assert!(image.is_file());
}
