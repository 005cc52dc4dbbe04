//! The gate as CI meets it.

mod requirement;

use std::path::Path;

use crate::project::{copy, run, stderr, stdout};

fn change(project: &Path, scenario: &str, old: &str, new: &str) {
    let path = project.join("scenarios").join(scenario);
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.contains(old), "{old} stands in {scenario}");
    std::fs::write(path, text.replacen(old, new, 1)).unwrap();
}

#[test]
fn the_blessed_accuracy_holds() {
    let project = copy();
    let output = run(project.path(), &["check", "-q"]);
    assert_eq!(output.status.code(), Some(0), "{}{}", stdout(&output), stderr(&output));
    assert!(stdout(&output).contains("The gate holds"), "{}", stdout(&output));
    let output = run(project.path(), &["bless", "-q"]);
    assert!(stdout(&output).contains("nothing to bless"), "{}{}", stdout(&output), stderr(&output));
}

#[test]
fn a_regression_exits_with_1_and_a_table_of_names() {
    let project = copy();
    change(project.path(), "corners/noise.toml", "grey_noise = 0.02", "grey_noise = 0.04");
    change(project.path(), "galo-2011/corners.toml", "start = [53, 42]", "start = [53, 43]");
    let output = run(project.path(), &["check", "-q"]);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    let text = stdout(&output);
    for method in ["forstner:window=11", "harris_paraboloid:window=11", "opencv_subpix:window=11"] {
        assert!(text.contains(&format!("{method} in corners/noise")), "{method}\n{text}");
    }
    assert!(text.contains("above its ceiling") && text.contains("image/2"), "{text}");
    assert!(!text.contains("galo-2011/corners-drawn "), "what did not change is not named\n{text}");
}

#[test]
fn what_is_missing_fails_by_name() {
    let project = copy();
    std::fs::remove_file(project.path().join("scenarios/galo-2011/corners-drawn.toml")).unwrap();
    change(project.path(), "corners/noise.toml", "name = \"harris_paraboloid\"\nwindow = 11", "name = \"harris_paraboloid\"\nwindow = 9");
    let output = run(project.path(), &["check", "-q"]);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    let text = stdout(&output);
    for part in ["galo-2011/corners-drawn", "harris_paraboloid:window=11 in corners/noise", "harris_paraboloid:window=9"] {
        assert!(text.contains(part), "{part}\n{text}");
    }
}

#[test]
fn bless_lists_what_gets_worse_and_writes_only_when_told() {
    let project = copy();
    change(project.path(), "corners/noise.toml", "grey_noise = 0.02", "grey_noise = 0.03");
    let path = project.path().join("reference/baselines/corners--noise.csv");
    let ceilings = project.path().join("reference/baselines/ceilings.toml");
    let read = |path: &Path| std::fs::read(path).unwrap();
    let (before, bounds) = (read(&path), read(&ceilings));
    let output = run(project.path(), &["bless", "-q"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("--yes after looking"), "{}", stderr(&output));
    assert!(stdout(&output).contains("corners/noise: gets worse:") && stdout(&output).contains("forstner:window=11: rmse_xy"));
    assert!(read(&path) == before, "nothing was written");
    assert!(run(project.path(), &["bless", "--yes", "-q"]).status.success());
    assert!(read(&path) != before && read(&ceilings) == bounds, "the baseline was, the ceilings were not");
    assert_eq!(run(project.path(), &["check", "-q"]).status.code(), Some(1), "blessing does not move a ceiling");
}

#[test]
fn a_broken_baseline_is_named_with_its_line() {
    let project = copy();
    let path = project.path().join("reference/baselines/galo-2011--corners.csv");
    let text = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, text.replacen("measured", "mesured", 1)).unwrap();
    let output = run(project.path(), &["check", "galo-2011/corners", "-q"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("galo-2011--corners.csv: line 2"), "{}", stderr(&output));
}

#[test]
fn another_seed_is_no_pairing() {
    let project = copy();
    change(project.path(), "corners/noise.toml", "seed = 20110513", "seed = 7");
    let output = run(project.path(), &["check", "corners/noise", "-q"]);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert!(stdout(&output).contains("the seed is 7 and was 20110513"), "{}", stdout(&output));
}
