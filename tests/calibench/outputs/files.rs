//! Commands that write a file.

use std::fs;
use std::io::Read;
use std::path::Path;

use super::{Writer, good, refused, same, without_space, workshop};
use crate::calibrate::WALL;
use crate::project::{files, run, stderr};

/// A command, the ending of its file, and a file that it reads.
struct FileWriter {
    writer: Writer,
    ending: &'static str,
    /// What it reads, if anything.
    input: Option<&'static str>,
}

fn writers() -> Vec<FileWriter> {
    let new =
        |command: &[&'static str], option, ending, input| FileWriter { writer: Writer::new(command, option), ending, input: Some(input) };
    let points = ["--points", "points.csv"];
    let camera = ["--camera", "wall/camera.toml"];
    let pair = [&["orient", "-q", "--left", "s01-r1.png", "--right", "s04-r1.png"][..], &points, &camera].concat();
    vec![
        new(&["show", "mine.toml"], "-o", "png", "mine.toml"),
        new(&["plot", "sweep.toml"], "-o", "png", "records/local/sweep/scenario.toml"),
        new(&["speed", "mine.toml", "-q", "--rounds", "3"], "-o", "csv", "mine.toml"),
        new(&["measure", "wall/s01-r1.png", "-q", "--points", "starts.csv", "-m", "pixel"], "-o", "csv", "wall/s01-r1.png"),
        new(&["measure", "wall/s01-r1.png", "-q", "--points", "starts.csv", "-m", "pixel"], "--output", "csv", "starts.csv"),
        new(&["detect", "board/s01-r1.png", "-q", "--chessboard", "9x6"], "-o", "csv", "board/s01-r1.png"),
        new(&["detect", "field/s01.png", "-q", "--testfield", "field.toml"], "-o", "csv", "field/s01.png"),
        new(&["detect", "field/s01.png", "-q", "--testfield", "field.toml"], "-o", "csv", "field.toml"),
        new(&WALL, "-o", "toml", "points.csv"),
        new(&[&WALL[..], &["--start", "wall/camera.toml"]].concat(), "-o", "toml", "wall/camera.toml"),
        new(&[&["resect", "-q", "--control", "control.csv"][..], &points, &camera].concat(), "-o", "csv", "control.csv"),
        new(&[&["intersect", "-q", "--stations", "wall/stations.csv"][..], &points, &camera].concat(), "-o", "csv", "wall/camera.toml"),
        new(&pair, "-o", "csv", "points.csv"),
        new(&[&pair[..], &["-o", "model.csv"]].concat(), "--poses", "csv", "points.csv"),
        new(&["convert", "wall/camera.toml", "-q", "--to", "photogrammetric"], "-o", "toml", "wall/camera.toml"),
        new(&["convert", "wall/camera.toml", "-q", "--to", "photogrammetric"], "--plot", "png", "wall/camera.toml"),
        new(&["diff", "wall/camera.toml", "found.toml"], "--plot", "png", "found.toml"),
        new(&["accept", "--lengths", "lengths.csv", "--limit", "0.03"], "--plot", "png", "lengths.csv"),
        new(&["stmap", "found.toml"], "-o", "exr", "found.toml"),
        new(&["stmap", "found.toml", "--redistort", "--overscan", "auto"], "-o", "tif", "found.toml"),
        new(&["stmap", "found.toml"], "-o", "png", "found.toml"),
        FileWriter { writer: Writer::new(&["control", "9x6:25"], "-o"), ending: "csv", input: None },
    ]
}

#[test]
fn a_file_of_ones_own_is_replaced_and_nothing_else_is() {
    let folder = workshop();
    let at = |name: &str| folder.path().join(name);
    for FileWriter { writer, ending, input } in writers() {
        let name = format!("out.{ending}");
        let arguments = writer.to(&name);
        good(folder.path(), &arguments);
        let names = |path: &Path| files(path).into_iter().map(|(path, _)| path).collect::<Vec<_>>();
        let before = names(folder.path());
        good(folder.path(), &arguments);
        assert_eq!(names(folder.path()), before, "{arguments:?}: something else was left or is gone");
        // A photograph by another name, a write-protected file, an input by another name, a folder, a folder that is not there.
        fs::write(at(&name), b"\xff\xd8\xff\xe1 a photograph").unwrap();
        refused(folder.path(), &arguments, &[&name, "is an image that calibench did not write"]);
        fs::write(at(&name), "old").unwrap();
        protect(&at(&name), true);
        refused(folder.path(), &arguments, &[&name, "write-protected"]);
        protect(&at(&name), false);
        fs::remove_file(at(&name)).unwrap();
        if let Some(input) = input {
            fs::hard_link(at(input), at(&name)).unwrap();
            refused(folder.path(), &arguments, &[&name, "the command reads"]);
            fs::remove_file(at(&name)).unwrap();
        }
        fs::create_dir(at(&name)).unwrap();
        refused(folder.path(), &arguments, &[&name, "is a folder"]);
        fs::remove_dir(at(&name)).unwrap();
        refused(folder.path(), &writer.to(&format!("absent/{name}")), &["there is no folder absent"]);
        refused(folder.path(), &writer.to("out.docx"), &["out.docx", "ends in", &format!(".{ending}")]);
    }
}

fn protect(path: &Path, yes: bool) {
    let mut rights = fs::metadata(path).unwrap().permissions();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        rights.set_mode(if yes { 0o444 } else { 0o644 });
    }
    #[cfg(not(unix))]
    rights.set_readonly(yes);
    fs::set_permissions(path, rights).unwrap();
}

