//! `calibrate --model splined:...`: mrcal's splines from zero control points, of an example with a dent that no formula has and of a board that others adjusted.

use std::collections::BTreeSet;
use std::path::Path;

use calibench_cameras::read_camera;
use calibench_model::PixelPoint;
use calibench_model::camera::{CameraModel, Ray, Splined};
use nalgebra::{DMatrix, DVector};
use serde_json::Value;

use crate::project::{self, data, number, run, stderr, stdout, table};

const POINTS: [&str; 5] = ["calibrate", "--points", "points.csv", "--control", "control.csv"];
const EXAMPLE: [&str; 5] = ["--size", "1280x960", "--model", "splined:16x13:132:3", "--json"];

fn example() -> tempfile::TempDir {
    project::example("splined", &["points.csv", "control.csv"])
}

fn answer(folder: &Path, more: &[&str]) -> (Option<i32>, Value) {
    let output = run(folder, &[&POINTS[..], more].concat());
    let found = serde_json::from_str(&stdout(&output)).unwrap_or_else(|error| panic!("{error}: {}", stderr(&output)));
    (output.status.code(), found)
}

/// The lens of the example, as its README has it: of x right, y down, z forward.
fn lens([x, y, z]: [f64; 3]) -> [f64; 2] {
    let (r, f) = (x.hypot(y), 620.0);
    let angle = r.atan2(z);
    let u = angle * (1.0 - 0.03 * angle.powi(2) + 0.006 * angle.powi(4)) / r.max(1e-12);
    let [px, py] = [f * u * x + 645.0, 1.002 * f * u * y + 474.0];
    let dent = 3.0 * (-((px - 880.0).powi(2) + (py - 330.0).powi(2)) / 260.0_f64.powi(2)).exp();
    [px + dent, py - 0.7 * dent]
}

/// How far the splines, turned, are from the lens at places of the frame, px.
fn turned(camera: &Splined, places: &[[f64; 2]], w: &DVector<f64>) -> DVector<f64> {
    let turn = nalgebra::Rotation3::new(nalgebra::Vector3::new(w[0], w[1], w[2]));
    let off = places.iter().flat_map(|[x, y]| {
        let ray: Ray = camera.unproject(PixelPoint::new(*x, *y)).unwrap();
        let [seen_x, seen_y] = lens((turn * nalgebra::Vector3::new(ray.x, -ray.y, -ray.z)).into());
        [seen_x - x, seen_y - y]
    });
    DVector::from_iterator(2 * places.len(), off)
}

/// How far the splines are from the lens at places of the frame, after the rotation that makes up for most at the image points, px.
fn errors(camera: &Splined, points: &[[f64; 2]], places: &[[f64; 2]]) -> Vec<f64> {
    let mut w = DVector::zeros(3);
    for _ in 0..5 {
        let now = turned(camera, points, &w);
        let moved = |k: usize| &w + DVector::from_fn(3, |i, _| if i == k { 1e-6 } else { 0.0 });
        let column = |k: usize| (turned(camera, points, &moved(k)) - &now) / 1e-6;
        let a = DMatrix::from_columns(&[column(0), column(1), column(2)]);
        w -= a.svd(true, true).solve(&now, 1e-12).unwrap();
    }
    turned(camera, places, &w).as_slice().chunks(2).map(|off| off[0].hypot(off[1])).collect()
}

fn image_points(folder: &Path) -> Vec<[f64; 2]> {
    let text = std::fs::read_to_string(folder.join("points.csv")).unwrap();
    let at = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        [2, 3].map(|k| cells[k].parse::<f64>().unwrap())
    };
    text.lines().skip(1).map(at).collect()
}

