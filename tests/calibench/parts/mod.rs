//! Runs in parts: put together they are the bytes of one run, and nothing else passes for one.

mod failing;
mod refused;
mod resumed;
mod told;

use std::path::{Path, PathBuf};
use std::process::Output;

use crate::project::{contents, copy, copy_of_all, files, run, stderr};

/// Trials of each scenario: three parts have two, one and one.
const TRIALS: u64 = 4;

/// Recognised images, their blocks, a local distortion that is drawn in each trial.
const BLOCKS: &str = include_str!("../../../harness/run/src/tests/coded.toml");

/// Photographs, if the folder of data holds them.
const PHOTOGRAPHS: &str = r#"why = "To see photographs in parts."
source = "a test"
seed = 0

[photographs]
folder = "opencv-left"
files = ["left01.jpg", "left02.jpg"]
board = "9x6"

[[method]]
name = "pixel"

[[method]]
name = "forstner"
window = 11
"#;

/// One scenario of each kind: a scene, a rendered network, a drawn one, calibrations that are applied, sweeps of each, blocks of recognised images; and what
/// cannot be cut: printed figures, a scene without anything random, photographs.
const KINDS: [&str; 10] = [
    "corners/noise",
    "galo-2011/network",
    "galo-2011/network-coordinates",
    "canon-t3/study",
    "zhu-2007/bias",
    "vosselman-1988/field-in-3d-frontal",
    "t/blocks",
    "canon-t3/printed",
    "zhu-2007/table-1",
    "t/photographs",
];

/// Runs the program, which must succeed.
fn good(project: &Path, arguments: &[&str]) -> Output {
    let output = run(project, arguments);
    assert!(output.status.success(), "{arguments:?}: {}", stderr(&output));
    output
}

/// Part `part` of `scenarios`, into `parts`; what was said.
fn part(project: &Path, scenarios: &[&str], part: &str, more: &[&str]) -> String {
    stderr(&good(project, &[&["run", "--part", part, "-o", "parts"], scenarios, more].concat()))
}

/// Fails where the files of two folders differ.
fn same(expected: &Path, found: &Path) {
    let (expected, found) = (files(expected), files(found));
    let names = |files: &[(PathBuf, Vec<u8>)]| files.iter().map(|(path, _)| path.clone()).collect::<Vec<_>>();
    assert_eq!(names(&expected), names(&found));
    assert!(!expected.is_empty());
    for ((path, one), (_, other)) in expected.iter().zip(&found) {
        assert!(contents(path, one) == contents(path, other), "{} differs", path.display());
    }
}

#[test]
fn three_parts_on_any_threads_are_one_run() {
    let folder = copy_of_all(TRIALS);
    let project = folder.path();
    std::fs::create_dir(project.join("scenarios/t")).unwrap();
    std::fs::write(project.join("scenarios/t/blocks.toml"), BLOCKS).unwrap();
    std::fs::write(project.join("scenarios/t/photographs.toml"), PHOTOGRAPHS).unwrap();
    good(project, &[&["run", "-q", "--threads", "2"], &KINDS[..]].concat());
    for (place, threads) in [("3/3", "1"), ("1/3", "2"), ("2/3", "1")] {
        part(project, &KINDS, place, &["--threads", threads]);
    }
    let told = stderr(&good(project, &["merge", "parts", "-o", "merged"]));
    for line in
        ["corners/noise: 4 trials from 3 parts", "zhu-2007/bias: 144 trials of 36 cells from 3 parts", "canon-t3/printed: 1 trial from"]
    {
        assert!(told.contains(line), "{line}\n{told}");
    }
    same(&project.join("records"), &project.join("merged"));
    // Of a run the folder holds more than tables.
    for file in ["corners/noise/image.png", "t/photographs/scenario.json", "zhu-2007/table-1/theory.csv"] {
        assert!(project.join("merged").join(file).is_file(), "{file}");
    }
    // What is merged takes the place of older records, as a run does.
    good(project, &["merge", "parts", "-q"]);
    same(&project.join("merged"), &project.join("records"));
}

