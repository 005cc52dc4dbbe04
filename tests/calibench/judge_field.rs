//! `judge --control`: points of a house, by name, without a board.

use std::path::Path;

use crate::project::{files, root, run, stderr, stdout};

fn done(folder: &Path, arguments: &[&str]) -> String {
    let output = run(folder, arguments);
    assert!(output.status.success(), "{arguments:?}: {}", stderr(&output));
    stdout(&output)
}

#[test]
fn points_of_a_house_are_judged_and_the_true_camera_is_within_what_is_claimed() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    done(at, &["--root", root().to_str().unwrap(), "render", "galo-2011/network", "-o", "house", "-q"]);
    let names = files(&at.join("house")).into_iter().map(|(name, _)| name);
    let photos = names.filter(|name| name.extension().is_some_and(|ending| ending == "png"));
    let photos: Vec<String> = photos.map(|name| format!("house/{}", name.display())).collect();
    let photos: Vec<&str> = photos.iter().map(String::as_str).collect();
    let measured = |method: &str, file: &str| {
        done(at, &[&["measure", "--points", "house/starts.csv", "-q", "-m", method, "-o", file][..], &photos].concat());
    };
    measured("forstner:window=11", "forstner.csv");
    measured("parametric_junction", "junction.csv");
    let both =
        ["judge", "-q", "--points", "forstner.csv", "--points", "junction.csv", "--control", "house/control.csv", "--size", "1362x1021"];
    let models = ["--model", "opencv4:fx,fy,cx,cy", "--model", "opencv4:fx,fy,cx,cy,k1", "--splits", "4"];
    let says = done(at, &[&both[..], &models, &["--report", "page"]].concat());
    assert!(says.contains("trust `junction` with the model `opencv4:fx,fy,cx,cy,k1`"), "{says}");
    assert!(says.contains("Worse: `forstner`"), "{says}");
    let page = std::fs::read_to_string(at.join("page/README.md")).unwrap();
    assert!(
        page.contains("of the points of `house/control.csv`, in 10 photographs of 1362 x 1021 px") && !page.contains("chessboard"),
        "{page}"
    );
    // The truth is a camera file that still holds.
    let truth = ["--camera", "house/camera.toml", "--margin", "0.5"];
    let one = ["judge", "-q", "--points", "junction.csv", "--control", "house/control.csv", "--size", "1362x1021"];
    assert!(done(at, &[&one[..], &models, &truth].concat()).contains("holds"));
    let refused = |more: &[&str], says: &str| {
        let output = run(at, &[&one[..], more].concat());
        assert_eq!(output.status.code(), Some(2), "{}", stdout(&output));
        assert!(stderr(&output).contains(says), "{}", stderr(&output));
    };
    refused(&["--model", "opencv4+bent"], "--model opencv4+bent: a board that may be bent is asked for, and --control is none");
    std::fs::write(at.join("stranger.csv"), "image,target,x,y\n1.png,left/99,5,5\n").unwrap();
    refused(&["--points", "stranger.csv"], "`left/99` is none of the 36 targets of --control");
}
