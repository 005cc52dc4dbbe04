//! `calibrate --per-image`: a lens that focuses anew for each photograph, of which all is known.

use std::collections::BTreeMap;
use std::path::Path;

use serde_json::Value;

use crate::project::{self, number, root, run, stderr, stdout};

const POINTS: [&str; 7] = ["calibrate", "--points", "points.csv", "--control", "control.csv", "--size", "1600x1200"];
/// The camera of the example, as its README has it.
const TRUTH: [(&str, f64); 6] = [("fx", 1850.0), ("fy", 1852.0), ("cx", 805.0), ("cy", 596.0), ("k1", -0.12), ("k2", 0.06)];
/// How far what each photograph has for itself scatters, px.
const SCATTER: [(&str, f64); 3] = [("c", 6.0), ("x0", 2.0), ("y0", 2.0)];

/// The rows of a table, by its columns.
fn table(path: &Path) -> Vec<BTreeMap<String, String>> {
    csv::Reader::from_path(path).unwrap().into_deserialize().collect::<Result<_, _>>().unwrap()
}

fn example() -> tempfile::TempDir {
    project::example("per-image", &["points.csv", "control.csv"])
}

fn answer(folder: &Path, more: &[&str]) -> (Option<i32>, Value) {
    let output = run(folder, &[&POINTS[..], more, &["--json"]].concat());
    let found = serde_json::from_str(&stdout(&output)).unwrap_or_else(|error| panic!("{error}: {}", stderr(&output)));
    (output.status.code(), found)
}

fn truth() -> BTreeMap<(String, String), f64> {
    let rows = table(&root().join("examples/per-image/truth.csv"));
    let of = |row: &BTreeMap<String, String>| {
        SCATTER.map(|(name, _)| ((row["image"].clone(), name.to_owned()), row[name].parse::<f64>().unwrap()))
    };
    rows.iter().flat_map(of).collect()
}

/// Mean square of the errors of what each photograph has, in stated standard deviations, by number.
fn squares(found: &Value) -> BTreeMap<String, f64> {
    let (truth, mut sums) = (truth(), BTreeMap::new());
    let numbers = found["per_image"].as_array().unwrap();
    assert_eq!(numbers.len(), truth.len());
    for own in numbers {
        let (image, name) = (own["image"].as_str().unwrap().to_owned(), own["name"].as_str().unwrap().to_owned());
        let z = (number(&own["value"]) - truth[&(image, name.clone())]) / number(&own["sigma"]);
        *sums.entry(name).or_insert(0.0) += z * z / 24.0;
    }
    sums
}

#[test]
fn each_photograph_has_what_it_has_and_the_camera_is_that_of_all() {
    let folder = example();
    for asked in ["c,x0,y0", "c:6,x0:2,y0:2"] {
        let (code, found) = answer(folder.path(), &["--per-image", asked, "--sigma", "0.1"]);
        assert_eq!(code, Some(0), "{asked}: {}", found["doubts"]);
        for (name, truth) in TRUTH {
            let sigma = found["cameras"][0]["solved"].as_array().unwrap().iter().find(|solved| solved["parameter"] == name).unwrap();
            let value =
                found["cameras"][0]["camera"]["parameters"].as_array().unwrap().iter().find(|parameter| parameter["name"] == name).unwrap();
            let z = (number(&value["value"]) - truth) / number(&sigma["sigma"]);
            assert!(z.abs() < 3.5, "{asked}: {name} is {z:.1} standard deviations off");
        }
        for (name, square) in squares(&found) {
            assert!((0.4..2.0).contains(&square), "{asked}: {name} of photographs: mean z^2 {square:.2}");
        }
        let sigma0 = number(&found["sigma0"]);
        assert!((sigma0 - 1.0).abs() < 0.06, "{asked}: {sigma0}");
        for own in found["per_image"].as_array().unwrap() {
            let scatter = SCATTER.iter().find(|(name, _)| own["name"] == *name).unwrap().1;
            let stated = number(&own["prior_sigma"]);
            assert!((0.55 * scatter..1.7 * scatter).contains(&stated), "{asked}: {own}");
        }
    }
}

#[test]
fn one_camera_for_all_is_in_doubt() {
    let (code, found) = answer(example().path(), &["--sigma", "0.1"]);
    assert_eq!(code, Some(3), "{}", found["doubts"]);
    assert!(found["per_image"].as_array().unwrap().is_empty());
}

#[test]
fn the_page_and_its_table_have_them() {
    let folder = example();
    let output = run(folder.path(), &[&POINTS[..], &["--per-image", "c,x0,y0", "--report", "out"]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    for said in ["c differs from image to image by", "warning: a further photograph differs from the camera of all, c by "] {
        assert!(stdout(&output).contains(said), "{said}: {}", stdout(&output));
    }
    let page = std::fs::read_to_string(folder.path().join("out/README.md")).unwrap();
    assert!(page.contains("## What each image has for itself"), "{page}");
    let (rows, truth) = (table(&folder.path().join("out/per-image.csv")), truth());
    assert_eq!(rows.len(), 72);
    for row in rows {
        let of = |name: &str| row[name].parse::<f64>().unwrap();
        let off = of("value") - truth[&(row["image"].clone(), row["number"].clone())];
        assert!(off.abs() < 5.0 * of("sigma") && (0.0..=1.0).contains(&of("redundancy")), "{row:?}");
    }
}

#[test]
fn what_cannot_be_is_said() {
    let folder = example();
    let refused = |more: &[&str], expected: &str| {
        let output = run(folder.path(), &[&POINTS[..], more].concat());
        assert_eq!(output.status.code(), Some(2), "{more:?}: {}", stdout(&output));
        assert!(stderr(&output).contains(expected), "{more:?}: {}", stderr(&output));
    };
    refused(&["--per-image", "k9"], "--per-image k9: the model has no such parameter: expected c, x0, y0, or one of fx, fy");
    refused(&["--per-image", "c,fx"], "two numbers of an image's own change the same parameter");
    refused(&["--per-image", "c:0"], "`c:0`: expected NAME, or NAME:SIGMA with a positive standard deviation");
    refused(&["--per-image", "k1"], "expected k1:SIGMA");
    refused(&["--per-image", "x0", "--solve", "fx,fy"], "cx is held; expected one that is solved for");
    refused(&["--per-image", "c:6", "--datum", "free"], "control that is fixed");
    refused(&["--per-image", "c:6", "--model", "splined:16x13:132:3"], "--per-image is not there for splines");
    let few: Vec<String> = std::fs::read_to_string(folder.path().join("points.csv"))
        .unwrap()
        .lines()
        .filter(|line| ["image", "01", "02", "03", "04"].iter().any(|start| line.starts_with(start)))
        .map(str::to_owned)
        .collect();
    std::fs::write(folder.path().join("points.csv"), few.join("\n")).unwrap();
    refused(&["--per-image", "c"], "4 images do not tell how far it scatters; expected 6 or more, or c:SIGMA");
}
