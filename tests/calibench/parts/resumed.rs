//! Parts that are there, that were stopped, and that are run again.

use std::thread::sleep;
use std::time::Duration;

use super::{good, part, same};
use crate::project::{copy, files, program, run, stderr};

const NOISE: &[&str] = &["corners/noise"];
const PART: &str = "parts/1-of-2/corners/noise";

#[test]
fn a_part_that_is_there_is_left_and_one_of_another_run_stays() {
    let folder = copy();
    let project = folder.path();
    let few = ["--trials", "3"];
    let told = part(project, NOISE, "1/2", &few);
    assert!(told.contains("part 1/2: 2 of 3 trials in "), "{told}");
    let (before, written) = (files(&project.join(PART)), || std::fs::metadata(project.join(PART)).unwrap().modified().unwrap());
    let first = written();
    let told = part(project, NOISE, "1/2", &few);
    assert!(told.contains("part 1/2: 2 of 3 trials, already there") && written() == first, "{told}");
    for (change, words) in [
        (&["--trials", "4"][..], "trials 4 in 1 cells, there 3 in 1 cells"),
        (&["--trials", "3", "--seed", "8"], "seed 8, there "),
        (&["--trials", "3", "-m", "pixel"], "methods `pixel` version 1, there `pixel` version 1, `forstner"),
    ] {
        let output = run(project, &[&["run", "--part", "1/2", "-o", "parts"], NOISE, change].concat());
        let told = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{told}");
        assert!(told.contains(PART) && told.contains(words) && told.contains("--again"), "{told}");
        assert!(files(&project.join(PART)) == before && written() == first);
    }
    // What lost a file is run again, and so is what was asked for again.
    std::fs::remove_file(project.join(PART).join("records.csv.gz")).unwrap();
    assert!(part(project, NOISE, "1/2", &few).contains(" trials in "));
    assert!(files(&project.join(PART)) == before);
    part(project, NOISE, "1/2", &["--trials", "4", "--again"]);
    assert!(files(&project.join(PART)) != before);
}

#[test]
fn a_part_that_is_killed_leaves_nothing_and_the_next_completes() {
    let folder = copy();
    let project = folder.path();
    let arguments = ["run", "--part", "1/2", "-o", "parts", "--trials", "100000", "corners/noise", "-q"];
    let mut killed = 0;
    for milliseconds in [5, 50, 150, 300] {
        let mut child = program(project).args(arguments).spawn().unwrap();
        sleep(Duration::from_millis(milliseconds));
        killed += u32::from(child.try_wait().unwrap().is_none());
        child.kill().unwrap();
        child.wait().unwrap();
        assert!(!project.join(PART).exists());
        let output = run(project, &["merge", "parts"]);
        assert!(output.status.code() == Some(2) && !project.join("records").exists(), "{}", stderr(&output));
    }
    assert!(killed > 0);
    for place in ["1/2", "2/2"] {
        part(project, NOISE, place, &["--trials", "4"]);
    }
    let names: Vec<_> = std::fs::read_dir(project.join("parts/1-of-2/corners")).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(names, ["noise"], "nothing half written is left");
    good(project, &["merge", "parts", "-q"]);
    let merged = files(&project.join("records/corners/noise"));
    good(project, &["run", "corners/noise", "--trials", "4", "-q"]);
    assert!(files(&project.join("records/corners/noise")) == merged);
}

/// Every scenario of a project, as a job array runs it: what cannot be cut or is nothing makes no job fail.
#[test]
fn a_job_takes_its_part_of_everything() {
    let folder = copy();
    let project = folder.path();
    for name in files(&project.join("scenarios")).into_iter().map(|(path, _)| path) {
        let kept = ["corners/noise.toml", "zhu-2007/table-1.toml", "galo-2011/corners.toml", "scenario.schema.json"];
        if !kept.iter().any(|kept| name.ends_with(kept)) {
            std::fs::remove_file(project.join("scenarios").join(name)).unwrap();
        }
    }
    good(project, &["run", "--all", "-q"]);
    for place in ["1/2", "2/2"] {
        part(project, &["--all"], place, &["-q"]);
    }
    good(project, &["merge", "parts/1-of-2", "parts/2-of-2", "-o", "merged", "-q"]);
    same(&project.join("records"), &project.join("merged"));
}