#[cfg(unix)]
#[test]
fn links_and_pipes_are_written_through() {
    let folder = workshop();
    let at = |name: &str| folder.path().join(name);
    fs::create_dir(at("elsewhere")).unwrap();
    for (index, FileWriter { writer, ending, .. }) in writers().into_iter().enumerate() {
        let (link, real) = (format!("link{index}.{ending}"), format!("elsewhere/real{index}.{ending}"));
        fs::write(at(&real), "old").unwrap();
        std::os::unix::fs::symlink(&real, at(&link)).unwrap();
        good(folder.path(), &writer.to(&link));
        assert!(at(&link).is_symlink() && fs::read(at(&real)).unwrap() != b"old", "{link}");
        let pipe = format!("pipe{index}");
        assert!(std::process::Command::new("mkfifo").arg(at(&pipe)).status().unwrap().success());
        let path = at(&pipe);
        let reader = std::thread::spawn(move || {
            let mut bytes = Vec::new();
            fs::File::open(path).and_then(|mut file| file.read_to_end(&mut bytes)).map(|_| bytes)
        });
        let before = files(&at("elsewhere"));
        good(folder.path(), &writer.to(&pipe));
        assert!(!reader.join().unwrap().unwrap().is_empty(), "{pipe}");
        assert!(std::os::unix::fs::FileTypeExt::is_fifo(&fs::symlink_metadata(at(&pipe)).unwrap().file_type()));
        same(&before, &files(&at("elsewhere")), &writer.to(&pipe));
        fs::remove_file(at(&pipe)).unwrap();
    }
}

#[cfg(unix)]
#[test]
fn without_space_the_old_file_stays_and_the_message_names_it() {
    let folder = workshop();
    for (index, FileWriter { writer, ending, .. }) in writers().into_iter().enumerate() {
        let name = format!("out{index}.{ending}");
        fs::write(folder.path().join(&name), "old").unwrap();
        // The pair's points are written before its poses.
        let arguments: Vec<&str> = writer
            .to(&name)
            .into_iter()
            .filter(|word| !["-o", "model.csv"].contains(word) || !writer.command.contains(&"model.csv"))
            .collect();
        let before = files(folder.path());
        let output = without_space(folder.path(), &arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(&name), "{arguments:?}: {}", stderr(&output));
        same(&before, &files(folder.path()), &arguments);
    }
}

#[test]
fn two_outputs_are_two_files() {
    let folder = workshop();
    let pair = ["orient", "-q", "--left", "s01-r1.png", "--right", "s04-r1.png", "--points", "points.csv", "--camera", "wall/camera.toml"];
    refused(folder.path(), &[&pair[..], &["-o", "out.csv", "--poses", "./out.csv"]].concat(), &["-o and --poses both name"]);
    // The numbers of a picture stand beside it.
    fs::write(folder.path().join("plot.csv"), b"\xff\xd8\xff\xe1 a photograph").unwrap();
    refused(folder.path(), &["plot", "sweep.toml", "-o", "plot.png"], &["plot.csv"]);
    let output = run(folder.path(), &["plot", "sweep.toml", "-o", "records/local/sweep/plot.png"]);
    assert!(
        stderr(&output).contains("records/local/sweep/plot.png: the command reads ")
            && stderr(&output).contains("records/local/sweep there"),
        "{}",
        stderr(&output)
    );
}

#[test]
fn a_picture_is_what_its_ending_says() {
    let folder = workshop();
    for (name, begins) in [("plot.svg", &b"<?xml"[..]), ("plot.pdf", b"%PDF-"), ("plot.PNG", b"\x89PNG")] {
        let output = run(folder.path(), &["plot", "sweep.toml", "-o", name]);
        assert!(output.status.success(), "{}", stderr(&output));
        assert!(fs::read(folder.path().join(name)).unwrap().starts_with(begins), "{name}");
    }
    refused(folder.path(), &["plot", "sweep.toml", "-o", "plot.eps"], &["a picture ends in .png, .svg, .pdf"]);
}
