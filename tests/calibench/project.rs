//! The project under test: its folder, a copy of it to write in, and the program.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The project's own folder.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("tests/ lies in the project").to_owned()
}

/// The scenarios of `galo-2011` that adjust every trial: hundreds of trials each.
const NETWORKS: &str = "galo-2011/network";

/// Scenarios whose run takes long, by what their names begin with: only tests of their own copy them.
const LONG: [&str; 13] = [
    "atlas/",
    "canon-t3/",
    "league/",
    NETWORKS,
    "networks/",
    "operators/",
    "sweeps/",
    "targets/budget",
    "targets/by-",
    "targets/detectors",
    "tasks/",
    "testfields/",
    "vosselman-1988/",
];

/// A temporary project with the real scenarios and references, but for the long ones, and no records or reports.
pub fn copy() -> tempfile::TempDir {
    copy_with(&[])
}

/// As [`copy`], with the long scenarios whose names begin with one of `wanted`.
pub fn copy_with(wanted: &[&str]) -> tempfile::TempDir {
    without(|name| begins(name, &LONG) && !begins(name, wanted))
}

/// A temporary project with the real references and the scenarios whose names begin with one of `wanted`.
pub fn copy_of(wanted: &[&str]) -> tempfile::TempDir {
    without(|name| !begins(name, wanted))
}

fn begins(name: &str, starts: &[&str]) -> bool {
    starts.iter().any(|start| name.starts_with(start))
}

fn without(is_left_out: impl Fn(&str) -> bool) -> tempfile::TempDir {
    let folder = whole();
    for family in entries(&folder.path().join("scenarios")).into_iter().filter(|path| path.is_dir()) {
        remove(&family, |file| is_left_out(&format!("{}/{file}", name_of(&family))));
        // Fails where something is left.
        std::fs::remove_dir(&family).ok();
    }
    let of = |file: &str| Some(file.replacen("--", "/", 1)).filter(|name| name != file);
    remove(&folder.path().join("reference/baselines"), |file| of(file).is_some_and(|name| is_left_out(&name)));
    list_baselines(folder.path());
    folder
}

/// A temporary project with all scenarios and references, of each scenario `most` trials at most.
pub fn copy_of_all(most: u64) -> tempfile::TempDir {
    let folder = whole();
    let few = |line: &str| {
        let trials = line.strip_prefix("trials = ").and_then(|number| number.parse::<u64>().ok());
        trials.is_some_and(|trials| trials > most).then(|| format!("trials = {most}"))
    };
    edit_scenarios(folder.path(), few);
    folder
}

/// Takes out what is checked by night.
pub fn leave_nightly(project: &Path) {
    for (path, bytes) in files(&project.join("scenarios")) {
        if String::from_utf8_lossy(&bytes).lines().any(|line| line == "nightly = true") {
            std::fs::remove_file(project.join("scenarios").join(path)).expect("a scenario");
        }
    }
}

/// Leaves of each sweep's numbers, and of its lists of numbers, the first and the last; of what is swept by name, as boards, all.
pub fn keep_ends_of_sweeps(project: &Path) {
    edit_scenarios(project, |line| {
        let (key, list) = line.strip_prefix('"')?.split_once("\" = ")?;
        let table: toml::Table = toml::from_str(&format!("list = {list}")).ok()?;
        let values = table.get("list")?.as_array()?;
        let numbers = values.len() > 2 && values.iter().all(|value| !value.is_str() && !value.is_bool());
        numbers.then(|| format!("\"{key}\" = [{}, {}]", values[0], values[values.len() - 1]))
    });
}

/// Puts what `edited` makes of a line of a scenario in its place, if anything.
fn edit_scenarios(project: &Path, edited: impl Fn(&str) -> Option<String>) {
    let folder = project.join("scenarios");
    for (path, bytes) in files(&folder).into_iter().filter(|(path, _)| path.extension().is_some_and(|e| e == "toml")) {
        let text = String::from_utf8(bytes).expect("UTF-8");
        let line = |line: &str| format!("{}\n", edited(line).unwrap_or_else(|| line.to_owned()));
        std::fs::write(folder.join(path), text.lines().map(line).collect::<String>()).expect("a scenario");
    }
}

fn whole() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for part in ["scenarios", "reference"] {
        copy_folder(&root().join(part), &folder.path().join(part));
    }
    folder
}

fn entries(folder: &Path) -> Vec<PathBuf> {
    std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()).collect()
}

fn name_of(path: &Path) -> String {
    path.file_name().expect("a name").to_string_lossy().into_owned()
}

fn remove(folder: &Path, chosen: impl Fn(&str) -> bool) {
    for path in entries(folder).into_iter().filter(|path| path.is_file() && chosen(&name_of(path))) {
        std::fs::remove_file(path).expect("a file");
    }
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

fn copy_folder(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).expect("a folder");
    for path in entries(from) {
        let target = to.join(name_of(&path));
        if path.is_dir() { copy_folder(&path, &target) } else { std::fs::copy(&path, &target).map(|_| ()).expect("a copy") }
    }
}

/// What others made, that stays out of the repository: `CALIBENCH_DATA`, or `shared/data` beside the checkout.
pub fn data() -> PathBuf {
    std::env::var_os("CALIBENCH_DATA").map_or_else(|| root().join("../shared/data"), PathBuf::from)
}

/// A number of an answer.
pub fn number(value: &serde_json::Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value}"))
}

/// A folder with some files of an example.
pub fn example(name: &str, files: &[&str]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for file in files {
        std::fs::copy(root().join("examples").join(name).join(file), folder.path().join(file)).expect("a file of the example");
    }
    folder
}

/// The program, to be run in `folder`. Photographs are found as the tests find them.
pub fn program(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_calibench-under-test"));
    command.current_dir(folder).env_remove("CALIBENCH_ROOT");
    command.env("CALIBENCH_DATA", data());
    // One store for all tests and for the gate: of scenarios that several copy each is computed once.
    command.env("CALIBENCH_STORE", root().join("target/store"));
    command
}

/// As [`program`], with nothing that was computed before.
pub fn fresh(folder: &Path) -> Command {
    let mut command = program(folder);
    command.env("CALIBENCH_STORE", "");
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
    let mut file = calibench_records::compressor::Compressor::new(std::fs::File::create(path).expect("a file"));
    std::io::Write::write_all(&mut file, text.as_bytes()).expect("room");
    file.finish().expect("room");
}

/// The bytes of a file without what a manifest says of the command and the project that wrote it.
pub fn contents(path: &Path, bytes: &[u8]) -> Vec<u8> {
    if path.file_name().is_none_or(|name| name != ".calibench-manifest") {
        return bytes.to_vec();
    }
    let says = |line: &&[u8]| !line.starts_with(b"# command: ") && !line.starts_with(b"# project: ");
    bytes.split_inclusive(|byte| *byte == b'\n').filter(says).flatten().copied().collect()
}
