//! What commands write and what they must leave alone: every command that has an output, outside of any project.

mod files;
mod folders;
mod names;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

use crate::calibrate::{WALL, wall, write};
use crate::project::{files, program, root, run, stderr};
use crate::render::BOARD;

/// A sweep of few cells.
const SWEEP: &str = "[sweep]\n\"optics.blur\" = [0.5, 0.7]\n";

/// A folder with what every command needs, and no project.
fn workshop() -> tempfile::TempDir {
    let folder = wall();
    let path = folder.path();
    write(path, "mine.toml", BOARD);
    write(path, "lengths.csv", &crate::accept::lengths(0.01, 0.01));
    write(path, "sweep.toml", &BOARD.replacen("[camera]", &format!("{SWEEP}[camera]"), 1));
    let root = root();
    good(path, &["--root", root.to_str().unwrap(), "render", "testfields/chessboard", "-o", "board", "-q"]);
    fs::copy(root.join("scenarios/testfields/coded.toml"), path.join("field.toml")).unwrap();
    good(path, &["render", "field.toml", "-o", "field", "-q"]);
    good(path, &["run", "sweep.toml", "-q"]);
    good(path, &[&WALL[..], &["-o", "found.toml"]].concat());
    folder
}

fn good(folder: &Path, arguments: &[&str]) -> Output {
    let output = run(folder, arguments);
    assert!(output.status.success(), "{arguments:?}: {}", stderr(&output));
    output
}

/// The command is refused with exit code 2, what is in its folder stays as it is, and the message has these words.
fn refused(folder: &Path, arguments: &[&str], words: &[&str]) {
    let before = files(folder);
    let output = run(folder, arguments);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", stderr(&output));
    for word in words {
        assert!(stderr(&output).contains(word), "{arguments:?}: expected {word}\n{}", stderr(&output));
    }
    same(&before, &files(folder), arguments);
}

fn same(before: &[(PathBuf, Vec<u8>)], after: &[(PathBuf, Vec<u8>)], arguments: &[&str]) {
    let names = |files: &[(PathBuf, Vec<u8>)]| files.iter().map(|(path, _)| path.clone()).collect::<Vec<_>>();
    assert_eq!(names(before), names(after), "{arguments:?}");
    for ((path, old), (_, new)) in before.iter().zip(after) {
        assert!(old == new, "{arguments:?} changed {}", path.display());
    }
}

/// A command, without what it writes; the option that names that.
struct Writer {
    command: Vec<&'static str>,
    option: &'static str,
}

impl Writer {
    fn new(command: &[&'static str], option: &'static str) -> Self {
        Self { command: command.to_vec(), option }
    }

    fn to<'p>(&'p self, path: &'p str) -> Vec<&'p str> {
        self.command.iter().copied().chain([self.option, path]).collect()
    }
}

/// The program with every file limited to no bytes: what a full disk does to it.
fn without_space(folder: &Path, arguments: &[&str]) -> Output {
    let program = program(folder);
    let limited = "trap '' XFSZ; ulimit -f 0; exec \"$@\"";
    let mut shell = std::process::Command::new("sh");
    shell.args(["-c", limited, "sh"]).arg(program.get_program()).args(arguments).current_dir(folder);
    for (name, value) in program.get_envs() {
        match value {
            Some(value) => shell.env(name, value),
            None => shell.env_remove(name),
        };
    }
    shell.output().expect("a shell")
}
