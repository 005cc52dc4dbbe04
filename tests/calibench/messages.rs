//! What the program says, to the letter: bad input of every command, and what commands say of themselves.

use std::fmt::Write;
use std::path::Path;

use crate::calibrate::write;
use crate::project::{run, stderr, stdout};

/// A folder with files that are wrong in one way each.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str, text: &str| write(folder.path(), name, text);
    at("points.csv", "image,target,x,y\na.png,1,10,20\na.png,1,11,21\n");
    at("letters.csv", "image,target,x,y\na.png,1,ten,20\n");
    at("columns.csv", "image,point,x,y\na.png,1,10,20\n");
    at("control.csv", "target,X,Y,Z\n1,0,0\n");
    at("stations.csv", "image,X0,Y0,Z0\na.png,0,0,0\n");
    at("empty.csv", "");
    at("camera.toml", "convention = \"photogrammetric\"\n[camera]\nc = -5\n");
    at("unknown.cam", "nothing that is a camera\n");
    at("photo.png", "no picture");
    at("scenario.toml", "why = \"x\"\nsource = \"y\"\nseed = 1\n\n[scene]\nwidht = 100\n");
    folder
}

fn said(folder: &Path, commands: &[&[&str]]) -> String {
    let mut text = String::new();
    for arguments in commands {
        let output = run(folder, arguments);
        let code = output.status.code().unwrap();
        let place = folder.canonicalize().unwrap().display().to_string();
        let said = format!("{}{}", stdout(&output), stderr(&output)).replace(&place, "HERE").replace(&folder.display().to_string(), "HERE");
        writeln!(text, "$ calibench {}\n{}[{code}]\n", arguments.join(" "), said).unwrap();
    }
    text
}

#[test]
fn bad_input_is_told_to_the_letter() {
    let folder = folder();
    insta::assert_snapshot!(said(
        folder.path(),
        &[
            &["convert", "absent.xml", "--to", "opencv"],
            &["convert", "unknown.cam", "--to", "opencv"],
            &["convert", "camera.toml", "--to", "opencvv"],
            &["camera", "camera.toml"],
            &["diff", "camera.toml", "absent.toml"],
            &["measure", "photo.png", "--points", "points.csv", "-m", "forstner"],
            &["measure", "photo.png", "--points", "letters.csv", "-m", "forstner"],
            &["measure", "photo.png", "--points", "points.csv", "-m", "forster"],
            &["measure", "photo.png", "--points", "points.csv", "-m", "forstner:window=10"],
            &["detect", "photo.png", "--chessboard", "9by6"],
            &["calibrate", "--points", "columns.csv", "--control", "control.csv", "--size", "100x80"],
            &["calibrate", "--points", "points.csv", "--control", "control.csv", "--size", "100x80"],
            &["calibrate", "--points", "empty.csv", "--control", "control.csv", "--size", "100"],
            &["resect", "--points", "points.csv", "--control", "control.csv", "--camera", "camera.toml"],
            &["intersect", "--points", "points.csv", "--stations", "stations.csv", "--camera", "camera.toml"],
            &["orient", "--points", "points.csv", "--left", "a.png", "--right", "b.png", "--camera", "camera.toml"],
            &["run", "scenario.toml"],
            &["run", "absent.toml"],
            &["render", "scenario.toml", "-o", "out"],
            &["print", "scenario.toml", "-o", "out"],
            &["show", "absent"],
            &["plot", "absent.toml"],
            &["records", "absent.toml"],
            &["report", "absent"],
            &["check"],
            &["bless"],
        ],
    ));
}
