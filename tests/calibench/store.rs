//! The store as commands use it: what is up to date is left, what is not is done, and the gate says the same either way.

use std::path::{Path, PathBuf};
use std::process::Output;

use crate::project::{copy_of, files, program, stderr, stdout};

/// A project of a few scenarios: a scene in noise, drawn ones, one with published tables.
fn few() -> tempfile::TempDir {
    copy_of(&["corners/", "galo-2011/corners", "zhu-2007/table-1"])
}

/// With a store of its own.
fn run(project: &Path, arguments: &[&str]) -> Output {
    program(project).env("CALIBENCH_STORE", project.join("kept")).args(arguments).output().expect("the program starts")
}

/// The entries of the store.
fn entries(project: &Path) -> Vec<PathBuf> {
    files(&project.join("kept")).into_iter().map(|(path, _)| project.join("kept").join(path)).collect()
}

/// A project of one's own, whose gate has two scenarios.
fn gate() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let good = |arguments: &[&str]| assert!(run(folder.path(), arguments).status.success(), "{arguments:?}");
    good(&["init", "gate", "-q"]);
    for entry in std::fs::read_dir(folder.path().join("gate")).unwrap().map(|entry| entry.unwrap()) {
        std::fs::rename(entry.path(), folder.path().join(entry.file_name())).unwrap();
    }
    let text = std::fs::read_to_string(folder.path().join("scenarios/first/corners.toml")).unwrap();
    std::fs::write(folder.path().join("scenarios/first/others.toml"), text).unwrap();
    good(&["bless", "--yes", "-q"]);
    std::fs::remove_dir_all(folder.path().join("kept")).unwrap();
    folder
}

