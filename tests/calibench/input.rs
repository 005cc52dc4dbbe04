//! Bad and boundless input: an answer in time, a word about the place, and exit code 2.

use std::path::Path;
use std::process::{Output, Stdio};
use std::time::{Duration, Instant};

use crate::calibrate::{wall, write};
use crate::project::{copy, files, program, put_table, run, stderr, table};

/// A command that takes longer hangs.
const HANGS: Duration = Duration::from_mins(1);

/// As [`run`], but stopped with a panic when it hangs.
fn in_time(folder: &Path, arguments: &[&str]) -> Output {
    let mut child = program(folder).args(arguments).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    let started = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if started.elapsed() > HANGS {
            child.kill().unwrap();
            panic!("{arguments:?} hangs");
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    child.wait_with_output().unwrap()
}

/// One cell of a row, replaced.
fn with_cell(text: &str, line: usize, column: usize, value: &str) -> String {
    let of_line = |(index, row): (usize, &str)| {
        let mut cells: Vec<&str> = row.split(',').collect();
        if index == line {
            cells[column] = value;
        }
        cells.join(",") + "\n"
    };
    text.lines().enumerate().map(of_line).collect()
}

#[test]
fn coordinates_beyond_all_bounds_are_answered() {
    let folder = wall();
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    let (points, control, stations, starts) = (read("points.csv"), read("control.csv"), read("wall/stations.csv"), read("starts.csv"));
    let camera = ["--camera", "wall/camera.toml"];
    for value in ["1e300", "-1e300", "1e154", "1e18", "4294967296"] {
        write(folder.path(), "far-points.csv", &with_cell(&points, 3, 2, value));
        write(folder.path(), "far-control.csv", &with_cell(&control, 3, 1, value));
        write(folder.path(), "far-stations.csv", &with_cell(&stations, 1, 2, value));
        write(folder.path(), "far-starts.csv", &with_cell(&starts, 3, 3, value));
        let calibrate = ["calibrate", "--size", "1600x1200", "--report", "report", "-q"];
        for arguments in [
            vec!["measure", "wall/s01-r1.png", "--points", "far-starts.csv", "-o", "out.csv"],
            [&calibrate[..], &["--points", "far-points.csv", "--control", "control.csv"]].concat(),
            [&calibrate[..], &["--points", "points.csv", "--control", "far-control.csv"]].concat(),
            [&["resect", "--points", "far-points.csv", "--control", "control.csv", "-o", "out.csv"], &camera[..]].concat(),
            [&["resect", "--points", "points.csv", "--control", "far-control.csv", "-o", "out.csv"], &camera[..]].concat(),
            [&["intersect", "--points", "far-points.csv", "--stations", "wall/stations.csv", "-o", "out.csv"], &camera[..]].concat(),
            [&["intersect", "--points", "points.csv", "--stations", "far-stations.csv", "-o", "out.csv"], &camera[..]].concat(),
            [&["orient", "--points", "far-points.csv", "--left", "s01-r1.png", "--right", "s04-r1.png"], &camera[..]].concat(),
        ] {
            let output = in_time(folder.path(), &arguments);
            assert!(matches!(output.status.code(), Some(0 | 2)), "{value}, {arguments:?}: {}", stderr(&output));
            assert!(output.status.success() || stderr(&output).contains("error: "), "{arguments:?}: {}", stderr(&output));
        }
    }
}

#[test]
fn a_large_board_is_shown_in_time() {
    let folder = crate::render::with_board("columns = 5", "columns = 1000");
    let text = std::fs::read_to_string(folder.path().join("mine.toml")).unwrap();
    write(folder.path(), "mine.toml", &text.replace("rows = 4", "rows = 1000").replace("square = 25", "square = 0.2"));
    let output = in_time(folder.path(), &["show", "mine.toml", "-o", "board.png"]);
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(calibench_images::read_photo(&folder.path().join("board.png")).is_ok());
}

#[test]
fn what_is_missing_of_a_project_is_named() {
    let project = copy();
    assert!(run(project.path(), &["run", "corners/noise", "--trials", "2", "-q"]).status.success());
    for (missing, arguments) in [
        ("reference/baselines", vec!["check", "corners/noise"]),
        ("reference/cameras", vec!["report", "conventions"]),
        ("reference", vec!["check"]),
    ] {
        std::fs::remove_dir_all(project.path().join(missing)).unwrap();
        let output = in_time(project.path(), &arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(missing), "{arguments:?}: {}", stderr(&output));
    }
}

/// A disk that is full after some kilobytes, as the system's limit on files plays it.
#[cfg(unix)]
#[test]
fn a_full_disk_is_named_and_nothing_half_written_stays() {
    let project = crate::render::with_board("seed = 3", "seed = 4");
    let full = |arguments: &[&str]| {
        let binary = program(project.path()).get_program().to_owned();
        let mut shell = std::process::Command::new("sh");
        shell.current_dir(project.path()).args(["-c", "trap '' XFSZ; ulimit -f 8; exec \"$0\" \"$@\""]).arg(binary).args(arguments);
        // What is kept for later runs is whole, and may stay.
        shell.env("CALIBENCH_STORE", "").output().unwrap()
    };
    let before = files(project.path());
    for (arguments, path) in [
        (&["render", "mine.toml", "-o", "rendered"][..], "rendered"),
        (&["run", "mine.toml"], "records"),
        (&["show", "mine.toml", "-o", "preview.png"], "preview.png"),
    ] {
        let output = full(arguments);
        let words = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {words}");
        assert!(words.contains(path) && words.contains("File too large"), "{arguments:?}: {words}");
        assert!(!words.contains(".calibench-"), "a temporary file is named: {words}");
        let mut after = files(project.path());
        after.retain(|file| !before.contains(file));
        assert!(after.is_empty(), "{arguments:?} leaves {:?}", after.iter().map(|(path, _)| path).collect::<Vec<_>>());
    }
}

#[test]
fn names_command_neither_the_terminal_nor_a_spreadsheet() {
    let folder = tempfile::tempdir().unwrap();
    let hostile = "a\u{1b}[2J.png";
    write(folder.path(), "p.csv", &format!("image,target,x,y\n{hostile},=1+2,3,4\n{hostile},=1+2,3,4\n"));
    let output = run(folder.path(), &["measure", "x.png", "--points", "p.csv"]);
    assert_eq!(output.status.code(), Some(2));
    let words = stderr(&output);
    assert!(words.contains("p.csv:3") && words.contains("a\\u{1b}[2J.png") && !words.contains('\u{1b}'), "{words}");
    calibench_images::write_png(&folder.path().join("a.png"), &calibench_model::Image::from_fn(40, 40, |x, _| (x % 2) as f32), false)
        .unwrap();
    write(folder.path(), "p.csv", "image,target,x,y\na.png,=1+2,20,20\n");
    let output = run(folder.path(), &["measure", "a.png", "--points", "p.csv", "-o", "out.csv"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let text = std::fs::read_to_string(folder.path().join("out.csv")).unwrap();
    assert!(text.contains("a.png,'=1+2,"), "{text}");
    let again = calibench_exchange::read_points(&folder.path().join("out.csv")).unwrap();
    let names = again.points.rows().map(|row| row.target.to_owned()).chain(again.lost.iter().map(|row| row[1].to_owned()));
    assert_eq!(names.collect::<Vec<_>>(), ["=1+2"]);
}

#[test]
fn records_that_mean_nothing_are_refused_with_their_line() {
    let project = copy();
    assert!(run(project.path(), &["run", "corners/noise", "--trials", "2", "-q"]).status.success());
    let path = project.path().join("records/corners/noise/records.csv.gz");
    let good = table(&path);
    let row = good.lines().position(|line| line.contains(",measured,")).unwrap();
    for (text, expected) in [
        (with_cell(&good, row, 6, "1e999"), "column `x` holds `1e999`"),
        (with_cell(&with_cell(&good, row, 4, ""), row, 13, "unavailable"), "a row without a method"),
    ] {
        put_table(&path, &text);
        let output = in_time(project.path(), &["report", "corners"]);
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
        let words = stderr(&output);
        assert!(words.contains("records.csv") && words.contains(&format!("line {}", row + 1)) && words.contains(expected), "{words}");
    }
}
