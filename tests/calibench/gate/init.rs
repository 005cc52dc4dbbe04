//! A project elsewhere: five commands from an empty folder.

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