/// Puts more noise into a scenario.
fn worsen(project: &Path, more: &str) {
    let path = project.join("scenarios/first/corners.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.contains("grey_noise = 0.02") && text.contains("\nseed = "), "{text}");
    let text = text.replacen("grey_noise = 0.02", "grey_noise = 0.04", 1).replacen("\nseed = ", &format!("\n{more}seed = "), 1);
    std::fs::write(path, text).unwrap();
}

#[test]
fn what_is_up_to_date_is_left_and_said() {
    let project = few();
    let first = run(project.path(), &["run", "--all"]);
    assert!(first.status.success() && stderr(&first).contains("0 of 5 up to date"), "{}", stderr(&first));
    let records = files(&project.path().join("records"));
    let written = |name: &str| std::fs::metadata(project.path().join("records").join(name)).unwrap().modified().unwrap();
    let before = written("corners/noise/records.csv.gz");
    let again = run(project.path(), &["run", "--all"]);
    assert!(again.status.success() && stderr(&again).contains("5 of 5 up to date"), "{}", stderr(&again));
    assert!(stderr(&again).contains("corners/noise: up to date"), "{}", stderr(&again));
    assert!(files(&project.path().join("records")) == records && written("corners/noise/records.csv.gz") == before);
    // Anew, whatever is there: the same bytes.
    let fresh = run(project.path(), &["run", "--all", "--fresh"]);
    assert!(fresh.status.success() && stderr(&fresh).contains("0 of 5 up to date"), "{}", stderr(&fresh));
    assert!(files(&project.path().join("records")) == records && written("corners/noise/records.csv.gz") > before);
    // A file of the records that went is written again, from the store.
    std::fs::remove_file(project.path().join("records/corners/noise/records.csv.gz")).unwrap();
    let mended = run(project.path(), &["run", "corners/noise"]);
    assert!(mended.status.success() && stderr(&mended).contains("corners/noise: up to date"), "{}", stderr(&mended));
    assert!(files(&project.path().join("records")) == records);
}

/// What is kept beside the points is as it is now, though no point changes.
#[test]
fn a_file_that_records_keep_is_kept_as_it_is() {
    let project = copy_of(&["canon-t3/jpeg", "canon-t3/camera"]);
    assert!(run(project.path(), &["run", "canon-t3/jpeg", "-q"]).status.success());
    let camera = project.path().join("scenarios/canon-t3/camera.xml");
    let text = std::fs::read_to_string(&camera).unwrap() + "<!-- looked at -->\n";
    std::fs::write(&camera, &text).unwrap();
    let again = run(project.path(), &["run", "canon-t3/jpeg"]);
    assert!(again.status.success() && stderr(&again).contains("canon-t3/jpeg: up to date"), "{}", stderr(&again));
    let kept = project.path().join("records/canon-t3/jpeg/camera-of-the-run/camera.xml");
    assert_eq!(std::fs::read_to_string(kept).unwrap(), text);
    // Another camera is another result.
    let number = text.find("<f>").or_else(|| text.find("<fx>")).unwrap_or_else(|| panic!("{text}"));
    let digit = number + text[number..].find(|c: char| c.is_ascii_digit()).unwrap();
    let other = format!("{}{}{}", &text[..digit], if &text[digit..=digit] == "9" { "8" } else { "9" }, &text[digit + 1..]);
    std::fs::write(&camera, other).unwrap();
    let anew = run(project.path(), &["run", "canon-t3/jpeg"]);
    assert!(!stderr(&anew).contains("up to date"), "{}", stderr(&anew));
}

#[test]
fn a_method_that_is_new_is_run_alone() {
    let project = few();
    assert!(run(project.path(), &["run", "corners/noise", "-q"]).status.success());
    let path = project.path().join("scenarios/corners/noise.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    let methods = text.matches("[[method]]").count();
    std::fs::write(&path, format!("{text}\n[[method]]\nname = \"saddle\"\nkinds = [\"corner\"]\nwindow = 17\n")).unwrap();
    let output = run(project.path(), &["run", "corners/noise"]);
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(stderr(&output).contains(&format!("{methods} of {} results up to date", methods + 1)), "{}", stderr(&output));
}

#[test]
fn the_gate_says_the_same_with_and_without_a_store() {
    let project = gate();
    let check = ["check", "--strict", "--json"];
    let without = program(project.path()).env("CALIBENCH_STORE", "").args(check).output().unwrap();
    assert_eq!(without.status.code(), Some(0), "{}{}", stdout(&without), stderr(&without));
    for filled in [false, true] {
        let with = run(project.path(), &check);
        assert!(with.stdout == without.stdout && with.status == without.status, "{}", stdout(&with));
        assert_eq!(stderr(&with).contains("2 of 2 up to date"), filled, "{}", stderr(&with));
    }
    // More noise is worse, whatever was right before.
    worsen(project.path(), "");
    let without = program(project.path()).env("CALIBENCH_STORE", "").args(check).output().unwrap();
    for _ in 0..2 {
        let with = run(project.path(), &check);
        assert_eq!((with.status.code(), with.stdout == without.stdout), (Some(1), true), "{}", stdout(&with));
    }
}

#[test]
fn a_corrupted_result_is_told_and_done_anew() {
    let project = gate();
    assert!(run(project.path(), &["check", "-q"]).status.success());
    let mut broken = 0;
    for path in entries(project.path()) {
        let mut bytes = std::fs::read(&path).unwrap();
        let last = bytes.len() - 1;
        bytes[last / 2] ^= 16;
        std::fs::write(&path, bytes).unwrap();
        broken += 1;
    }
    let output = run(project.path(), &["check", "--strict", "-q"]);
    assert!(output.status.success() && broken > 1, "{}{}", stdout(&output), stderr(&output));
    assert!(stderr(&output).contains("were not as they had been written, and were computed anew"), "{}", stderr(&output));
    let output = run(project.path(), &["check", "--strict"]);
    assert!(output.status.success() && stderr(&output).contains("2 of 2 up to date"), "{}", stderr(&output));
    assert!(!stderr(&output).contains("computed anew"), "{}", stderr(&output));
}

#[test]
fn two_commands_at_once_share_a_store() {
    let project = gate();
    let other = gate();
    let start = |folder: &Path| {
        program(folder).env("CALIBENCH_STORE", project.path().join("kept")).args(["check", "--strict", "-q"]).spawn().unwrap()
    };
    for mut child in [start(project.path()), start(other.path()), start(project.path())] {
        assert!(child.wait().unwrap().success());
    }
    assert!(entries(project.path()).iter().all(|path| !path.to_string_lossy().contains("new-")), "nothing half written is left");
    let output = run(project.path(), &["check", "--strict"]);
    assert!(output.status.success() && stderr(&output).contains("2 of 2 up to date"), "{}", stderr(&output));
}

#[test]
fn what_is_left_to_the_night_is_named_and_tested_when_asked_for() {
    let project = gate();
    worsen(project.path(), "nightly = true\n");
    // A bound of what is left is left with it.
    let bound = "[[ceiling]]\nscenario = \"first/corners\"\nmethod = \"forstner:window=11\"\nmetric = \"rmse_xy\"\nat_most = 0.01\nwhy = \"a test\"\n";
    std::fs::write(project.path().join("reference/baselines/ceilings.toml"), bound).unwrap();
    let day = run(project.path(), &["check"]);
    assert_eq!(day.status.code(), Some(0), "{}{}", stdout(&day), stderr(&day));
    assert!(stdout(&day).contains("Not tested: first/corners, which is left to `calibench check --nightly`."), "{}", stdout(&day));
    let json: serde_json::Value = serde_json::from_slice(&run(project.path(), &["check", "--json", "-q"]).stdout).unwrap();
    assert_eq!(json["not_tested"], serde_json::json!(["first/corners"]));
    for arguments in [&["check", "--nightly"][..], &["check", "first/corners"]] {
        let night = run(project.path(), arguments);
        assert_eq!(night.status.code(), Some(1), "{}{}", stdout(&night), stderr(&night));
        let said = stdout(&night);
        assert!(said.contains("above its ceiling") && said.contains("worse") && !said.contains("Not tested"), "{said}");
    }
}

/// Verdicts of published cells are compared as a whole: none may be missing because its scenario was left out.
#[test]
fn what_published_tables_stand_on_is_never_left() {
    let project = few();
    for name in ["corners/noise", "zhu-2007/table-1"] {
        let path = project.path().join(format!("scenarios/{name}.toml"));
        let text = std::fs::read_to_string(&path).unwrap();
        std::fs::write(&path, text.replacen("\nseed = ", "\nnightly = true\nseed = ", 1)).unwrap();
    }
    let said = stdout(&run(project.path(), &["check", "-q"]));
    assert!(said.contains("Not tested: corners/noise, which is left to"), "{said}");
}

#[test]
fn a_store_that_is_no_folder_is_refused_and_none_is_wanted_where_it_has_no_name() {
    let project = gate();
    std::fs::write(project.path().join("file"), "mine").unwrap();
    let output = run(project.path(), &["run", "first/corners", "--store", "file"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("--store file: is no folder; expected one, or a place for a new one"), "{}", stderr(&output));
    let output = program(project.path()).env("CALIBENCH_STORE", "").args(["run", "first/corners"]).output().unwrap();
    assert!(output.status.success() && !stderr(&output).contains("up to date"), "{}", stderr(&output));
    assert!(!project.path().join("target").exists() && !project.path().join("kept").exists());
    let output = program(project.path()).env_remove("CALIBENCH_STORE").args(["run", "first/corners"]).output().unwrap();
    assert!(output.status.success() && project.path().join("target/store").is_dir(), "{}", stderr(&output));
}
