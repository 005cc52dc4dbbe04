//! The surroundings of a process: streams that take nothing, a current folder that is gone, inputs without end.

use std::fs::{self, File};
use std::path::Path;
use std::process::Stdio;

use crate::calibrate::write;
use crate::project::{copy_of, program, run, stderr};

/// Commands by their exit codes, in a project of `corners/noise`, which measures worse than its baseline.
const COMMANDS: [(&[&str], i32); 5] = [
    (&["run", "corners/noise", "--trials", "2"], 0),
    (&["check", "corners/noise"], 1),
    (&["run", "corners/noize"], 2),
    (&["run", "broken.toml"], 2),
    (&["bless", "corners/noise"], 2),
];

fn worse() -> tempfile::TempDir {
    let project = copy_of(&["corners/noise"]);
    let path = project.path().join("scenarios/corners/noise.toml");
    let text = fs::read_to_string(&path).unwrap();
    assert!(text.contains("grey_noise = 0.02"));
    fs::write(path, text.replacen("grey_noise = 0.02", "grey_noise = 0.04", 1)).unwrap();
    write(project.path(), "broken.toml", "why = 1\n");
    project
}

#[cfg(target_os = "linux")]
#[test]
fn a_standard_error_that_takes_nothing_changes_no_exit_code() {
    let project = worse();
    for (arguments, code) in COMMANDS {
        assert_eq!(run(project.path(), arguments).status.code(), Some(code), "{arguments:?}");
        let full = || File::options().write(true).open("/dev/full").unwrap();
        let output = program(project.path()).args(arguments).stderr(full()).stdin(Stdio::null()).output().unwrap();
        assert_eq!(output.status.code(), Some(code), "{arguments:?} with a full one");
        // A reader that has gone: each write fails.
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let output = program(project.path()).args(arguments).stderr(writer).stdin(Stdio::null()).output().unwrap();
        assert_eq!(output.status.code(), Some(code), "{arguments:?} with a broken one");
        let own = program(project.path());
        let mut shell = std::process::Command::new("sh");
        shell.envs(own.get_envs().filter_map(|(name, value)| Some((name, value?))));
        let closed = shell.args(["-c", "exec \"$0\" \"$@\" 2>&-"]).arg(own.get_program()).args(arguments);
        let output = closed.current_dir(project.path()).stdin(Stdio::null()).output().unwrap();
        assert_eq!(output.status.code(), Some(code), "{arguments:?} with a closed one");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_current_folder_that_is_gone_is_an_error() {
    for arguments in [&["list", "scenarios"][..], &["convert", "a.toml", "--to", "kalibr", "-o", "b.yaml"], &["man", "-o", "out"]] {
        let own = program(Path::new("/"));
        let folder = tempfile::tempdir().unwrap();
        let gone = folder.path().join("gone");
        fs::create_dir(&gone).unwrap();
        let mut shell = std::process::Command::new("sh");
        shell.args(["-c", "rmdir \"$PWD\" && exec \"$0\" \"$@\""]).arg(own.get_program()).args(arguments);
        let output = shell.current_dir(&gone).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", stderr(&output));
        assert!(stderr(&output).contains("the current folder: "), "{arguments:?}: {}", stderr(&output));
    }
}

/// Files of a length that no such file has, without a byte of it on the disk.
#[test]
fn what_is_larger_than_any_such_file_is_refused_before_it_is_read() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["large.csv", "large.toml", "large.yaml"] {
        File::create(folder.path().join(name)).unwrap().set_len(20 << 30).unwrap();
    }
    write(folder.path(), "wide.csv", &format!("image,target,x,y,{}\n", "z".repeat(4 << 20)));
    let camera = ["--camera", "large.yaml", "-o", "out.csv"];
    for (arguments, expected) in [
        (vec!["calibrate", "--points", "large.csv", "--control", "c.csv", "--size", "9x9"], "large.csv: is larger than 1024 MB"),
        (vec!["run", "large.toml"], "large.toml: is larger than 64 MB"),
        (vec!["convert", "large.yaml", "--to", "kalibr"], "large.yaml: is larger than 64 MB"),
        ([&["resect", "--points", "large.csv", "--control", "large.csv"], &camera[..]].concat(), "is larger than"),
        (vec!["calibrate", "--points", "wide.csv", "--control", "c.csv", "--size", "9x9"], "wide.csv: line 1 is longer than 64 kB"),
    ] {
        let output = run(folder.path(), &arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        let words = stderr(&output);
        assert!(words.contains(expected) && words.len() < 2000, "{arguments:?}: {words:.2000}");
    }
}

#[cfg(unix)]
#[test]
fn inputs_may_come_through_pipes() {
    let folder = tempfile::tempdir().unwrap();
    let fifo = |name: &str| {
        let path = folder.path().join(name);
        assert!(std::process::Command::new("mkfifo").arg(&path).status().unwrap().success());
        path
    };
    let camera = "image_width: 640\nimage_height: 480\ncamera_matrix: {rows: 3, cols: 3, data: [500, 0, 320, 0, 500, 240, 0, 0, 1]}\ndistortion_model: plumb_bob\n\
                  distortion_coefficients: {rows: 1, cols: 5, data: [0.1, 0, 0, 0, 0]}\n";
    write(folder.path(), "camera.yaml", camera);
    let whole = run(folder.path(), &["camera", "camera.yaml"]);
    assert!(whole.status.success(), "{}", stderr(&whole));
    let path = fifo("piped.yaml");
    let writer = std::thread::spawn(move || fs::write(path, camera).unwrap());
    let piped = run(folder.path(), &["camera", "piped.yaml"]);
    assert!(piped.status.success(), "{}", stderr(&piped));
    writer.join().unwrap();
    // Nobody writes: it is not waited for.
    fifo("photo.png");
    let output = run(folder.path(), &["detect", "photo.png", "--chessboard", "9x6"]);
    assert!(
        stderr(&output).contains("photo.png: is no regular file") || stderr(&output).contains("is no regular file"),
        "{}",
        stderr(&output)
    );
}

#[test]
fn a_folder_of_records_is_no_place_for_images() {
    let project = copy_of(&["corners/noise"]);
    assert!(run(project.path(), &["run", "corners/noise", "--trials", "2", "-q"]).status.success());
    let output = run(project.path(), &["render", "corners/noise", "-o", "records/corners/noise"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("was written by `calibench run`"), "{}", stderr(&output));
    assert!(project.path().join("records/corners/noise/records.csv.gz").is_file());
}