#[test]
fn a_dent_is_found_from_zero_control_points() {
    let folder = example();
    let (code, found) = answer(folder.path(), &[&EXAMPLE[..], &["-o", "camera.cameramodel", "--report", "page"]].concat());
    assert_eq!((code, &found["command"]), (Some(0), &Value::from("calibrate-splined")), "{}", found["doubts"]);
    // Errors are 0.1 px a coordinate.
    let rms = number(&found["rms_px"]);
    assert!((0.125..0.142).contains(&rms), "{rms}");
    let (points, unknowns) = (number(&found["image_points"]), number(&found["unknowns"]));
    assert_eq!((points, unknowns), (2844.0, 2.0 * 16.0 * 13.0 + 6.0 * 43.0 + 3.0));
    // The prior determines a few of the unknowns; errors are 0.1 px as stated.
    let redundancy = number(&found["redundancy"]) - (2.0 * points - unknowns);
    assert!(redundancy > 0.0 && redundancy < 100.0, "{redundancy}");
    assert!((0.98..1.02).contains(&number(&found["sigma0"])), "{}", found["sigma0"]);
    let camera = read_camera(&folder.path().join("camera.cameramodel")).unwrap().cameras.remove(0).splines.unwrap().model;
    let stated: Vec<f64> = found["camera"]["core"].as_array().unwrap().iter().map(number).collect();
    assert_eq!(camera.core.to_vec(), stated);
    let held = found["uncertainty"].as_array().unwrap().iter().filter(|place| place["held"] == true);
    let places: Vec<[f64; 2]> = held.clone().map(|place| [number(&place["x"]), number(&place["y"])]).collect();
    let sigma = |place: &Value| (number(&place["covariance"][0]) + number(&place["covariance"][2])).sqrt();
    let sigmas: Vec<f64> = held.map(sigma).collect();
    let errors = errors(&camera, &image_points(folder.path()), &places);
    let mean = |values: &mut dyn Iterator<Item = f64>| (values.map(|value| value * value).sum::<f64>() / places.len() as f64).sqrt();
    let known = number(&found["over_held_px"]);
    assert!(places.len() > 500 && known < 0.3, "{known} {}", places.len());
    // In units of their standard deviations errors are neither small nor large.
    let scaled = mean(&mut errors.iter().zip(&sigmas).map(|(error, sigma)| error / sigma));
    assert!((0.8..1.25).contains(&scaled), "{scaled}");
    for file in ["README.md", "report.html", "uncertainty-far.png", "uncertainty.csv", "control-points.csv", "residuals.csv"] {
        assert!(folder.path().join("page").join(file).is_file(), "{file}");
    }
}

/// A core that is solved for is another name for nearly the same lens, at a lower cost: the prior pulls less.
#[test]
fn the_core_is_solved_for() {
    let folder = example();
    let (_, held) = answer(folder.path(), &[&EXAMPLE[..], &["-o", "held.cameramodel"]].concat());
    let (code, free) = answer(folder.path(), &[&EXAMPLE[..], &["--solve", "fx,fy,cx,cy", "-o", "free.cameramodel"]].concat());
    assert_eq!((code, number(&free["unknowns"]) - number(&held["unknowns"])), (Some(0), 4.0), "{}", free["doubts"]);
    let total = |found: &Value| number(&found["cost"]) + number(&found["cost_of_prior"]);
    assert!(
        total(&free) < total(&held) && number(&free["cost_of_prior"]) < number(&held["cost_of_prior"]),
        "{} {}",
        total(&free),
        total(&held)
    );
    let sigmas = |found: &Value| found["camera"]["core_sigmas"].as_array().unwrap().clone();
    assert!(sigmas(&held).iter().all(Value::is_null), "{:?}", sigmas(&held));
    let places: Vec<[f64; 2]> = free["uncertainty"]
        .as_array()
        .unwrap()
        .iter()
        .filter(|place| place["held"] == true)
        .map(|place| [number(&place["x"]), number(&place["y"])])
        .collect();
    let rms = |name: &str| {
        let camera = read_camera(&folder.path().join(name)).unwrap().cameras.remove(0).splines.unwrap().model;
        let errors = errors(&camera, &image_points(folder.path()), &places);
        (camera.core, (errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64).sqrt())
    };
    let ((core_held, error_held), (core_free, error_free)) = (rms("held.cameramodel"), rms("free.cameramodel"));
    assert!((error_free / error_held - 1.0).abs() < 0.1, "{error_free} {error_held}");
    // The prior alone tells the core from control points, and not well.
    for (i, sigma) in sigmas(&free).iter().enumerate() {
        let (sigma, moved) = (number(sigma), core_free[i] - core_held[i]);
        assert!(sigma > 0.5 && moved != 0.0, "{i}: {sigma} {moved}");
    }
}

