//! A field on a stand that bends it, before a camera with local distortion.

use std::collections::BTreeMap;

use calibench_model::camera::CameraModel;
use calibench_random::Key;
use calibench_records::results::Outcome;
use calibench_scenario::Scenario;
use calibench_synth::local::LocalDistortion;

use super::truth::{fill, number, rows};
use super::{KEY, SCENARIO, scenario, trials, views};
use crate::prepared::Prepared;
use crate::truth;

const STAND: &str = "[stations]\nkind = \"stand\"\nphis = [0, 30]\nturns = [0, 90]\nrolls = [0, 90]\ndistance = 5\n";
const BEND: &str = "bend = 0.02\nbend_reach = 0.5\n";
const LOCAL: &str = "c = 10.0\n[camera.local]\nsigma = 0.5\ncorrelation = 40\n";

/// The wall on a stand, whose keys are followed by `more`, its corners drawn from the truth by a steady hand.
pub(super) fn on_stand(more: &str, changes: &[(&str, &str)]) -> Scenario {
    let (first, listed) = (SCENARIO.find("[[station]]").unwrap(), SCENARIO.find("[pointing]").unwrap());
    let (calibration, methods) = (SCENARIO.find("[calibration]").unwrap(), SCENARIO.find("[[method]]").unwrap());
    let stand = format!("{STAND}{more}");
    let changes = [
        &[
            (&SCENARIO[first..listed], &*stand),
            (&SCENARIO[calibration..methods], ""),
            (&SCENARIO[methods..], "[[method]]\nname = \"pixel\"\n"),
        ],
        changes,
    ];
    scenario(&changes.concat())
}

/// The table of every view.
fn tables(scenario: &Scenario) -> BTreeMap<String, Vec<std::collections::HashMap<String, String>>> {
    let subject = views(scenario);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("truth");
    let prepared = Prepared::new(subject, KEY).unwrap();
    let name = |station: &str| format!("{station}.csv");
    fill(&path, |folder| prepared.views.iter().try_for_each(|view| truth::write_view(folder, &view.station.name, subject, view)));
    prepared.views.iter().map(|view| (view.station.name.clone(), rows(&path.join(name(&view.station.name))))).collect()
}

/// Every image has the heights of its own bend and the ellipses of discs on it; X and Y are the field's.
#[test]
fn every_view_has_its_own_truth() {
    let discs = ("kinds = [\"corner\"]", "kinds = [\"disc\"]");
    let (bent, flat) = (tables(&on_stand(BEND, &[discs])), tables(&on_stand("", &[discs])));
    assert_eq!(bent.keys().collect::<Vec<_>>(), ["1111", "1112", "1211", "1212", "1221", "1222"]);
    for (name, rows) in &bent {
        let turned = name.as_bytes()[2] == b'2';
        for (row, flat) in rows.iter().zip(&flat[name]) {
            let [x, y, z] = ["X", "Y", "Z"].map(|column| number(row, column));
            let across = if turned { y } else { x };
            assert!((z - 0.02 * (1.0 - (across / 0.5).powi(2))).abs() < 1e-12, "{name}: {row:?}");
            assert_eq!((&row["X"], &row["Y"], number(flat, "Z")), (&flat["X"], &flat["Y"], 0.0));
            // The ellipse is there, near the image of the centre, and of about the target's size.
            let off = (number(row, "ellipse_x") - number(row, "x")).hypot(number(row, "ellipse_y") - number(row, "y"));
            let size = number(row, "semi_major") * number(row, "semi_minor") / (number(row, "size_px") / 2.0).powi(2);
            assert!(off < 0.05 && (size - 1.0).abs() < 0.01, "{name}: {off} {size} {row:?}");
        }
        let moved = rows.iter().zip(&flat[name]).map(|(a, b)| (number(a, "x") - number(b, "x")).hypot(number(a, "y") - number(b, "y")));
        assert!(moved.fold(0.0, f64::max) > 0.3, "{name}: the bend moves pictures");
    }
}

/// Positions as the steady hand points at them: those of the truth.
fn positions(scenario: &Scenario, trial: usize) -> BTreeMap<(String, String), [f64; 2]> {
    let steady = trials(scenario, 3).swap_remove(trial);
    let position = |point: calibench_records::results::PointResult| {
        let Outcome::Measured { position, .. } = point.outcome else { panic!("{point:?}") };
        ((point.view.to_string(), point.target.to_string()), [position.x, position.y])
    };
    steady.points.into_iter().map(position).collect()
}

fn drawn(scenario: &Scenario, trial: u64) -> LocalDistortion {
    views(scenario).local_of(Key { trial, ..KEY }).unwrap().unwrap()
}

/// One field in all images of a trial, another in the next; with `each_trial = false` the first in all.
#[test]
fn local_distortion_is_the_cameras_and_new_in_each_trial() {
    let noise = ("sigma = 0.4", "sigma = 0.0");
    let with = |keys: &str| on_stand(BEND, &[("c = 10.0\n", &format!("{LOCAL}{keys}")), noise]);
    let plain = positions(&on_stand(BEND, &[noise, ("trials = 2", "trials = 1")]), 0);
    let each = with("");
    for trial in 0..2 {
        let local = drawn(&each, trial as u64);
        let found = positions(&each, trial);
        assert_eq!(found.len(), plain.len());
        for (key, [x, y]) in &found {
            let [px, py] = plain[key];
            let expected = local.displaced(calibench_model::PixelPoint::new(px, py));
            assert!((x - expected.x).abs() < 1e-9 && (y - expected.y).abs() < 1e-9, "{key:?} {x} {y} {expected:?}");
        }
    }
    assert_ne!(drawn(&each, 0), drawn(&each, 1));
    let held = on_stand(BEND, &[("c = 10.0\n", &format!("{LOCAL}each_trial = false\n"))]);
    assert_eq!(drawn(&held, 0), drawn(&held, 7));
    assert_eq!(drawn(&held, 0), drawn(&each, 0));
    assert!(views(&each).changes() && !views(&held).changes());
}

/// What is told of the field beside the camera's file, corner to corner of the frame.
#[test]
fn the_local_distortion_is_told_on_a_grid() {
    let scenario = on_stand("", &[("c = 10.0\n", LOCAL)]);
    let (local, size) = (drawn(&scenario, 0), views(&scenario).camera.size());
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("truth");
    fill(&path, |folder| truth::write_local(folder, "local.csv", &local, size));
    let rows = rows(&path.join("local.csv"));
    // Steps of 10 px at most: 100 along 1000 px, 81 along 801 px.
    assert_eq!(rows.len(), 101 * 82);
    for row in &rows {
        let [x, y, dx, dy] = ["x", "y", "dx", "dy"].map(|column| number(row, column));
        let expected = local.at(calibench_model::PixelPoint::new(x, y)).by;
        assert_eq!([dx, dy], expected);
    }
    let ends = |column: &str| (number(&rows[0], column), number(rows.last().unwrap(), column));
    assert_eq!((ends("x"), ends("y")), ((-0.5, 999.5), (-0.5, 800.5)));
    let rms = (rows.iter().map(|row| number(row, "dx").powi(2)).sum::<f64>() / rows.len() as f64).sqrt();
    assert!((rms - 0.5).abs() < 0.1, "{rms}");
}
