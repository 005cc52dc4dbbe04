//! The atlas: the settings that it evaluates are those that the search gives, and its report is a pure function of records.

use std::path::Path;

use calibench_report::atlas::{Part, best, unmeasured};

use crate::project::{copy_with, run, stderr};

fn part(project: &Path, name: &str) -> Part {
    Part::load(&project.join("records"), name).expect("records").expect("a sweep")
}

#[test]
fn the_atlas_measures_the_settings_that_the_search_finds() {
    let project = copy_with(&["atlas"]);
    for family in ["corners", "discs", "wedges"] {
        let (search, evaluation) = (format!("atlas/search-{family}"), format!("atlas/{family}"));
        let ran = run(project.path(), &["run", "-q", &search]);
        assert!(ran.status.success(), "{}", stderr(&ran));
        // One trial is enough to know which methods it has.
        assert!(run(project.path(), &["run", "-q", &evaluation, "--trials", "1"]).status.success());
        let (search, evaluation) = (part(project.path(), &search), part(project.path(), &evaluation));
        assert_ne!(search.sweep.seed, evaluation.sweep.seed, "the search has other seeds");
        assert_eq!(unmeasured(&search, &evaluation), Vec::<String>::new());
        assert!(best(&search).iter().all(|(_, found)| found.len() > 1), "{family}: each operator has a best setting");
    }
}

#[test]
fn plot_reads_a_folder_of_records_and_short_keys() {
    let project = copy_with(&["atlas"]);
    assert!(run(project.path(), &["run", "-q", "atlas/corners-phase", "--trials", "1"]).status.success());
    let arguments =
        ["plot", "records/atlas/corners-phase", "--x", "x0", "--y", "rmse", "--by", "method", "--at", "blur=0.7", "-o", "phase.png"];
    let plotted = run(project.path(), &arguments);
    assert!(plotted.status.success(), "{}", stderr(&plotted));
    let numbers = std::fs::read_to_string(project.path().join("phase.csv")).expect("the numbers beside the picture");
    assert!(numbers.starts_with("camera.x0,optics.blur,method,metric,"), "{numbers}");
}
