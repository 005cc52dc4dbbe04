//! `calibrate --reconstruction`: what other tools adjusted, adjusted anew.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

use crate::project::{data, number, root, run, stderr, stdout};

fn example() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("sparse")).unwrap();
    for name in ["cameras.txt", "images.txt", "points3D.txt"] {
        std::fs::copy(root().join("examples/reconstruction").join(name), folder.path().join("sparse").join(name)).unwrap();
    }
    folder
}

fn answer(folder: &Path, arguments: &[&str]) -> (Option<i32>, Value, String) {
    let output = run(folder, &[&["calibrate", "--json", "--reconstruction"], arguments].concat());
    let found = serde_json::from_str(&stdout(&output)).unwrap_or_else(|error| panic!("{error}: {}", stderr(&output)));
    (output.status.code(), found, stderr(&output))
}

fn cost(found: &Value) -> f64 {
    number(&found["sigma0"]).powi(2) * number(&found["counts"]["redundancy"])
}

/// Value and standard deviation of a parameter of a camera that is solved for.
fn solved(found: &Value, camera: usize, name: &str) -> [f64; 2] {
    let camera = &found["cameras"][camera];
    let of = |list: &Value, key: &str, value: &str| {
        let entry = list.as_array().unwrap().iter().find(|entry| entry[key] == name).unwrap_or_else(|| panic!("{name}: {list}"));
        number(&entry[value])
    };
    [of(&camera["camera"]["parameters"], "name", "value"), of(&camera["solved"], "parameter", "sigma")]
}

#[test]
fn the_camera_of_a_coarse_model_is_found_and_the_wrong_point_left_out() {
    let folder = example();
    let (code, found, said) = answer(folder.path(), &["sparse", "--sigma", "0.4", "--adjusted", "better"]);
    assert_eq!(code, Some(0), "{}", found["doubts"]);
    assert!(said.contains("COLMAP: 1 cameras, 14 images, 60 points, 748 image points"), "{said}");
    for (name, truth) in [("f", 1250.0), ("k1", -0.085), ("k2", 0.03)] {
        let [value, sigma] = solved(&found, 0, name);
        assert!((value - truth).abs() < 3.5 * sigma, "{name}: {value} +- {sigma}");
    }
    assert_eq!(found["cameras"][0]["solved"].as_array().unwrap().len(), 3);
    let rejected = found["rejected"].as_array().unwrap();
    assert!(rejected.len() == 1 && rejected[0]["image"] == "photo04.jpg" && rejected[0]["target"] == "46", "{rejected:?}");
    assert!((0.9..1.1).contains(&number(&found["sigma0"])), "{}", found["sigma0"]);
    // What was written is where it comes to rest.
    let (code, again, _) = answer(folder.path(), &["better", "--sigma", "0.4"]);
    assert_eq!((code, again["rejected"].as_array().unwrap().len()), (Some(0), 0));
    assert!((cost(&again) / cost(&found) - 1.0).abs() < 1e-9);
    assert!((solved(&again, 0, "f")[0] - solved(&found, 0, "f")[0]).abs() < 1e-6);
}

#[test]
fn what_is_solved_for_is_what_was_asked() {
    let folder = example();
    let unknowns = |more: &[&str]| {
        let (_, found, _) = answer(folder.path(), &[&["sparse", "--sigma", "0.4", "--plain"], more].concat());
        (number(&found["counts"]["unknowns"]) as i64, found)
    };
    let (own, _) = unknowns(&[]);
    // Fourteen poses, sixty points, f, k1, k2.
    assert_eq!(own, 14 * 6 + 60 * 3 + 3);
    assert_eq!(unknowns(&["--solve", "none"]).0, own - 3);
    let (more, found) = unknowns(&["--solve", "f,cx,cy,k1,k2"]);
    assert_eq!(more, own + 2);
    let [value, sigma] = solved(&found, 0, "cx");
    assert!(value.abs() < 6.0 * sigma && sigma < 3.0, "{value} +- {sigma}");
    std::fs::write(folder.path().join("d.csv"), "target_a,target_b,distance,sigma\n1,2,2500,0.5\n").unwrap();
    let (_, scaled, _) = answer(folder.path(), &["sparse", "--sigma", "0.4", "--distances", "d.csv", "--length", "1,2"]);
    assert!(
        (number(&scaled["lengths"][0]["length"]) - 2500.0).abs() < 0.01 && scaled["counts"]["constraints"] == 6,
        "{}",
        scaled["lengths"]
    );
}

