//! Commands that write a folder.

use std::fs;
use std::path::Path;

use super::{Writer, good, refused, same, without_space, workshop};
use crate::calibrate::WALL;
use crate::project::{files, program, run, stderr};

fn writers() -> Vec<Writer> {
    // The board is printed on bent paper: with a flat one the verdict is in doubt.
    let judge = [
        "judge",
        "-q",
        "--chessboard",
        "9x6:25",
        "-m",
        "pixel",
        "-m",
        "parametric_corner",
        "--model",
        "opencv4:fx,fy,cx,cy",
        "--model",
        "photogrammetric+bent",
        "--splits",
        "1",
    ];
    let board: Vec<&str> =
        ["board/s01-r1.png", "board/s02-r1.png", "board/s03-r1.png", "board/s04-r1.png", "board/s05-r1.png", "board/s06-r1.png"].to_vec();
    vec![
        Writer::new(&["render", "mine.toml", "-q"], "-o"),
        Writer::new(&["print", "mine.toml"], "-o"),
        Writer::new(&WALL, "--report"),
        Writer::new(&[&judge[..], &board].concat(), "--report"),
        Writer::new(&["convert", "wall/camera.toml", "-q", "--all", "--to", "photogrammetric"], "-o"),
    ]
}

/// The page or picture that a command wrote first by name.
fn first(folder: &Path) -> std::path::PathBuf {
    files(folder).into_iter().map(|(path, _)| folder.join(path)).find(|path| !path.ends_with(".calibench-manifest")).unwrap()
}

fn keeps_what_is_not_its_own(folder: &Path, arguments: &[&str], out: &str) {
    let place = folder.join(out);
    good(folder, arguments);
    let whole = files(folder);
    good(folder, arguments);
    let same_but_speeds = files(folder);
    assert_eq!(whole.iter().map(|(path, _)| path).collect::<Vec<_>>(), same_but_speeds.iter().map(|(path, _)| path).collect::<Vec<_>>());
    // A note added later, a file corrected by hand, a folder, a write-protected file.
    fs::write(place.join("notes.txt"), "mine").unwrap();
    refused(folder, arguments, &["notes.txt", "nothing was written"]);
    fs::remove_file(place.join("notes.txt")).unwrap();
    let (page, text) = (first(&place), fs::read(first(&place)).unwrap());
    fs::write(&page, "corrected by hand").unwrap();
    refused(folder, arguments, &[page.file_name().unwrap().to_str().unwrap(), "(changed)"]);
    fs::write(&page, &text).unwrap();
    fs::create_dir(place.join("sub")).unwrap();
    refused(folder, arguments, &["sub (a folder)"]);
    fs::remove_dir(place.join("sub")).unwrap();
    good(folder, arguments);
    // A folder of photographs.
    fs::remove_dir_all(&place).unwrap();
    fs::create_dir(&place).unwrap();
    (0..20).for_each(|i| fs::write(place.join(format!("photo{i:02}.jpg")), "a photograph").unwrap());
    refused(folder, arguments, &["photo00.jpg, photo01.jpg, photo02.jpg, photo03.jpg, photo04.jpg and 15 more"]);
    fs::remove_dir_all(&place).unwrap();
}

#[test]
fn a_folder_is_replaced_only_where_all_of_it_is_calibenchs_own() {
    let folder = workshop();
    for writer in writers() {
        keeps_what_is_not_its_own(folder.path(), &writer.to("out"), "out");
        // A file stands in the folder's place.
        fs::write(folder.path().join("taken"), "mine").unwrap();
        refused(folder.path(), &writer.to("taken"), &["taken"]);
        fs::remove_file(folder.path().join("taken")).unwrap();
        refused(folder.path(), &writer.to("."), &[" .: "]);
    }
    keeps_what_is_not_its_own(folder.path(), &["run", "mine.toml", "-q"], "records/local/mine");
    good(folder.path(), &["run", "mine.toml", "-q"]);
    keeps_what_is_not_its_own(folder.path(), &["report", "-q"], "reports/local");
    // The page that lists the reports stands among others.
    good(folder.path(), &["report", "-q"]);
    fs::write(folder.path().join("reports/thesis.txt"), "mine").unwrap();
    good(folder.path(), &["report", "-q"]);
    fs::write(folder.path().join("reports/README.md"), "mine").unwrap();
    refused(folder.path(), &["report", "-q"], &["reports/README.md", "did not write it"]);
}

