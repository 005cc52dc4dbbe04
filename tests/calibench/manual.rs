//! Completions for shells, and manual pages.

use std::process::Command;

use crate::project::{files, run, stderr, stdout};

#[test]
fn every_shell_completes_what_the_help_shows() {
    let folder = tempfile::tempdir().unwrap();
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let script = stdout(&run(folder.path(), &["completions", shell]));
        assert!(script.contains("calibrate") && script.contains("board-shape") && !script.contains("confined"), "{shell}");
        if shell == "bash" {
            std::fs::write(folder.path().join("complete.bash"), script).unwrap();
        }
    }
    let completed = |words: &[&str]| {
        let line = format!(
            "source complete.bash; COMP_WORDS=({}); COMP_CWORD={}; _calibench calibench '{}' '{}'; printf '%s\\n' \"${{COMPREPLY[@]}}\"",
            words.join(" "),
            words.len() - 1,
            words[words.len() - 1],
            words[words.len() - 2]
        );
        let done = Command::new("bash").args(["-c", &line]).current_dir(folder.path()).output().unwrap();
        String::from_utf8(done.stdout).unwrap().lines().map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(completed(&["calibench", "cali"]), ["calibrate"]);
    assert_eq!(completed(&["calibench", "calibrate", "--board-s"]), ["--board-scale", "--board-shape"]);
    assert_eq!(completed(&["calibench", "convert", "--to", "kal"]), ["kalibr"]);
    assert!(completed(&["calibench", "measure", "-m", "parametric_c"]).contains(&"parametric_corner".to_owned()));
    assert!(completed(&["calibench", "schema", "j"]).contains(&"judge".to_owned()));
}

#[test]
fn every_command_has_a_manual_page() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let made = run(here, &["man", "-o", "one"]);
    assert!(made.status.success(), "{}", stderr(&made));
    assert!(run(here, &["man", "-o", "two", "--threads", "1"]).status.success());
    let pages = files(&here.join("one"));
    assert!(pages == files(&here.join("two")), "the same bytes");
    let help = stdout(&run(here, &["--help"]));
    let commands = help.split("\nOptions:\n").next().unwrap().lines().skip(1);
    let names: Vec<&str> = commands.filter_map(|line| line.strip_prefix("  ")?.split(' ').next()).filter(|name| !name.is_empty()).collect();
    assert!(names.len() > 25 && names.contains(&"help"), "{help}");
    for name in names.into_iter().filter(|name| *name != "help") {
        let page = std::fs::read_to_string(here.join(format!("one/calibench-{name}.1"))).unwrap();
        assert!(page.contains(".TH") && page.contains(".SH SYNOPSIS") && page.contains("Examples:"), "{name}: {page}");
    }
    assert!(here.join("one/calibench.1").is_file() && here.join("one/calibench-plugin-test.1").is_file());
    // A folder of the user's own is never replaced.
    std::fs::create_dir(here.join("own")).unwrap();
    std::fs::write(here.join("own/letter.txt"), "mine").unwrap();
    assert_eq!(run(here, &["man", "-o", "own"]).status.code(), Some(2));
}
