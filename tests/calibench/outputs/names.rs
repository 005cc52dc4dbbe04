//! Records of files that have the same name, and work outside of a project.

use std::fs;

use super::{good, refused};
use crate::calibrate::write;
use crate::project::{copy, files, run, stdout};
use crate::render::BOARD;

#[test]
fn records_of_two_files_of_one_name_do_not_meet() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["a", "b"] {
        fs::create_dir(folder.path().join(name)).unwrap();
    }
    write(folder.path(), "a/cam.toml", BOARD);
    write(folder.path(), "b/cam.toml", &BOARD.replace("seed = 3", "seed = 4"));
    refused(folder.path(), &["run", "-q", "a/cam.toml", "b/cam.toml"], &["a/cam.toml and b/cam.toml: both are called `local/cam`"]);
    refused(folder.path(), &["run", "-q", "a/cam.toml", "a/cam.toml"], &["a/cam.toml: asked for twice"]);
    good(folder.path(), &["run", "-q", "a/cam.toml"]);
    let records = files(&folder.path().join("records"));
    refused(folder.path(), &["run", "-q", "b/cam.toml"], &["records/local/cam: holds the records of", "a/cam.toml", "rename one"]);
    good(folder.path(), &["run", "-q", "a/cam.toml"]);
    assert!(files(&folder.path().join("records")) == records);
    // A file that was moved has the records that it had.
    fs::create_dir(folder.path().join("c")).unwrap();
    fs::rename(folder.path().join("a/cam.toml"), folder.path().join("c/cam.toml")).unwrap();
    good(folder.path(), &["run", "-q", "c/cam.toml"]);
    // A file and a scenario of the project of one name.
    let project = copy();
    fs::create_dir(project.path().join("scenarios/local")).unwrap();
    write(project.path(), "scenarios/local/cam.toml", BOARD);
    write(project.path(), "cam.toml", BOARD);
    good(project.path(), &["run", "-q", "local/cam"]);
    refused(project.path(), &["run", "-q", "cam.toml"], &["holds the records of a scenario of the project"]);
}

#[test]
fn a_file_needs_no_project() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "my.toml", BOARD);
    good(folder.path(), &["show", "my.toml"]);
    good(folder.path(), &["render", "my.toml", "-o", "images", "-q"]);
    good(folder.path(), &["print", "my.toml", "-o", "sheets"]);
    good(folder.path(), &["run", "my.toml", "-q"]);
    good(folder.path(), &["report", "-q"]);
    let page = fs::read_to_string(folder.path().join("reports/local/README.md")).unwrap();
    assert!(page.contains("Scenario `local/my`"), "{page}");
    assert!(fs::read_to_string(folder.path().join("reports/README.md")).unwrap().contains("local/README.md"));
    // A name is that of a scenario of a project.
    refused(folder.path(), &["run", "my"], &["my: ", "--root DIR", "TOML file"]);
    refused(folder.path(), &["run", "your.toml"], &["your.toml"]);
    let output = run(folder.path(), &["schema"]);
    assert!(output.status.success() && stdout(&output).starts_with('{'));
}

#[test]
fn the_files_own_random_numbers_do_not_depend_on_where_it_lies() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("sub")).unwrap();
    write(folder.path(), "my.toml", BOARD);
    write(folder.path(), "sub/my.toml", BOARD);
    good(folder.path(), &["render", "my.toml", "-o", "one", "-q"]);
    good(folder.path(), &["render", "sub/my.toml", "-o", "two", "-q"]);
    assert!(files(&folder.path().join("one")) == files(&folder.path().join("two")));
}
