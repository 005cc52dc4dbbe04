//! Same seed, same bytes: on one thread, and again on two.
//!
//! Of every scenario a few trials, and of what it sweeps the ends: more would be drawn and adjusted by the same code. What is large only to be large is compared by night, with
//! `CALIBENCH_NIGHTLY` set; its smaller twin here.

use std::path::PathBuf;

use crate::project::{contents, copy_of_all, files, fresh, keep_ends_of_sweeps, leave_nightly};

/// Trials of each scenario: two threads need two to differ.
const TRIALS: u64 = 2;

/// Records and reports of every scenario, made on `threads` threads.
fn outputs(threads: &str) -> Vec<(PathBuf, Vec<u8>)> {
    let project = copy_of_all(TRIALS);
    if std::env::var_os("CALIBENCH_NIGHTLY").is_none() {
        leave_nightly(project.path());
    }
    keep_ends_of_sweeps(project.path());
    for arguments in [&["run", "--all", "--quiet"][..], &["report", "--quiet"]] {
        let status = fresh(project.path()).args(arguments).args(["--threads", threads]).status().unwrap();
        assert!(status.success(), "{arguments:?}");
    }
    let mut all = files(&project.path().join("records"));
    all.extend(files(&project.path().join("reports")));
    all
}

#[test]
fn a_second_run_on_two_threads_writes_the_same_bytes_as_one_on_one() {
    let one = outputs("1");
    for needed in [
        "corners/noise/records.csv.gz",
        "galo-2011/network/calibrations.csv.gz",
        "atlas/which-operator.md",
        "galo-2011/README.md",
        "galo-2011/corners-targets.png",
        "photographs/README.md",
    ] {
        assert!(one.iter().any(|(path, _)| path.ends_with(needed)), "{needed} was written");
    }
    let two = outputs("2");
    assert_eq!(one.len(), two.len());
    for ((path, bytes), (other_path, other_bytes)) in one.iter().zip(&two) {
        assert_eq!(path, other_path);
        assert!(contents(path, bytes) == contents(path, other_bytes), "{} differs", path.display());
    }
}