#[test]
fn photographs_are_not_the_folder_of_their_report() {
    let folder = workshop();
    refused(
        folder.path(),
        &["calibrate", "board/s01-r1.png", "board/s02-r1.png", "--chessboard", "9x6:25", "--report", "board"],
        &["the command reads board/s01-r1.png there"],
    );
    // Nor are the tables that it reads, though calibench wrote them.
    let arguments = [
        "calibrate",
        "--points",
        "points.csv",
        "--control",
        "wall/control.csv",
        "--size",
        "1600x1200",
        "--pitch",
        "4.5",
        "--report",
        "wall",
    ];
    refused(folder.path(), &arguments, &["the command reads wall/control.csv there"]);
    refused(
        folder.path(),
        &["render", "records/local/sweep/scenario.toml", "-o", "records/local/sweep"],
        &["the command reads records/local/sweep/scenario.toml"],
    );
}

#[cfg(unix)]
#[test]
fn a_link_in_a_folder_leads_nowhere() {
    use std::os::unix::fs::symlink;
    let folder = workshop();
    let at = |name: &str| folder.path().join(name);
    for (index, writer) in writers().into_iter().enumerate() {
        let (real, link) = (format!("real{index}"), format!("link{index}"));
        fs::create_dir(at(&real)).unwrap();
        symlink(&real, at(&link)).unwrap();
        good(folder.path(), &writer.to(&link));
        good(folder.path(), &writer.to(&link));
        assert!(at(&link).is_symlink() && files(&at(&real)).len() > 1);
        let page = first(&at(&real));
        fs::rename(&page, at("moved")).unwrap();
        symlink(at("moved"), &page).unwrap();
        refused(folder.path(), &writer.to(&real), &["(no regular file)"]);
    }
}

#[cfg(unix)]
#[test]
fn without_space_the_old_folder_stays_and_the_message_names_it() {
    let folder = workshop();
    let fails = |arguments: &[&str], name: &str| {
        let before = files(folder.path());
        let output = without_space(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(name) && !stderr(&output).contains("partial"), "{arguments:?}: {}", stderr(&output));
        same(&before, &files(folder.path()), arguments);
    };
    for (index, writer) in writers().into_iter().enumerate() {
        let out = format!("deep{index}/er/out");
        fails(&writer.to(&out), "er/out");
        assert!(!folder.path().join(format!("deep{index}")).exists(), "{out}");
        good(folder.path(), &writer.to(&out));
        fails(&writer.to(&out), "er/out");
    }
    good(folder.path(), &["run", "mine.toml", "-q"]);
    // Anew: what is up to date would be left, and needs no space.
    fails(&["run", "mine.toml", "-q", "--fresh"], "records/local/mine");
    good(folder.path(), &["report", "-q"]);
    fails(&["report", "-q"], "reports/local");
}

#[test]
fn two_commands_write_into_one_folder_side_by_side() {
    let folder = workshop();
    for round in 0..3 {
        let start = |name: &str| program(folder.path()).args(["render", "mine.toml", "-q", "-o", name]).spawn().unwrap();
        let children: Vec<_> = ["side/a", "side/b", "side/c", "side/a"].iter().map(|name| start(name)).collect();
        assert!(children.into_iter().all(|mut child| child.wait().unwrap().success()), "round {round}");
        let mut left: Vec<_> = fs::read_dir(folder.path().join("side")).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        left.sort();
        assert_eq!(left, ["a", "b", "c"], "round {round}");
    }
    assert!(files(&folder.path().join("side/a")) == files(&folder.path().join("side/b")));
    assert!(run(folder.path(), &["render", "mine.toml", "-q", "-o", "side/a"]).status.success());
}
