//! What `resect` and `intersect` say of points that do not fit: a rendered wall whose measured points get other names, and control that is elsewhere.

use std::path::Path;

use crate::calibrate::{table, wall, write};
use crate::project::{run, stderr};

const RESECT: [&str; 9] = ["resect", "-q", "--camera", "wall/camera.toml", "--points", "points.csv", "--control", "control.csv", "-o"];
const INTERSECT: [&str; 9] =
    ["intersect", "-q", "--camera", "wall/camera.toml", "--points", "points.csv", "--stations", "wall/stations.csv", "-o"];

fn said(folder: &Path, arguments: &[&str], more: &[&str]) -> (Option<i32>, String) {
    let output = run(folder, &[arguments, more].concat());
    (output.status.code(), stderr(&output))
}

/// Two measured points of one image swap their names, which are given back.
fn swap(folder: &Path, image: &str) -> [String; 2] {
    let text = std::fs::read_to_string(folder.join("points.csv")).unwrap();
    let mut lines: Vec<Vec<String>> = text.lines().map(|line| line.split(',').map(str::to_owned).collect()).collect();
    let of: Vec<usize> = (0..lines.len()).filter(|&line| lines[line][0] == image).collect();
    let (a, b) = (of[0], of[of.len() / 2]);
    let names = [a, b].map(|line| lines[line][1].clone());
    (lines[a][1], lines[b][1]) = (names[1].clone(), names[0].clone());
    let lines: Vec<String> = lines.iter().map(|cells| cells.join(",")).collect();
    write(folder, "points.csv", &(lines.join("\n") + "\n"));
    names
}

#[test]
fn names_that_were_swapped_are_in_doubt_or_left_out() {
    let folder = wall();
    let folder = folder.path();
    let names = swap(folder, "s04-r1.png");
    let (code, told) = said(folder, &RESECT, &["poses.csv"]);
    assert!(code == Some(3) && told.contains("image s04-r1.png: in doubt: 2 of ") && told.contains("--tolerance"), "{code:?} {told}");
    assert!(names.iter().all(|name| told.contains(name)) && told.lines().all(|line| line.starts_with("image s04-r1.png: ")), "{told}");
    for row in table(&folder.join("poses.csv")) {
        assert_eq!(row["note"].contains("do not fit"), row["image"] == "s04-r1.png", "{row:?}");
    }
    let (code, told) = said(folder, &RESECT, &["poses.csv", "--tolerance", "2"]);
    assert!(code == Some(0) && told.starts_with("warning: image s04-r1.png: 2 of ") && told.lines().count() == 1, "{code:?} {told}");
    assert!(names.iter().all(|name| told.contains(name)), "{told}");
    assert!(table(&folder.join("poses.csv")).iter().all(|row| row["note"].is_empty()));
    let (code, told) = said(folder, &INTERSECT, &["found.csv"]);
    assert!(code == Some(3) && told.starts_with("in doubt: 2 of "), "{code:?} {told}");
    let found = table(&folder.join("found.csv"));
    let mut misfits: Vec<&str> = found.iter().filter(|row| row["note"] == "does not fit").map(|row| row["target"].as_str()).collect();
    misfits.sort_unstable();
    let mut expected = names.each_ref().map(String::as_str);
    expected.sort_unstable();
    assert_eq!(misfits, expected);
    let (code, told) = said(folder, &INTERSECT, &["found.csv", "--tolerance", "2"]);
    assert_eq!((code, told.as_str()), (Some(0), "warning: 2 image points left out; the table says of which images\n"));
}

#[test]
fn a_standard_deviation_that_was_stated_is_held_against_the_residuals() {
    let folder = wall();
    let folder = folder.path();
    for command in [&RESECT, &INTERSECT] {
        let (code, told) = said(folder, command, &["out.csv", "--sigma", "1"]);
        let expected = "in doubt: the residuals do not agree with --sigma (chi squared at 0.001)\n";
        assert!(code == Some(3) && told == expected, "{code:?} {told}");
        assert_eq!(said(folder, command, &["out.csv"]), (Some(0), String::new()));
    }
    let (code, told) = said(folder, &RESECT, &["out.csv", "--sigma", "0.001"]);
    assert!(code == Some(3) && told.lines().filter(|line| line.ends_with("--sigma 0.001")).count() == 8, "{code:?} {told}");
}

#[test]
fn targets_that_are_no_control_points_are_named() {
    let folder = wall();
    let folder = folder.path();
    let text = std::fs::read_to_string(folder.join("points.csv")).unwrap();
    let columns = text.lines().next().unwrap().split(',').count();
    write(folder, "points.csv", &format!("{text}s04-r1.png,nobody,100,100{}\n", ",".repeat(columns - 4)));
    let (code, told) = said(folder, &RESECT, &["poses.csv"]);
    assert!(
        code == Some(0) && told.starts_with("warning: 1 of ") && told.ends_with("targets are no control points: nobody\n"),
        "{code:?} {told}"
    );
}
