//! `calibrate --rig`: two cameras on a bar whose truth is known, what is written, and what a user may get wrong.

use std::path::Path;

use calibench_cameras::{ReadOptions, read_camera_with};
use serde_json::Value;

use crate::project::{self, run, stderr, stdout};

const RIG: [&str; 11] = [
    "calibrate",
    "--points",
    "points.csv",
    "--control",
    "control.csv",
    "--size",
    "1280x960",
    "--rig",
    "left,right",
    "--sync",
    "left*.png=right*.png",
];

/// The project's example.
fn example() -> tempfile::TempDir {
    project::example("rig", &["points.csv", "control.csv", "times.csv"])
}

fn answer(folder: &Path, more: &[&str]) -> (Option<i32>, Value) {
    let output = run(folder, &[&RIG[..], more].concat());
    let found = serde_json::from_str(&stdout(&output)).unwrap_or_else(|error| panic!("{error}: {}", stderr(&output)));
    (output.status.code(), found)
}

fn three(value: &Value) -> [f64; 3] {
    [0, 1, 2].map(|i| value[i].as_f64().unwrap())
}

#[test]
fn two_cameras_on_a_bar_are_where_they_are() {
    let folder = example();
    let (code, found) = answer(folder.path(), &["--json", "-o", "rig"]);
    assert_eq!((code, &found["command"]), (Some(0), &Value::from("calibrate-rig")), "{}", found["doubts"]);
    let mount = &found["cameras"][1]["mount"];
    let (position, sigma) = (three(&mount["position"]), three(&mount["sigma_position"]));
    for (k, truth) in [0.24, 0.004, -0.01].into_iter().enumerate() {
        assert!((position[k] - truth).abs() < 4.0 * sigma[k] && sigma[k] < 5e-4, "{position:?} {sigma:?}");
    }
    assert!(found["one_rig"]["p"].as_f64().unwrap() > 1e-3, "{}", found["one_rig"]);
    assert_eq!(found["alone"], serde_json::json!(["left10.png"]));
    // Files come back with the pose.
    for name in ["camchain.yaml", "stereo-left-right.yml"] {
        let cameras = read_camera_with(&folder.path().join("rig").join(name), &ReadOptions::default()).unwrap().cameras;
        let back = cameras[1].pose.unwrap().position;
        assert!(cameras.len() == 2 && back.iter().zip(position).all(|(a, b)| (a - b).abs() < 1e-9), "{name}: {back:?}");
    }
    let own: Value = serde_json::from_slice(&std::fs::read(folder.path().join("rig/rig.json")).unwrap()).unwrap();
    assert_eq!(own["cameras"], found["cameras"]);
    assert!(folder.path().join("rig/colmap-rig.json").is_file());
    let diff = run(folder.path(), &["diff", "rig/stereo-left-right.yml", "rig/stereo-left-right.yml", "--rig", "--distance", "1"]);
    assert!(diff.status.success() && stdout(&diff).contains("moved by 0"), "{}{}", stdout(&diff), stderr(&diff));
    // From what was written, held: the same place again.
    let (_, held) = answer(folder.path(), &["--json", "--start", "rig/stereo-left-right.yml", "--solve", "none"]);
    let again = three(&held["cameras"][1]["mount"]["position"]);
    assert!(again.iter().zip(position).all(|(a, b)| (a - b).abs() < 1e-6), "{again:?} {position:?}");
}