/// Points go to a plane and back by the splines themselves.
#[test]
fn points_are_undistorted_by_splines() {
    let folder = example();
    answer(folder.path(), &[&EXAMPLE[..], &["-o", "camera.cameramodel"]].concat());
    let points = |name: &str| -> Vec<[f64; 2]> {
        let table = csv::Reader::from_path(folder.path().join(name)).unwrap().into_records().map(Result::unwrap).collect::<Vec<_>>();
        table.iter().map(|row| [2, 3].map(|k| row[k].parse::<f64>().unwrap())).collect()
    };
    for words in [&["points.csv", "-o", "flat.csv"][..], &["flat.csv", "--redistort", "-o", "back.csv"]] {
        let output = run(folder.path(), &[&["undistort"], words, &["--camera", "camera.cameramodel", "--frame", "keep"]].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    }
    let camera = read_camera(&folder.path().join("camera.cameramodel")).unwrap().cameras.remove(0).splines.unwrap().model;
    let (given, flat, back) = (points("points.csv"), points("flat.csv"), points("back.csv"));
    assert_eq!((given.len(), given.len()), (flat.len(), back.len()));
    for (given, back) in given.iter().zip(&back) {
        assert!((given[0] - back[0]).hypot(given[1] - back[1]) < 1e-5, "{given:?} {back:?}");
    }
    // In a plane differences are those of tangents.
    let tangent = |at: &[f64; 2]| {
        let ray = camera.unproject(PixelPoint::new(at[0], at[1])).unwrap();
        -ray.x / ray.z
    };
    let scale = |i: usize, j: usize| (flat[i][0] - flat[j][0]) / (tangent(&given[i]) - tangent(&given[j]));
    assert!((scale(0, 60) / scale(1200, 2000) - 1.0).abs() < 1e-6, "{} {}", scale(0, 60), scale(1200, 2000));
}

#[test]
fn gross_errors_are_left_out_by_name() {
    let folder = example();
    let text = std::fs::read_to_string(folder.path().join("points.csv")).unwrap();
    let spoiled: Vec<String> = text
        .lines()
        .enumerate()
        .map(|(k, line)| {
            let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
            if k == 700 || k == 1500 {
                cells[2] = (cells[2].parse::<f64>().unwrap() + 4.0).to_string();
            }
            cells.join(",")
        })
        .collect();
    std::fs::write(folder.path().join("points.csv"), spoiled.join("\n")).unwrap();
    let (code, found) = answer(folder.path(), &EXAMPLE);
    assert_eq!((code, found["rejected"].as_array().unwrap().len()), (Some(0), 2), "{}", found["rejected"]);
    let (code, kept) = answer(folder.path(), &[&EXAMPLE[..], &["--plain"]].concat());
    let is_said = kept["doubted"].as_array().unwrap().iter().any(|doubted| doubted["subject"] == "gross-errors");
    assert!(code == Some(3) && is_said, "{}", kept["doubts"]);
    assert!(kept["rejected"].as_array().unwrap().is_empty() && number(&kept["rms_px"]) > number(&found["rms_px"]));
}

/// Each of many that are wrong by 1 to 4 px is left out, those of one image and those at the rim too, and no other.
#[test]
fn many_gross_errors_hide_none_and_spoil_none() {
    let folder = example();
    let text = std::fs::read_to_string(folder.path().join("points.csv")).unwrap();
    let mut wrong = BTreeSet::new();
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    for (number, line) in lines.iter_mut().enumerate().skip(1).filter(|(number, _)| number % 97 < 2) {
        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        let (axis, by) = (2 + number % 2, if number % 3 == 0 { -1.0 } else { 1.0 } * (1.0 + 0.1 * (number % 31) as f64));
        cells[axis] = (cells[axis].parse::<f64>().unwrap() + by).to_string();
        wrong.insert((cells[0].clone(), cells[1].clone()));
        *line = cells.join(",");
    }
    std::fs::write(folder.path().join("points.csv"), lines.join("\n")).unwrap();
    let (code, found) = answer(folder.path(), &EXAMPLE);
    let name = |one: &Value| (one["image"].as_str().unwrap().to_owned(), one["target"].as_str().unwrap().to_owned());
    let rejected: BTreeSet<(String, String)> = found["rejected"].as_array().unwrap().iter().map(name).collect();
    assert!(wrong.len() > 50 && rejected == wrong, "{} {:?}", wrong.len(), rejected.symmetric_difference(&wrong).collect::<Vec<_>>());
    // Two in a hundred are worth a doubt.
    assert_eq!((code, found["doubted"].as_array().unwrap().len()), (Some(3), 1), "{}", found["doubts"]);
}

#[test]
fn what_splines_do_not_go_with_is_said() {
    let folder = example();
    let refused = |more: &[&str]| {
        let output = run(folder.path(), &[&POINTS[..], &["--size", "1280x960"], more].concat());
        assert_eq!(output.status.code(), Some(2), "{more:?}: {}", stdout(&output));
        stderr(&output)
    };
    for (more, why) in [
        (&["--model", "splined:0x0:120:3"][..], "0 x 0 control points"),
        (&["--model", "splined:14x11:120:4"], "order 4"),
        (&["--model", "splined"], "splined:30x20:170:3"),
        (&["--model", "splined:14x11:60:3"], "beyond the grid of splines of 60 degrees"),
        (&["--model", "splined:14x11:120:3", "--huber", "2"], "--huber is not there for splines"),
        (&["--model", "splined:14x11:120:3", "--compare", "fx"], "--compare is not there for splines"),
        (&["--model", "splined:14x11:120:3", "--hold", "k1=3"], "no `k1`"),
        (&["--model", "splined:14x11:120:3", "--hold", "fx=0"], "positive"),
        (&["--model", "splined:14x11:120:3", "--solve", "k1"], "no `k1`"),
        (&["--model", "splined:14x11:120:3", "--solve", "fx", "--hold", "fx=600"], "fx is held"),
        (&["--model", "splined:14x11:120:3", "--board-shape", "free"], "control that is fixed"),
        (&["--hold", "fx=3"], "--hold: holds the core of splines"),
    ] {
        let said = refused(more);
        assert!(said.contains(why) && !said.contains("panicked"), "{more:?}: {said}");
    }
    let named = refused(&["--model", "splined:14x11:60:3"]);
    assert!(
        named.contains(".png and ") && named.contains(" more; expected a horizontal field of view of 1") && named.len() < 600,
        "{named}"
    );
}

/// The board that mrcal 2.2 and 2.5 adjusted: the same sums of squares from zero control points.
#[test]
#[cfg_attr(not(rigs), ignore = "the rigs of CALIBENCH_DATA are not there")]
fn a_board_of_186_images_is_adjusted_as_mrcal_does() {
    let folder = tempfile::tempdir().unwrap();
    let from = data().join("rigs/splined-figueroa");
    std::fs::write(folder.path().join("points.csv"), table(&from.join("points.csv.gz"))).unwrap();
    std::fs::copy(from.join("control.csv"), folder.path().join("control.csv")).unwrap();
    let reference: Value = serde_json::from_str(&std::fs::read_to_string(from.join("reference.json")).unwrap()).unwrap();
    let of = |what: &str| reference["splined_30x20_170_order3"][what].clone();
    let core: Vec<f64> = of("core_held")["core"].as_array().unwrap().iter().map(number).collect();
    let hold = format!("fx={},fy={},cx={},cy={}", core[0], core[1], core[2], core[3]);
    let model = [
        "--size",
        "6016x4016",
        "--model",
        "splined:30x20:170:3",
        "--sigma",
        "1",
        "--covariances",
        "--plain",
        "--board-shape",
        "bent-axes",
        "--json",
    ];
    let (_, found) = answer(folder.path(), &[&model[..], &["--hold", &hold]].concat());
    let near = |what: &str, expected: &Value, by: f64| {
        let (own, other) = (number(&found[what]), number(expected));
        assert!((own - other).abs() < by, "{what}: {own} {other}");
    };
    near("cost", &of("core_held")["cost_boards"], 2e-3);
    near("cost_of_prior", &of("core_held")["cost_regularisation"], 2e-3);
    near("unknowns", &of("core_held")["states"], 0.5);
    // mrcal's own map, px along the worst direction.
    for (at, expected) in [([3008.0, 2008.0], 0.056), ([5500.0, 3500.0], 0.191)] {
        let off = |place: &&Value| (number(&place["x"]) - at[0]).hypot(number(&place["y"]) - at[1]);
        let place = found["uncertainty"].as_array().unwrap().iter().min_by(|a, b| off(a).total_cmp(&off(b))).unwrap();
        let [xx, xy, yy] = [0, 1, 2].map(|k| number(&place["covariance"][k]));
        let worst = (0.5 * (xx + yy) + (0.5 * (xx - yy)).hypot(xy)).sqrt();
        assert!((worst / expected - 1.0).abs() < 0.15, "{at:?}: {worst} {expected}");
    }
    // A part of the frame has no image points: what is known there is the prior.
    assert!(number(&found["share_unheld"]) > 0.0);
    // With the core free mrcal stops before its minimum is reached.
    let (_, free) = answer(folder.path(), &[&model[..], &["--solve", "fx,fy,cx,cy"]].concat());
    let core_free = of("core_free");
    let (own, other) = (
        number(&free["cost"]) + number(&free["cost_of_prior"]),
        number(&core_free["cost_boards"]) + number(&core_free["cost_regularisation"]),
    );
    assert!(own < other && own > other - 0.25, "{own} {other}");
    assert_eq!(number(&free["unknowns"]), number(&core_free["states"]));
}
