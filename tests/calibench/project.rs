//! The project under test: its folder, a copy of it to write in, and the program.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The project's own folder.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("tests/ lies in the project").to_owned()
}

/// Families of scenarios whose run takes long: only tests of their own copy them.
const LARGE: [&str; 4] = ["operators", "testfields", "sweeps", "atlas"];

/// A temporary project with the real scenarios and references, but for the large ones, and no records or reports.
pub fn copy() -> tempfile::TempDir {
    copy_with(&[])
}

/// As [`copy`], with some of the large families.
pub fn copy_with(families: &[&str]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for part in ["scenarios", "reference"] {
        copy_folder(&root().join(part), &folder.path().join(part));
    }
    for family in LARGE.iter().filter(|family| !families.contains(family)) {
        std::fs::remove_dir_all(folder.path().join("scenarios").join(family)).ok();
        let baselines =
            std::fs::read_dir(folder.path().join("reference/baselines")).expect("baselines").map(|entry| entry.expect("a file"));
        let of_family = baselines.filter(|file| file.file_name().to_string_lossy().starts_with(&format!("{family}--")));
        of_family.for_each(|file| std::fs::remove_file(file.path()).expect("a baseline"));
    }
    if !families.contains(&NETWORKS) {
        remove_networks(folder.path());
    }
    list_baselines(folder.path());
    folder
}

/// Takes out of the list of blessed files those that are not there.
fn list_baselines(project: &Path) {
    let folder = project.join("reference/baselines");
    let list = folder.join("blessed.toml");
    let Ok(text) = std::fs::read_to_string(&list) else { return };
    let file = |line: &str| line.strip_prefix('"').and_then(|rest| rest.split('"').next()).map(|name| folder.join(name));
    let kept: String = text.lines().filter(|line| file(line).is_none_or(|path| path.is_file())).map(|line| format!("{line}\n")).collect();
    std::fs::write(list, kept).expect("the list of blessed files");
}

/// The scenarios of `galo-2011` that adjust every trial: hundreds of trials each.
pub const NETWORKS: &str = "galo-2011/network";

fn remove_networks(project: &Path) {
    for (folder, start) in [("scenarios/galo-2011", "network"), ("reference/baselines", "galo-2011--network")] {
        let files = std::fs::read_dir(project.join(folder)).expect("a folder").map(|entry| entry.expect("a file"));
        let of_networks = files.filter(|file| file.file_name().to_string_lossy().starts_with(start));
        of_networks.for_each(|file| std::fs::remove_file(file.path()).expect("a file"));
    }
}

fn copy_folder(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).expect("a folder");
    for entry in std::fs::read_dir(from).expect("a folder") {
        let path = entry.expect("an entry").path();
        let target = to.join(path.file_name().expect("a name"));
        if path.is_dir() { copy_folder(&path, &target) } else { std::fs::copy(&path, &target).map(|_| ()).expect("a copy") }
    }
}

/// The program, to be run in `folder`. Photographs are found as the tests find them.
pub fn program(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_calibench-under-test"));
    command.current_dir(folder).env_remove("CALIBENCH_ROOT");
    let data = std::env::var_os("CALIBENCH_DATA").map_or_else(|| root().join("../shared/data"), PathBuf::from);
    command.env("CALIBENCH_DATA", data);
    command
}

/// Runs the program with `arguments` in `folder`.
pub fn run(folder: &Path, arguments: &[&str]) -> Output {
    program(folder).args(arguments).output().expect("the program starts")
}

/// What the program wrote to standard output.
pub fn stdout(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// What the program wrote to standard error.
pub fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// All files below `folder` with their contents, by path.
pub fn files(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in std::fs::read_dir(&next).into_iter().flatten() {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else {
                let content = std::fs::read(&path).expect("a file");
                found.push((path.strip_prefix(folder).expect("below").to_owned(), content));
            }
        }
    }
    found.sort();
    found
}

/// A compressed table of records as plain CSV.
pub fn table(path: &Path) -> String {
    std::io::read_to_string(calibench_records::stored::open(path).expect("a table")).expect("CSV")
}

/// Puts plain CSV in the place of a compressed table.
pub fn put_table(path: &Path, text: &str) {
    let mut file = calibench_records::stored::Compressor::new(std::fs::File::create(path).expect("a file"));
    std::io::Write::write_all(&mut file, text.as_bytes()).expect("room");
    file.finish().expect("room");
}