/// The same images against the rig that they gave stand; against one whose right camera sat 2 mm further off they have moved.
#[test]
fn a_rig_is_judged_against_its_file() {
    let folder = example();
    assert_eq!(answer(folder.path(), &["--json", "-o", "rig"]).0, Some(0));
    let judged = |file: &str, more: &[&str]| {
        let rig = ["judge", "--camera", file, "--distance", "1"];
        let output = run(folder.path(), &[&rig[..], &RIG[1..], more].concat());
        (output.status.code(), stdout(&output), stderr(&output))
    };
    let (code, text, error) = judged("rig/stereo-left-right.yml", &[]);
    assert!(code == Some(0) && text.contains("right stands as it did against left, up to 1.00 px"), "{code:?} {text}{error}");
    let chain = std::fs::read_to_string(folder.path().join("rig/camchain.yaml")).unwrap();
    let x = chain.lines().find(|line| line.contains("- [") && line.contains("0.9")).unwrap_or_else(|| panic!("{chain}"));
    let last: f64 = x.rsplit_once(',').unwrap().1.trim_end_matches([']', ' ']).trim().parse().unwrap();
    let moved = x.replacen(x.rsplit_once(',').unwrap().1, &format!(" {}]", last + 0.002), 1);
    std::fs::write(folder.path().join("before.yaml"), chain.replacen(x, &moved, 1)).unwrap();
    let (code, text, error) = judged("before.yaml", &["--json"]);
    let found: Value = serde_json::from_str(&text).unwrap_or_else(|_| panic!("{text}{error}"));
    let right = &found["cameras"][0];
    assert_eq!(
        (code, &found["command"], &right["verdict"], &right["name"]),
        (Some(1), &"judge-rig".into(), &"moved".into(), &"right".into())
    );
    let value = |key: &str| right[key]["value"].as_f64().unwrap();
    assert!((value("moved") - 0.002).abs() < 2e-4, "{right}");
    for (more, message) in [
        (&["--rig", "left"][..], "--rig: expected the names of two cameras or more"),
        (&["--sync", "left*.png"][..], "has 1 patterns; expected one for each of left, right"),
        (&["--camera", "rig/left.yaml"][..], "holds 1 cameras that have other names than the 2 of the rig"),
    ] {
        let keeps = |word: &str| !more.contains(&word);
        let mut words: Vec<&str> = vec!["judge"];
        let all = [&["--camera", "before.yaml", "--distance", "1"][..], &RIG[1..]].concat();
        all.chunks(2).filter(|pair| keeps(pair[0])).for_each(|pair| words.extend(pair));
        let output = run(folder.path(), &[&words[..], more].concat());
        assert!(output.status.code() == Some(2) && stderr(&output).contains(message), "{message}: {}", stderr(&output));
    }
}

#[test]
fn times_pair_as_names_do() {
    let folder = example();
    let (_, names) = answer(folder.path(), &["--json"]);
    let by_times = ["--camera", "left=left*", "--camera", "right=right*", "--times", "times.csv", "--json"];
    let output = run(folder.path(), &[&RIG[..9], &by_times].concat());
    let times: Value = serde_json::from_str(&stdout(&output)).unwrap_or_else(|error| panic!("{error}: {}", stderr(&output)));
    assert_eq!((&names["cost"], &names["moments"]), (&times["cost"], &times["moments"]));
    assert!(times["spread"]["largest_s"].as_f64().unwrap() < 0.005);
}

#[test]
fn a_rig_that_bends_ends_with_exit_code_3() {
    let folder = example();
    let points = std::fs::read_to_string(folder.path().join("points.csv")).unwrap();
    // From the ninth moment on the right camera is turned by 3 px.
    let turned = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        match line.strip_prefix("right").and_then(|rest| rest.get(..2)?.parse::<usize>().ok()) {
            Some(9..) => format!("{},{},{},{}\n", cells[0], cells[1], cells[2].parse::<f64>().unwrap() + 3.0, cells[3]),
            _ => format!("{line}\n"),
        }
    };
    std::fs::write(folder.path().join("points.csv"), points.lines().map(turned).collect::<String>()).unwrap();
    let output = run(folder.path(), &RIG);
    assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
    assert!(stdout(&output).contains("in doubt: the cameras are not one rig"), "{}", stdout(&output));
    // Images of the right camera are those of another moment: there is no rig at all.
    let late = |line: &str| match line.strip_prefix("right").and_then(|rest| rest.get(..2)?.parse::<usize>().ok().zip(rest.get(2..))) {
        Some((number, rest)) => format!("right{:02}{rest}\n", number % 16 + 1),
        None => format!("{line}\n"),
    };
    std::fs::write(folder.path().join("points.csv"), points.lines().map(late).collect::<String>()).unwrap();
    let output = run(folder.path(), &RIG);
    assert!(output.status.code() == Some(2) && stderr(&output).contains("are the pairs of images of one moment"), "{}", stderr(&output));
}

#[test]
fn what_is_asked_wrongly_is_said() {
    let folder = example();
    for (arguments, words) in [
        (&["--rig", "left", "--sync", "left*"][..], "expected the names of two cameras"),
        (&["--rig", "left,left", "--sync", "left*=l*"], "stands twice"),
        (&["--rig", "left,right", "--sync", "left*"], "expected one for each of left, right"),
        (&["--rig", "left,right"], "no camera is called `left`"),
        (&["--rig", "left,right", "--sync", "left*.png=wrong*.png"], "belongs to no camera"),
        (&["--rig", "left,right", "--sync", "left*=right*", "--datum", "free"], "a rig is adjusted before points that are known"),
        (&["--rig", "left,right", "--sync", "left*.png=right*[0-9].png"], "does not say which images belong together"),
    ] {
        let output = run(folder.path(), &[&RIG[..7], arguments].concat());
        assert!(output.status.code() == Some(2) && stderr(&output).contains(words), "{arguments:?}: {}", stderr(&output));
    }
}