#[test]
fn mistakes_are_said() {
    let folder = example();
    let refused = |arguments: &[&str]| {
        let output = run(folder.path(), &[&["calibrate", "--reconstruction"], arguments].concat());
        assert_eq!(output.status.code(), Some(2), "{}", stdout(&output));
        stderr(&output)
    };
    let error = refused(&["sparse", "--solve", "f,kk1"]);
    assert!(error.contains("camera 1 has no parameter `kk1`"), "{error}");
    let error = refused(&["nowhere"]);
    assert!(error.contains("nowhere"), "{error}");
    let error = refused(&["sparse", "--points", "p.csv"]);
    assert!(error.contains("--points"), "{error}");
    let error = refused(&["sparse", "--adjusted", "sparse"]);
    assert!(error.contains("--adjusted"), "{error}");
    let images = folder.path().join("sparse/images.txt");
    let text = std::fs::read_to_string(&images).unwrap();
    let line = text.lines().nth(4).unwrap();
    let first: Vec<&str> = line.split(' ').take(3).collect();
    std::fs::write(&images, text.replacen(line, &format!("{line} {}", first.join(" ")), 1)).unwrap();
    let error = refused(&["sparse"]);
    assert!(error.contains(&format!("image photo01.jpg shows point {} twice", first[2])), "{error}");
}

fn rigs() -> PathBuf {
    data().join("rigs")
}

fn reference(folder: &Path) -> Value {
    serde_json::from_str(&std::fs::read_to_string(folder.join("reference.json")).unwrap()).unwrap()
}

/// Ladybug's 49 images, as an independent program adjusted them, points behind cameras counted.
#[test]
#[cfg_attr(not(rigs), ignore = "the networks in `rigs` are absent: docs/scenarios.md says where they are looked for")]
fn a_problem_of_bundle_adjustment_in_the_large_ends_where_another_program_ends() {
    let data = rigs().join("bal-ladybug49");
    let packed =
        std::fs::read_dir(&data).unwrap().map(|entry| entry.unwrap().path()).find(|path| path.extension().is_some_and(|e| e == "bz2"));
    let plain = Command::new("bzip2").arg("-dc").arg(packed.unwrap()).output().unwrap().stdout;
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("problem.txt"), plain).unwrap();
    let (code, found, _) = answer(folder.path(), &["problem.txt", "--sigma", "1", "--plain"]);
    let reference = reference(&data);
    let half = 0.5 * cost(&found);
    assert!(half <= number(&reference["half_cost"]) * (1.0 + 1e-9), "{half}");
    // Of the same image points in NumPy: points eliminated, derivatives by complex steps.
    assert_eq!(number(&found["counts"]["image_points"]) as i64, 31_603);
    assert!((half / 10_073.250_356_53 - 1.0).abs() < 1e-9, "{half}");
    assert_eq!(code, Some(3));
    let doubts = found["doubts"].to_string();
    assert!(
        doubts.contains(&format!("{} image points are of points behind their cameras", reference["behind_camera_at_start"])),
        "{doubts}"
    );
    // Some points run off to where their rays would be parallel: they have no place, and take no part.
    let taken = number(&found["counts"]["image_points"]);
    assert!((0.99..1.0).contains(&(taken / number(&reference["observations"]))), "{taken}");
    assert!(found["warnings"].to_string().contains("since their rays are as good as parallel"), "{}", found["warnings"]);
}

/// A sheet of a hundred targets, four of them known: y is divided by the scale at which the reference has its minimum, which no parameter of ours is.
#[test]
#[cfg_attr(not(rigs), ignore = "the networks in `rigs` are absent: docs/scenarios.md says where they are looked for")]
fn a_sheet_with_four_known_targets_is_as_another_program_adjusts_it() {
    const SCALE: f64 = 1.000_389_429_267_344;
    let data = rigs().join("dbat-camcal");
    let folder = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(data.join("points.csv")).unwrap();
    let line = |line: &str| {
        let (rest, y) = line.rsplit_once(',').unwrap();
        format!("{rest},{},0.01,0,{}\n", y.parse::<f64>().unwrap() / SCALE, 0.01 / SCALE / SCALE)
    };
    let rows: String = text.lines().skip(1).filter(|line| !line.is_empty()).map(line).collect();
    std::fs::write(folder.path().join("points.csv"), format!("image,target,x,y,sxx,sxy,syy\n{rows}")).unwrap();
    let control = data.join("control.csv");
    let arguments =
        ["calibrate", "--json", "--points", "points.csv", "--control", control.to_str().unwrap(), "--size", "2272x1720", "--covariances"];
    let more = ["--sigma", "0.1", "--plain", "--model", "photogrammetric", "--pitch", "3.2", "--solve", "c,x0,y0,k1,k2,k3,p1,p2"];
    let found: Value = serde_json::from_str(&stdout(&run(folder.path(), &[&arguments[..], &more].concat()))).unwrap();
    let reference = reference(&data);
    assert!((cost(&found) - number(&reference["cost"])).abs() < 1e-4, "{}", cost(&found));
    let [c, _] = solved(&found, 0, "c");
    assert!((c / 0.0032 - number(&reference["fx_px"][0])).abs() < 1e-4, "{c}");
}
