//! `--eccentricity`: a rendered wall of large discs, near by, whose pictures' centres lie up to half a pixel from the pictures of their centres.

use std::path::Path;
use std::process::Output;

use crate::project::{run, stderr, stdout};

const SCENARIO: &str = r#"
why = "large discs near by"
source = "ours"
seed = 12
trials = 1

[camera]
size = [1600, 1200]
pitch = 4.5
c = 8.0
x0 = 0.04
y0 = -0.06
k1 = -9e-4
k2 = 4e-6
p1 = 3e-5
p2 = -2e-5

[testfield]
kind = "wall"
unit = "m"

[testfield.panels]
rows = 3
columns = 4
width = 0.8
height = 0.6
gap = 0.12
relief = 0.25
tilt = 12

[testfield.fill]
kinds = ["disc"]
size = 0.12
rows = 2
columns = 3

[stations]
kind = "convergent"
count = 4
angle = 35
distances = [3.6, 4.2]
rolls = [0, 90]

[optics]
blur = 0.7

[pointing]
sigma = 0.5
whole_pixels = true

[[method]]
name = "parametric_circle"
"#;

fn ran(folder: &Path, arguments: &[&str]) -> String {
    let output = run(folder, arguments);
    assert!(matches!(output.status.code(), Some(0 | 3)), "{arguments:?}: {}", stderr(&output));
    stdout(&output)
}

/// The wall, rendered; its discs measured into `points`, with `more` arguments.
fn measured(folder: &Path, points: &str, more: &[&str]) {
    let output = measure(folder, points, more);
    assert!(output.status.success(), "{}", stderr(&output));
}

fn measure(folder: &Path, points: &str, more: &[&str]) -> Output {
    if !folder.join("wall").exists() {
        std::fs::write(folder.join("wall.toml"), SCENARIO).unwrap();
        ran(folder, &["render", "wall.toml", "-o", "wall", "-q"]);
    }
    let mut arguments = vec!["measure", "--points", "wall/starts.csv", "-m", "parametric_circle:window=61", "-o", points, "-q"];
    let photos: Vec<String> = (1..=4).flat_map(|station| (1..=2).map(move |roll| format!("wall/s0{station}-r{roll}.png"))).collect();
    arguments.extend(photos.iter().map(String::as_str).chain(more.iter().copied()));
    run(folder, &arguments)
}

/// The summary of a calibration, and how far its camera is from the true one, px RMS over the frame.
fn calibrated(folder: &Path, points: &str, more: &[&str]) -> (String, f64) {
    let usual = ["calibrate", "--points", points, "--control", "wall/control.csv", "--size", "1600x1200", "--pitch", "4.5", "--model"];
    let summary = ran(
        folder,
        &[&usual[..], &["photogrammetric", "--solve", "c,x0,y0,k1,k2,p1,p2", "-o", "found.toml", "--report", "report"], more].concat(),
    );
    let difference = ran(folder, &["diff", "wall/camera.toml", "found.toml"]);
    let px = difference.split_whitespace().nth(1).and_then(|word| word.parse().ok());
    (summary, px.unwrap_or_else(|| panic!("{difference}")))
}

#[test]
fn a_wall_of_discs_gives_its_camera_only_where_their_eccentricity_is_taken_out() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    measured(folder, "points.csv", &[]);
    let (summary, plain) = calibrated(folder, "points.csv", &[]);
    assert!(plain > 0.1, "{plain} px");
    assert!(summary.contains("the control file has 72 discs, and the centres of their pictures are not"), "{summary}");
    for given in ["control", "0.06"] {
        let (summary, centred) = calibrated(folder, "points.csv", &["--eccentricity", given]);
        assert!(centred < 1e-3, "{given}: {centred} px");
        assert!(summary.contains("eccentricity of 72 discs"), "{summary}");
    }
    let residuals = std::fs::read_to_string(folder.join("report/residuals.csv")).unwrap();
    assert!(residuals.lines().next().unwrap().ends_with(",status,reason,eccentricity_x,eccentricity_y"));
    let known =
        ["--eccentricity", "control", "--camera", "wall/camera.toml", "--stations", "wall/stations.csv", "--control", "wall/control.csv"];
    measured(folder, "centred.csv", &known);
    let (_, centred) = calibrated(folder, "centred.csv", &[]);
    assert!(centred < 1e-3, "{centred} px");
    // The camera of images of half the size is none of these, and taken where it is said to be the same.
    let output = run(folder, &["convert", "wall/camera.toml", "--scale", "0.5", "-o", "half.toml"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let half: Vec<&str> = known.iter().map(|word| if *word == "wall/camera.toml" { "half.toml" } else { word }).collect();
    let output = measure(folder, "other.csv", &half);
    let said = "half.toml: the camera is of images of 800 x 600 px, and these have 1600 x 1200 px: perhaps the same camera, its images times 2; --same-camera";
    assert!(output.status.code() == Some(2) && stderr(&output).contains(said), "{}", stderr(&output));
    measured(folder, "other.csv", &[&half[..], &["--same-camera"]].concat());
    let (_, centred) = calibrated(folder, "other.csv", &[]);
    assert!(centred < 1e-3, "{centred} px");
    // Discs whose radius is not stated are not passed on as if they were corrected.
    let control = std::fs::read_to_string(folder.join("wall/control.csv")).unwrap();
    let (stated, without): (Vec<&str>, Vec<&str>) = control.lines().partition(|line| !line.starts_with("p3"));
    let bare = |line: &&str| line.split(',').take(4).collect::<Vec<_>>().join(",") + ",,,,";
    let some: Vec<String> = stated.iter().map(|line| (*line).to_owned()).chain(without.iter().map(bare)).collect();
    std::fs::write(folder.join("wall/control.csv"), some.join("\n")).unwrap();
    measured(folder, "centred.csv", &known);
    let unavailable = std::fs::read_to_string(folder.join("centred.csv")).unwrap();
    let told = unavailable.lines().filter(|line| line.ends_with("unavailable,eccentricity: nothing states the disc's radius"));
    assert!(told.clone().count() > 20 && told.clone().all(|line| line.split(',').nth(1).unwrap().starts_with("p3")), "{unavailable}");
    let (summary, _) = calibrated(folder, "points.csv", &["--eccentricity", "control"]);
    assert!(summary.contains("that were measured as discs: the control file states no radius of theirs"), "{summary}");
}
