//! Records against baselines, against themselves, and with rows that contradict others.

use std::path::Path;
use std::process::Output;

use crate::project::{copy_of, program, put_table, run, stderr, stdout, table};

fn holds(output: &Output) {
    let text = stdout(output);
    assert_eq!(output.status.code(), Some(0), "{text}{}", stderr(output));
    assert!(text.contains("nothing fails, 0 changed, 0 not blessed, 0 for information"), "{text}");
}

/// What a run gives in memory, what its records say, and what a blessing keeps of it are alike, to the last finding: of points and of a sweep, OpenCV's methods among them. Of
/// every scenario `just nightly` asks the same.
#[test]
fn records_of_each_kind_are_taken_for_the_run() {
    let project = copy_of(&["corners/noise", "galo-2011/corners", "galo-2011/distinct", "zhu-2007/bias"]);
    let folder = project.path();
    // They hold for all trials.
    std::fs::write(folder.join("reference/baselines/ceilings.toml"), "").unwrap();
    for command in [&["run", "--all", "-q"][..], &["bless", "--yes", "-q"]] {
        let output = run(folder, command);
        assert!(output.status.success(), "{}", stderr(&output));
    }
    holds(&run(folder, &["check", "--strict", "--locked", "-q", "--records", "records"]));
    holds(&run(folder, &["check", "--strict", "--locked", "-q", "--against", "records", "--records", "records"]));
}

/// Rows that are well formed, and contradict others, the folder or the run.
#[test]
fn rows_that_do_not_belong_are_refused_by_gate_and_report() {
    let scenario = "galo-2011/corners";
    let project = copy_of(&["galo-2011/corners", "galo-2011/distinct"]);
    assert!(run(project.path(), &["run", scenario, "galo-2011/distinct-points", "-q"]).status.success());
    let records = project.path().join("records").join(scenario).join("records.csv.gz");
    let text = table(&records);
    let last = text.lines().last().unwrap();
    let other = table(&project.path().join("records/galo-2011/distinct-points/records.csv.gz"));
    let check = || run(project.path(), &["check", scenario, "-q", "--strict", "--records", "records"]);
    holds(&check());
    for (changed, expected) in [
        (format!("{text}{last}\n"), "says twice what it made of"),
        (format!("{text}{}\n", other.lines().last().unwrap()), "column `scenario` holds `galo-2011/distinct-points`"),
        (other.clone(), "holds records of `galo-2011/distinct-points`, expected those of `galo-2011/corners`"),
        (text.replace(",px,", ",mm,"), "column `unit` holds `mm`, expected `px`"),
    ] {
        put_table(&records, &changed);
        for output in [check(), run(project.path(), &["report", "galo-2011", "-q"])] {
            assert_eq!(output.status.code(), Some(2), "{expected}: {}", stdout(&output));
            assert!(stderr(&output).contains(expected), "{expected}: {}", stderr(&output));
        }
    }
}

fn bless(folder: &Path, scenario: &str) -> std::process::Child {
    program(folder).args(["bless", scenario, "--yes", "-q"]).spawn().unwrap()
}

/// One lock: whoever comes second waits, and nothing of the first is lost.
#[test]
fn two_that_bless_at_once_leave_what_a_check_accepts() {
    let names = ["corners/noise", "galo-2011/corners", "galo-2011/corners-drawn"];
    let project = copy_of(&names);
    for round in 0..5 {
        for name in names {
            let path = project.path().join("scenarios").join(name).with_extension("toml");
            let text = std::fs::read_to_string(&path).unwrap();
            std::fs::write(&path, format!("{text}# round {round}\n")).unwrap();
        }
        let all: Vec<_> = names.iter().map(|name| bless(project.path(), name)).collect();
        for mut one in all {
            assert!(one.wait().unwrap().success(), "round {round}");
        }
        let output = run(project.path(), &[&["check", "-q", "--strict", "--locked"], &names[..]].concat());
        holds(&output);
    }
}