#[test]
fn more_parts_than_trials_leave_some_empty() {
    let folder = copy();
    let project = folder.path();
    let names = ["corners/noise", "zhu-2007/table-1"];
    good(project, &["run", names[0], "--trials", "3", "-q"]);
    good(project, &["run", names[1], "-q"]);
    let mut empty = 0;
    for number in 1..=5 {
        let place = format!("{number}/5");
        let told = part(project, &names[..1], &place, &["--trials", "3"]);
        empty += u32::from(told.contains("nothing, 3 trials are fewer than the parts"));
        let told = part(project, &names[1..], &place, &[]);
        assert_eq!(told.contains("nothing, what cannot be cut is part 1"), number > 1, "{told}");
    }
    assert_eq!(empty, 2);
    good(project, &["merge", "parts", "-o", "merged"]);
    same(&project.join("records"), &project.join("merged"));
}

/// Tables of many blocks of the compressor, cut in their middle; parts that lie here and there; a file elsewhere in place of a scenario of the project.
#[test]
fn long_tables_from_scattered_parts_are_one_run() {
    let folder = copy();
    let project = folder.path();
    std::fs::copy(project.join("scenarios/corners/noise.toml"), project.join("mine.toml")).unwrap();
    good(project, &["run", "mine.toml", "--trials", "333", "-q"]);
    for number in 1..=7 {
        let (place, output) = (format!("{number}/7"), format!("node {}", number % 3));
        good(project, &["run", "mine.toml", "--trials", "333", "-q", "--part", &place, "-o", &output]);
    }
    let one = "node 1/1-of-7";
    // A folder that lies in another one that is named is one.
    good(project, &["merge", "node 2", one, "node 0", "node 1", "-o", "merged", "-q"]);
    same(&project.join("records"), &project.join("merged"));
    let table = project.join("merged/local/mine/records.csv.gz");
    assert!(std::fs::metadata(&table).unwrap().len() > 1 << 17, "a long table");
}

/// Part of a cell, whole cells, part of a cell; a cell without anything random has one trial.
#[test]
fn a_sweep_is_cut_within_its_cells() {
    let folder = copy();
    let project = folder.path();
    let text = crate::sweeps::swept("\"scene.grey_noise\" = [0.01, 0.02, 0.04]\nseed = [5, 6]");
    std::fs::create_dir(project.join("scenarios/t")).unwrap();
    std::fs::write(project.join("scenarios/t/s.toml"), text).unwrap();
    good(project, &["run", "t/s", "-q", "-m", "pixel", "-m", "forstner"]);
    for number in 1..=4 {
        let told = part(project, &["t/s"], &format!("{number}/4"), &["-m", "pixel", "-m", "forstner"]);
        let count = if number % 2 == 1 { "5 of 18 trials, of 2 of 6 cells" } else { "4 of 18 trials, of 2 of 6 cells" };
        assert!(told.contains(count), "{told}");
    }
    good(project, &["merge", "parts", "-o", "merged"]);
    same(&project.join("records"), &project.join("merged"));
}

#[test]
fn what_was_merged_is_reported_and_checked_as_a_run() {
    let folder = copy();
    let project = folder.path();
    let said = |records: &Path| {
        good(project, &["report", "corners", "-q"]);
        let output = run(project, &["check", "corners/noise", "--records", "records"]);
        assert!(output.status.success(), "{}", stderr(&output));
        (files(&project.join("reports/corners")), output.stdout, files(records))
    };
    good(project, &["run", "corners/noise", "-q"]);
    let whole = said(&project.join("records"));
    std::fs::remove_dir_all(project.join("records")).unwrap();
    for place in ["1/2", "2/2"] {
        part(project, &["corners/noise"], place, &[]);
    }
    // By default the parts go to the project's records.
    good(project, &["merge", "parts"]);
    assert!(said(&project.join("records")) == whole);
}
