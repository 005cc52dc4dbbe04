//! The gate as CI meets it.

mod init;
mod recorded;
mod requirement;

use std::path::Path;

use crate::project::{copy, copy_of, put_table, run, stderr, stdout, table};

fn change(project: &Path, scenario: &str, old: &str, new: &str) {
    let path = project.join("scenarios").join(scenario);
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.contains(old), "{old} stands in {scenario}");
    std::fs::write(path, text.replacen(old, new, 1)).unwrap();
}

/// A project whose gate takes a second: scenarios with ceilings, with published tables.
fn few() -> tempfile::TempDir {
    copy_of(&["corners/", "galo-2011/corners", "galo-2011/distinct", "zhu-2007/"])
}

#[test]
fn the_blessed_accuracy_holds() {
    // `just check` runs all of them; here a few, and what `bless` says of them.
    let project = few();
    let listed = stdout(&run(project.path(), &["list", "scenarios"]));
    let names: Vec<&str> = listed.lines().filter(|line| !line.starts_with(' ')).collect();
    assert!(names.contains(&"corners/noise") && names.contains(&"zhu-2007/table-1"), "{listed}");
    let command = |command| [&[command, "-q"], names.as_slice()].concat();
    let output = run(project.path(), &command("check"));
    assert_eq!(output.status.code(), Some(0), "{}{}", stdout(&output), stderr(&output));
    assert!(stdout(&output).contains("The gate holds"), "{}", stdout(&output));
    let output = run(project.path(), &command("bless"));
    assert!(stdout(&output).contains("nothing to bless"), "{}{}", stdout(&output), stderr(&output));
}

#[test]
fn a_regression_exits_with_1_and_a_table_of_names() {
    let project = few();
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
    let project = few();
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
    let project = few();
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
fn a_baseline_that_is_not_as_it_was_blessed_is_named() {
    let project = copy();
    let path = project.path().join("reference/baselines/galo-2011--corners.csv");
    let text = std::fs::read_to_string(&path).unwrap();
    let last = text.lines().last().unwrap();
    for (damaged, expected) in [
        (Some(text.replacen(",measured,", ",mesured,", 1)), "found `mesured`"),
        (Some(text.replacen(last, "", 1).trim_end().to_owned() + "\n"), "rows were cut or added"),
        (Some(text.replacen("dx", "dz", 1)), "expected the columns"),
        (Some(text.replacen(",0.0", ",0.1", 1)), "was edited after it was blessed"),
        (None, "the baseline is missing"),
    ] {
        match damaged {
            Some(damaged) => std::fs::write(&path, damaged).unwrap(),
            None => std::fs::remove_file(&path).unwrap(),
        }
        let output = run(project.path(), &["check", "galo-2011/corners", "-q"]);
        assert_eq!(output.status.code(), Some(1), "{expected}");
        assert!(stdout(&output).contains(expected), "{expected}: {}", stdout(&output));
    }
}

#[test]
fn nothing_to_check_is_an_error() {
    for (gone, expected) in [
        ("scenarios/galo-2011/corners.toml", "no scenario is called"),
        ("reference/baselines/ceilings.toml", "ceilings.toml: there is no such file"),
        ("reference/baselines/blessed.toml", "nothing is known to be blessed"),
    ] {
        let project = copy();
        std::fs::remove_file(project.path().join(gone)).unwrap();
        let output = run(project.path(), &["check", "galo-2011/corners", "-q"]);
        assert_eq!(output.status.code(), Some(2), "{gone}");
        assert!(stderr(&output).contains(expected), "{}", stderr(&output));
    }
    let project = copy();
    std::fs::remove_dir_all(project.path().join("scenarios")).unwrap();
    std::fs::create_dir(project.path().join("scenarios")).unwrap();
    let output = run(project.path(), &["check", "-q"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("there is no scenario"), "{}", stderr(&output));
}

#[test]
fn strict_and_locked_fail_on_what_is_new() {
    let project = copy();
    let holds = |flags: &[&str]| run(project.path(), &[&["check", "galo-2011/corners", "-q"], flags].concat()).status.code();
    assert_eq!((holds(&[]), holds(&["--strict", "--locked"])), (Some(0), Some(0)));
    change(project.path(), "galo-2011/corners.toml", "why", "# said better\nwhy");
    assert_eq!((holds(&[]), holds(&["--strict"])), (Some(0), Some(1)), "a comment changes no number");
    let project = copy();
    let text = std::fs::read_to_string(project.path().join("scenarios/galo-2011/corners.toml")).unwrap();
    std::fs::write(project.path().join("scenarios/galo-2011/other.toml"), text).unwrap();
    let code =
        |flags: &[&str]| run(project.path(), &[&["check", "galo-2011/corners", "galo-2011/other", "-q"], flags].concat()).status.code();
    assert_eq!((code(&[]), code(&["--locked"])), (Some(0), Some(1)));
}

#[test]
fn a_sweep_is_gated_cell_by_cell() {
    let project = copy();
    let output = run(project.path(), &["check", "zhu-2007/bias", "--strict", "--locked", "-q"]);
    assert_eq!(output.status.code(), Some(0), "{}{}", stdout(&output), stderr(&output));
    change(project.path(), "zhu-2007/bias.toml", "\"method.sigma\" = [0.5,", "\"method.sigma\" = [0.51,");
    let output = run(project.path(), &["check", "zhu-2007/bias", "-q"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stdout(&output).contains("the cell is missing"), "{}", stdout(&output));
}

#[test]
fn two_runs_are_compared_point_by_point() {
    let project = copy();
    let scenario = "zhu-2007/bias";
    assert!(run(project.path(), &["run", scenario, "-q"]).status.success());
    let output = run(project.path(), &["check", scenario, "--against", "records", "--strict", "-q", "--json", "--junit", "gate.xml"]);
    assert_eq!(output.status.code(), Some(0), "{}{}", stdout(&output), stderr(&output));
    assert!(stdout(&output).contains("\"holds\": true"), "{}", stdout(&output));
    assert!(std::fs::read_to_string(project.path().join("gate.xml")).unwrap().contains("failures=\"0\""));
    let records = project.path().join("records/zhu-2007/bias/cell-0030/records.csv.gz");
    // The first point that is not lost is off by another tenth of a pixel in x.
    let text = table(&records);
    let row = text.lines().find(|line| line.contains(",measured,")).unwrap();
    let cells: Vec<&str> = row.split(',').collect();
    let x = cells.len() - 11;
    let off = (cells[x].parse::<f64>().unwrap() + 0.1).to_string();
    let moved = [&cells[..x], &[&*off], &cells[x + 1..]].concat().join(",");
    put_table(&records, &text.replacen(row, &moved, 1));
    let output = run(project.path(), &["check", scenario, "--against", "records", "--strict", "-q"]);
    assert_eq!(output.status.code(), Some(1), "{}{}", stdout(&output), stderr(&output));
}

#[test]
fn another_seed_is_no_pairing() {
    let project = copy();
    change(project.path(), "corners/noise.toml", "seed = 20110513", "seed = 7");
    let output = run(project.path(), &["check", "corners/noise", "-q"]);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert!(stdout(&output).contains("the seed is 7 and was 20110513"), "{}", stdout(&output));
}
