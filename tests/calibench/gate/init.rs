//! A project elsewhere: five commands from an empty folder.

use std::path::Path;
use std::process::{Command, Output};

use crate::project::{run, stderr, stdout};

#[test]
fn five_commands_make_a_gate() {
    let empty = tempfile::tempdir().unwrap();
    let output = run(empty.path(), &["init", "mine", "-q"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let mine = empty.path().join("mine");
    for file in [
        "scenarios/first/corners.toml",
        "scenarios/scenario.schema.json",
        "reference/baselines/first--corners.csv",
        "reference/baselines/blessed.toml",
    ] {
        assert!(mine.join(file).is_file(), "{file}");
    }
    let output = run(&mine, &["check", "--strict", "--locked", "-q"]);
    assert!(output.status.success() && stdout(&output).contains("1 methods, 80 points"), "{}{}", stdout(&output), stderr(&output));
    let path = mine.join("scenarios/first/corners.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, text.replace("grey_noise = 0.02", "grey_noise = 0.0206")).unwrap();
    let output = run(&mine, &["check", "-q"]);
    assert_eq!(output.status.code(), Some(1), "3 % more noise: {}", stdout(&output));
    assert!(run(&mine, &["bless", "--yes", "-q"]).status.success());
    assert!(run(&mine, &["check", "--strict", "--locked", "-q"]).status.success());
}

#[test]
fn a_folder_that_holds_something_is_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("photo.jpg"), "mine").unwrap();
    let output = run(folder.path(), &["init", "."]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("holds `photo.jpg`; expected a new or an empty folder"), "{}", stderr(&output));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

/// The program of `examples/own_gate.rs`, as docs/gate-elsewhere.md tells it.
fn own(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_own-gate")).current_dir(folder).env_remove("CALIBENCH_ROOT").args(arguments).output().unwrap()
}

#[test]
fn an_operator_of_ones_own_is_gated() {
    let empty = tempfile::tempdir().unwrap();
    assert!(own(empty.path(), &["init", "mine", "-q"]).status.success());
    let mine = empty.path().join("mine");
    let path = mine.join("scenarios/first/corners.toml");
    let with = |shift: &str| {
        let text = std::fs::read_to_string(&path).unwrap();
        let start = text.find("\n[[method]]\nname = \"shifted\"").unwrap_or(text.len());
        std::fs::write(&path, format!("{}\n[[method]]\nname = \"shifted\"\nshift = {shift}\n", &text[..start])).unwrap();
    };
    with("0.25");
    let output = own(&mine, &["check", "--locked", "-q"]);
    assert_eq!(output.status.code(), Some(1), "not blessed yet: {}", stdout(&output));
    assert!(own(&mine, &["bless", "--yes", "-q"]).status.success());
    let output = own(&mine, &["check", "--strict", "--locked", "-q"]);
    assert!(output.status.success() && stdout(&output).contains("2 methods, 160 points"), "{}{}", stdout(&output), stderr(&output));
    with("0.5");
    let output = own(&mine, &["check", "-q"]);
    assert_eq!(output.status.code(), Some(1), "{}", stdout(&output));
    assert!(stdout(&output).contains("shifted"), "{}", stdout(&output));
    // calibench itself has no such method.
    let output = run(&mine, &["check", "-q"]);
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    assert!(stderr(&output).contains("no method is called `shifted`"), "{}", stderr(&output));
}

/// What `init` writes for a calibrator is tried, run and gated as its README says; a program in plain Python stands in for OpenCV.
#[cfg_attr(not(python), ignore = "no python3")]
#[test]
fn a_calibrator_of_ones_own_is_gated() {
    let empty = tempfile::tempdir().unwrap();
    let made = run(empty.path(), &["init", "mine", "--calibrator", "-q"]);
    assert!(made.status.success(), "{}", stderr(&made));
    let mine = empty.path().join("mine");
    let check = || run(&mine, &["check", "--strict", "--locked", "-q"]);
    assert!(check().status.success(), "{}", stdout(&check()));
    let program = mine.join("methods/mine.py");
    let text = std::fs::read_to_string(&program).unwrap();
    let (head, rest) = text.split_once("def calibrate(task):").unwrap();
    let (_, rest) = rest.split_once("\n\n\n").unwrap();
    let (protocol, rest) = rest.split_once("try:\n    import cv2").unwrap();
    let (_, rest) = rest.split_once("say({\"version\": cv2.__version__})").unwrap();
    let with = |f: f64| {
        let own = format!(
            "def calibrate(task):\n    matrix = [{f}, 0, 645.5, 0, {f}, 483.5, 0, 0, 1]\n    \
             return {{\"status\": \"calibrated\", \"camera\": CAMERA.format(size=task[\"size\"], matrix=matrix, count=5, distortion=[0.0] * 5)}}\n\n\n"
        );
        std::fs::write(&program, format!("{head}{own}{protocol}say({{\"version\": \"1\"}}){rest}")).unwrap();
    };
    with(920.0);
    let path = mine.join("scenarios/first/board.toml");
    let scenario = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, scenario.replace("# [[calibrator]]\n# name", "[[calibrator]]\nname")).unwrap();
    assert_eq!(check().status.code(), Some(1), "not blessed yet: {}", stdout(&check()));
    let blessed = run(&mine, &["bless", "--yes", "-q"]);
    assert!(blessed.status.success() && check().status.success(), "{}{}", stderr(&blessed), stdout(&check()));
    with(900.0);
    let worse = run(&mine, &["check", "-q"]);
    assert_eq!(worse.status.code(), Some(1), "{}{}", stdout(&worse), stderr(&worse));
    assert!(stdout(&worse).contains("mine frame rms"), "{}", stdout(&worse));
    std::fs::write(&program, "exit").unwrap();
    let away = run(&mine, &["run", "first/board", "-q"]);
    assert!(stderr(&away).contains("first/board: the calibrator `mine` is unavailable"), "{}", stderr(&away));
    with(900.0);
    for page in [["run", "first/board", "-q"].as_slice(), &["report", "-q"]] {
        let output = run(&mine, page);
        assert!(output.status.success(), "{page:?}: {}", stderr(&output));
    }
}
