//! A run that is killed leaves what was there before whole, and the next run completes.

use std::path::Path;
use std::thread::sleep;
use std::time::Duration;

use crate::project::{copy, files, program, run, stderr};

/// Starts the program, kills it after each of several times, and checks that `folder` is as it was.
fn kill(project: &Path, arguments: &[&str], folder: &str) {
    let before = files(&project.join(folder));
    assert!(!before.is_empty());
    let mut killed = 0;
    for milliseconds in [5, 20, 50, 90, 140, 200, 300] {
        let mut child = program(project).args(arguments).spawn().unwrap();
        sleep(Duration::from_millis(milliseconds));
        killed += u32::from(child.try_wait().unwrap().is_none());
        child.kill().unwrap();
        child.wait().unwrap();
        let partial = |path: &Path| path.components().any(|part| part.as_os_str().to_string_lossy().starts_with(".calibench-partial-"));
        let mut after = files(&project.join(folder));
        after.retain(|(path, _)| !partial(path));
        assert!(after == before, "{arguments:?} killed after {milliseconds} ms changed {folder}");
    }
    assert!(killed > 0, "{arguments:?} always ended before it was killed");
}

#[test]
fn a_killed_run_leaves_the_old_records_and_the_next_completes() {
    let project = copy();
    assert!(run(project.path(), &["run", "corners/noise", "--trials", "4", "-q"]).status.success());
    kill(project.path(), &["run", "corners/noise", "--trials", "100000", "-q"], "records");
    let output = run(project.path(), &["run", "corners/noise", "--trials", "8", "-q"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let left = |folder: &str| -> Vec<String> {
        let entries = std::fs::read_dir(project.path().join(folder)).unwrap();
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
    };
    assert_eq!(
        (left("records"), left("records/corners")),
        (vec!["corners".to_owned()], vec!["noise".to_owned()]),
        "nothing half written is left"
    );
}

#[test]
fn a_killed_report_leaves_the_old_pages_and_the_next_completes() {
    let project = copy();
    assert!(run(project.path(), &["run", "--all", "-q"]).status.success());
    assert!(run(project.path(), &["report", "-q"]).status.success());
    let before = files(&project.path().join("reports"));
    // The pages are the same bytes whenever they are written: killed or not, nothing may change or be missing.
    for milliseconds in [2, 10, 30, 60, 100, 150] {
        let mut child = program(project.path()).args(["report", "-q"]).spawn().unwrap();
        sleep(Duration::from_millis(milliseconds));
        child.kill().unwrap();
        child.wait().unwrap();
        let after = files(&project.path().join("reports"));
        for (path, bytes) in &before {
            assert!(after.iter().any(|(other, content)| other == path && content == bytes), "{} after {milliseconds} ms", path.display());
        }
    }
    assert!(run(project.path(), &["report", "-q"]).status.success());
    assert!(files(&project.path().join("reports")) == before);
}
