//! What must not be put together, and what must not be taken for a run: exit code 2, by name, and nothing changes.

use std::path::Path;

use super::{good, part};
use crate::project::{copy, files, put_table, run, stderr, table};

const NOISE: &[&str] = &["corners/noise"];

/// A project with the three parts of a run of six trials.
fn three() -> tempfile::TempDir {
    let folder = copy();
    for place in ["1/3", "2/3", "3/3"] {
        part(folder.path(), NOISE, place, &["--trials", "6", "-q"]);
    }
    folder
}

fn refused(project: &Path, arguments: &[&str], words: &[&str]) {
    let before = files(project);
    let output = run(project, arguments);
    let told = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {told}");
    for word in words {
        assert!(told.contains(word), "{arguments:?}: expected {word}\n{told}");
    }
    assert!(files(project) == before, "{arguments:?} changed something");
}

const MERGE: [&str; 4] = ["merge", "parts", "-o", "merged"];

#[test]
fn missing_and_doubled_parts_are_named() {
    let folder = three();
    let project = folder.path();
    let place = |name: &str| project.join(name);
    // What was merged before stays.
    good(project, &MERGE);
    refused(project, &["merge", "parts/1-of-3", "parts/3-of-3", "-o", "merged"], &["`corners/noise`: part 2/3 is missing", "all 3 parts"]);
    refused(project, &["merge", "parts/2-of-3", "-o", "merged"], &["parts 1/3, 3/3 are missing"]);
    refused(project, &["merge", "parts", "scenarios", "-o", "merged"], &["scenarios: holds no part of a run"]);
    refused(project, &["merge", "parts", "absent", "-o", "merged"], &["absent: "]);
    std::fs::create_dir_all(place("copy/corners")).unwrap();
    std::fs::rename(place("parts/2-of-3/corners/noise"), place("copy/corners/noise")).unwrap();
    good(project, &["merge", "parts", "copy", "-o", "merged"]);
    part(project, NOISE, "2/3", &["--trials", "6", "-q"]);
    refused(
        project,
        &["merge", "parts", "copy", "-o", "merged"],
        &["part 2/3 of `corners/noise` is there twice", "copy/corners/noise", "parts/2-of-3/corners/noise"],
    );
}

#[test]
fn parts_of_other_runs_are_named_by_what_differs() {
    let folder = three();
    let project = folder.path();
    let redo = |more: &[&str]| part(project, NOISE, "2/3", &[&["--again", "-q"], more].concat());
    for (change, words) in [
        (&["--trials", "6", "--seed", "5"][..], "seed 5, there "),
        (&["--trials", "7"], "trials 7 in 1 cells, there 6 in 1 cells"),
        (&["--trials", "6", "-m", "pixel"], "methods `pixel` version 1, there `pixel` version 1, `forstner"),
    ] {
        redo(change);
        refused(project, &MERGE, &["1-of-3/corners/noise and ", "2-of-3/corners/noise", "different runs of `corners/noise`", words]);
    }
    let scenario = project.join("scenarios/corners/noise.toml");
    let text = std::fs::read_to_string(&scenario).unwrap();
    std::fs::write(&scenario, format!("{text}\n# changed\n")).unwrap();
    redo(&["--trials", "6"]);
    refused(project, &MERGE, &["another text of the scenario"]);
    std::fs::write(&scenario, text).unwrap();
    redo(&["--trials", "6"]);
    part(project, NOISE, "1/4", &["--trials", "6", "-q"]);
    refused(project, &MERGE, &["number of parts 4, there 3"]);
    std::fs::remove_dir_all(project.join("parts/1-of-4")).unwrap();
    good(project, &MERGE);
    // Another version of the code, of the program, of a method.
    let json = project.join("parts/3-of-3/corners/noise/part.json");
    let text = std::fs::read_to_string(&json).unwrap();
    let parsed: serde_json::Value = serde_json::from_str(&text).unwrap();
    for (key, value, words) in [
        ("revision", "abc".into(), "revision abc, there "),
        ("program", "9.9.9".into(), "program version 9.9.9, there "),
        ("methods", serde_json::json!([{"label": "pixel", "version": "7"}]), "methods `pixel` version 7, there `pixel` version 1"),
    ] {
        let mut changed = parsed.clone();
        changed[key] = value;
        std::fs::write(&json, changed.to_string()).unwrap();
        refused(project, &MERGE, &[words]);
    }
    for (key, value, words) in [
        ("format", 3.into(), "its form is 3, this version reads 2"),
        ("of", 0.into(), "there is no part 3/0"),
        ("part", 2.into(), "these are not the trials of part 2/3"),
        ("more", 1.into(), "unknown field `more`"),
    ] {
        let mut changed = parsed.clone();
        changed[key] = value;
        std::fs::write(&json, changed.to_string()).unwrap();
        refused(project, &MERGE, &["part.json: ", words, "run the part again"]);
    }
}

