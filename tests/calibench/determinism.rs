//! Same seed, same bytes: on one thread, on two, and again.

use std::path::PathBuf;

use crate::project::{copy, files, program};

/// Records and reports of every scenario, made on `threads` threads.
fn outputs(threads: &str) -> Vec<(PathBuf, Vec<u8>)> {
    let project = copy();
    for arguments in [&["run", "--all", "--quiet"][..], &["report", "--quiet"]] {
        let status = program(project.path()).args(arguments).env("RAYON_NUM_THREADS", threads).status().unwrap();
        assert!(status.success(), "{arguments:?}");
    }
    let mut all = files(&project.path().join("records"));
    all.extend(files(&project.path().join("reports")));
    all
}

#[test]
fn one_thread_two_threads_and_a_second_run_write_the_same_bytes() {
    let one = outputs("1");
    for needed in ["corners/noise/records.csv.gz", "galo-2011/README.md", "galo-2011/corners-targets.png", "photographs/README.md"] {
        assert!(one.iter().any(|(path, _)| path.ends_with(needed)), "{needed} was written");
    }
    for (what, other) in [("two threads", outputs("2")), ("a second run", outputs("2"))] {
        assert_eq!(one.len(), other.len(), "{what}");
        for ((path, bytes), (other_path, other_bytes)) in one.iter().zip(&other) {
            assert_eq!(path, other_path, "{what}");
            assert!(bytes == other_bytes, "{what}: {} differs", path.display());
        }
    }
}