#[test]
fn parts_that_are_not_whole_are_named() {
    let folder = three();
    let project = folder.path();
    good(project, &MERGE);
    let (records, json) = (project.join("parts/2-of-3/corners/noise/records.csv.gz"), project.join("parts/2-of-3/corners/noise/part.json"));
    let whole = std::fs::read(&records).unwrap();
    let rows = table(&project.join("merged/corners/noise/records.csv.gz"));
    let refuse = |words: &[&str]| refused(project, &MERGE, words);
    std::fs::write(&records, &whole[..whole.len() / 2]).unwrap();
    refuse(&["2-of-3/corners/noise/records.csv.gz: is not as it was written", "copy the part again"]);
    // A row fewer in a file that is whole as such.
    put_table(&records, &rows.lines().take(5).map(|line| format!("{line}\n")).collect::<String>());
    refuse(&["records.csv.gz: is not as it was written"]);
    std::fs::remove_file(&records).unwrap();
    refuse(&["records.csv.gz: is missing"]);
    std::fs::write(&records, &whole).unwrap();
    good(project, &MERGE);
    let text = std::fs::read_to_string(&json).unwrap();
    std::fs::write(&json, &text[..40]).unwrap();
    refuse(&["part.json: ", "line"]);
    std::fs::write(&json, text.replace("\"measured\": ", "\"measured\": 1")).unwrap();
    refuse(&["part.json: is not as it was written"]);
}

/// A part has fewer trials than its run: whatever reads runs refuses it.
#[test]
fn a_part_is_no_run() {
    let folder = three();
    let project = folder.path();
    let words = &["is a part of a run, and no run", "`calibench merge`"];
    refused(project, &["records", "parts/1-of-3/corners/noise"], words);
    refused(project, &["records", "parts/1-of-3/corners/noise/records.csv.gz"], words);
    refused(project, &["check", "corners/noise", "--records", "parts/1-of-3"], words);
    refused(project, &["check", "corners/noise", "--against", "parts/1-of-3"], words);
    std::fs::rename(project.join("parts/1-of-3"), project.join("records")).unwrap();
    refused(project, &["report", "corners"], words);
    refused(project, &["run", "corners/noise", "--trials", "2"], &["records/corners/noise: holds a part of a run"]);
    std::fs::rename(project.join("records"), project.join("parts/1-of-3")).unwrap();
    // Nor does what is merged take the place of a part.
    refused(project, &["merge", "parts", "-o", "parts/1-of-3"], &["parts/1-of-3/corners/noise: holds a part of a run"]);
    refused(project, &["merge", "parts", "-o", "scenarios/corners/noise.toml"], &["noise.toml"]);
}

#[test]
fn records_of_another_file_of_the_same_name_stay() {
    let folder = copy();
    let project = folder.path();
    std::fs::create_dir(project.join("elsewhere")).unwrap();
    for file in ["mine.toml", "elsewhere/mine.toml"] {
        std::fs::copy(project.join("scenarios/corners/noise.toml"), project.join(file)).unwrap();
    }
    good(project, &["run", "elsewhere/mine.toml", "--trials", "1", "-q"]);
    part(project, &["mine.toml"], "1/1", &["--trials", "1", "-q"]);
    refused(project, &["merge", "parts"], &["local/mine: holds the records of ", "elsewhere/mine.toml"]);
}

#[test]
fn a_part_of_a_sweep_is_no_sweep() {
    let folder = copy();
    let project = folder.path();
    part(project, &["zhu-2007/bias"], "2/2", &["--trials", "1", "-q"]);
    let words = &["is a part of a run, and no run"];
    let sweep = "parts/2-of-2/zhu-2007/bias";
    refused(project, &["records", sweep], words);
    refused(project, &["records", &format!("{sweep}/cell-0020/records.csv.gz")], words);
    refused(project, &["plot", sweep, "-o", "x.png"], words);
    refused(project, &["check", "zhu-2007/bias", "--records", "parts/2-of-2"], words);
}

#[test]
fn bad_arguments_are_told() {
    let folder = copy();
    for (arguments, words) in [
        (&["--part", "0/3", "-o", "parts"][..], "expected K/N, as in 3/8"),
        (&["--part", "4/3", "-o", "parts"], "expected K/N, as in 3/8"),
        (&["--part", "3", "-o", "parts"], "expected K/N, as in 3/8"),
        (&["--part", "1/3"], "--output <DIR>"),
        (&["-o", "parts"], "--part <K/N>"),
        (&["--again"], "--part <K/N>"),
    ] {
        refused(folder.path(), &[&["run", "corners/noise"], arguments].concat(), &[words]);
    }
    refused(folder.path(), &["merge"], &["<DIR>"]);
}
