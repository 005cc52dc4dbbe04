//! `calibrate` with several cameras.

use std::path::Path;

use calibench_cameras::read_camera;
use calibench_model::camera::CameraModel;

use crate::calibrate::{WALL, number, one, table, wall, write};
use crate::project::{run, stderr, stdout};

/// The wall's control without its standard deviations: cameras have nothing in common but it.
fn fixed(folder: &Path) {
    let points = std::fs::read_to_string(folder.join("points.csv")).unwrap();
    let is_left = |line: &&str| ["s01", "s03"].iter().any(|station| line.starts_with(station));
    let (header, rows) = points.split_once('\n').unwrap();
    let (left, right): (Vec<&str>, Vec<&str>) = rows.lines().partition(is_left);
    let renamed = |prefix: &str, rows: &[&str]| rows.iter().map(|row| format!("{prefix}-{row}\n")).collect::<String>();
    let (left, right) = (renamed("l", &left), renamed("r", &right));
    assert!(!left.is_empty() && !right.is_empty());
    write(folder, "left.csv", &format!("{header}\n{left}"));
    write(folder, "right.csv", &format!("{header}\n{right}"));
    write(folder, "both.csv", &format!("{header}\n{left}{right}"));
}

fn parameters(path: &Path) -> Vec<f64> {
    one(path).camera.parameters().iter().map(|parameter| parameter.value).collect()
}

const BOTH: [&str; 12] = [
    "calibrate",
    "--points",
    "both.csv",
    "--control",
    "control.csv",
    "--sigma",
    "0.02",
    "--datum",
    "fixed",
    "--camera",
    "left=l-*",
    "--camera",
];

#[test]
fn cameras_that_share_fixed_control_alone_are_those_of_separate_calibrations() {
    let folder = wall();
    fixed(folder.path());
    let alone = |points: &str, file: &str, more: &[&str]| {
        let start = ["calibrate", "--points", points, "--control", "control.csv", "--size", "1600x1200", "--datum", "fixed", "-o", file];
        let output = run(folder.path(), &[&start, more].concat());
        assert!(output.status.success(), "{}", stderr(&output));
    };
    alone("left.csv", "left.toml", &["--pitch", "4.5", "--solve", "c,x0,y0,k1"]);
    alone("right.csv", "right.yaml", &["--model", "opencv5"]);
    let both = [
        "right=r-*",
        "--size",
        "1600x1200",
        "--pitch",
        "left=4.5",
        "--solve",
        "left=c,x0,y0,k1",
        "--model",
        "right=opencv5",
        "-o",
        "pair.toml",
        "--report",
        "report",
        "--compare",
        "c,x0,y0",
    ];
    // Their models have no parameter in common.
    let output = run(folder.path(), &[&BOTH[..], &both].concat());
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("right") && !folder.path().join("report").exists(), "{}", stderr(&output));
    let output = run(folder.path(), &[&BOTH[..], &both[..both.len() - 2]].concat());
    // Control that the survey knows to 0.2 mm is held fixed: that does not fit, and is said.
    assert_eq!(output.status.code(), Some(3), "{}", stdout(&output));
    assert!(stdout(&output).starts_with("doubtful: "), "{}", stdout(&output));
    figures_have_names_of_their_own(&folder.path().join("report/report.html"));
    assert!(
        stdout(&output).contains("camera model of right") && stdout(&output).contains("interior orientation of left"),
        "{}",
        stdout(&output)
    );
    for (file, other, bound) in [("pair-left.toml", "left.toml", 1e-8), ("pair-right.toml", "right.yaml", 1e-8)] {
        let (found, other) = (parameters(&folder.path().join(file)), parameters(&folder.path().join(other)));
        assert_eq!(found.len(), other.len());
        for (a, b) in found.iter().zip(&other) {
            assert!((a - b).abs() <= bound * b.abs().max(1e-3), "{file}: {found:?} {other:?}");
        }
    }
    each_image_has_its_camera(folder.path());
    let report = folder.path().join("report");
    let page = std::fs::read_to_string(report.join("README.md")).unwrap();
    for name in ["left", "right"] {
        for picture in [
            "residuals",
            "residuals-by-image-1",
            "rms-by-image",
            "distortion",
            "distribution",
            "correlations",
            "uncertainty-far",
            "uncertainty-near",
        ] {
            let file = format!("{name}-{picture}.png");
            assert!(page.contains(&format!("({file})")) && report.join(&file).is_file(), "{file}");
        }
    }
    let rows = table(&report.join("parameters.csv"));
    assert_eq!((rows.len(), rows.iter().filter(|row| row["camera"] == "right").count()), (10 + 9, 9));
    // Fixed control ties nothing: no parameter of one knows of the other's.
    let rows = table(&report.join("correlations.csv"));
    assert_eq!(rows.len(), 13 * 12 / 2);
    let across = rows.iter().filter(|row| row["first"].starts_with("left.") && row["second"].starts_with("right."));
    assert!(across.clone().count() == 4 * 9 && across.clone().all(|row| number(row, "rho").abs() < 1e-9));
    assert!(table(&report.join("stations.csv")).iter().all(|row| row["image"].starts_with(&row["camera"][..1])));
}

/// Resection and intersection with both cameras give back poses and, from them, control.
fn each_image_has_its_camera(folder: &Path) {
    let cameras = ["--camera", "l-*=pair-left.toml", "--camera", "r-*=pair-right.toml", "--points", "both.csv", "-q"];
    let resect = [&["resect", "--control", "control.csv", "-o", "poses.csv"], &cameras[..]].concat();
    let output = run(folder, &resect);
    assert!(output.status.success(), "{}", stderr(&output));
    for (row, adjusted) in table(&folder.join("poses.csv")).iter().zip(table(&folder.join("report/stations.csv"))) {
        // The cameras come from an adjustment that weighs the same points alike; each pose is at its minimum.
        assert_eq!(row["image"], adjusted["image"]);
        for column in ["X0", "Y0", "Z0"] {
            assert!((number(row, column) - number(&adjusted, column)).abs() < 1e-6, "{column}: {row:?} {adjusted:?}");
        }
    }
    let intersect = [&["intersect", "--stations", "poses.csv", "-o", "found.csv"], &cameras[..]].concat();
    let output = run(folder, &intersect);
    assert!(output.status.success(), "{}", stderr(&output));
    let control = table(&folder.join("control.csv"));
    for row in table(&folder.join("found.csv")) {
        let known = control.iter().find(|known| known["target"] == row["target"]).unwrap();
        for (column, sigma) in [("X", "sX"), ("Y", "sY"), ("Z", "sZ")] {
            assert!((number(&row, column) - number(known, column)).abs() < 6.0 * number(&row, sigma).hypot(2e-4), "{column}: {row:?}");
        }
    }
    let output = run(folder, &[&["intersect", "--stations", "poses.csv", "--camera", "l-*=pair-left.toml"], &cameras[4..]].concat());
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("none is for image `r-"), "{}", stderr(&output));
}

#[test]
fn one_file_holds_all_cameras_where_its_format_does() {
    let folder = wall();
    fixed(folder.path());
    let more = ["right=r-*", "--size", "1600x1200", "--model", "opencv4", "--to", "kalibr", "-o", "chain.yaml", "--report", "report"];
    let sets = ["--compare", "fx,fy,cx,cy;fx,fy,cx,cy,k1"];
    let output = run(folder.path(), &[&BOTH[..], &more, &sets].concat());
    // Control that the survey knows to 0.2 mm is held fixed: that does not fit, and is said.
    assert_eq!(output.status.code(), Some(3), "{}", stdout(&output));
    assert!(stdout(&output).starts_with("doubtful: "), "{}", stdout(&output));
    let chain = read_camera(&folder.path().join("chain.yaml")).unwrap().cameras;
    assert_eq!(chain.iter().map(|camera| camera.name.as_str()).collect::<Vec<_>>(), ["left", "right"]);
    let rows = table(&folder.path().join("report/parameters.csv"));
    for (i, parameter) in chain[0].camera.parameters().iter().enumerate() {
        let of = |name: &str| rows.iter().find(|row| row["camera"] == name && row["parameter"] == parameter.name).unwrap();
        assert!((number(of("left"), "value") - parameter.value).abs() < 1e-9 * parameter.value.abs());
        // One lens took all: both halves agree within their standard deviations.
        let differs = parameter.value - chain[1].camera.parameters()[i].value;
        let sigma = number(of("left"), "sigma").hypot(number(of("right"), "sigma"));
        assert!(sigma > 0.0 && differs.abs() < 4.0 * sigma, "{}: {differs} {sigma}", parameter.name);
    }
    // A set is of both cameras: ten unknowns of theirs, and the poses' 48.
    let images = table(&folder.path().join("report/stations.csv")).len();
    let points = table(&folder.path().join("report/residuals.csv")).len();
    let redundancy = (2 * points - 6 * images - 10).to_string();
    let output = stdout(&output);
    let cells: Vec<&str> = output.lines().find(|line| line.starts_with("| 2 ")).unwrap().split('|').map(str::trim).collect();
    assert_eq!(cells[2..4], ["fx, fy, cx, cy, k1", redundancy.as_str()]);
    assert!(cells[10].starts_with("left.k1 -") && cells[10].contains("right.k1 -"), "{cells:?}");
}

#[test]
fn an_image_without_a_camera_and_a_camera_without_an_image_are_named() {
    let folder = wall();
    for (cameras, expected) in [
        (["--camera", "left=nothing*", "--camera", "right=*"], "camera `left` has no image"),
        (
            ["--camera", "left=s01-r1.png", "--camera", "right=nothing*"],
            "belongs to no camera: there are left (s01-r1.png), right (nothing*)",
        ),
    ] {
        let output = run(folder.path(), &[&WALL[..], &cameras].concat());
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr(&output).contains(expected), "{}", stderr(&output));
    }
}

/// What a page keeps in its address it keeps by these names.
fn figures_have_names_of_their_own(page: &Path) {
    let html = std::fs::read_to_string(page).unwrap();
    let mut names: Vec<&str> = html.split(" id=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
    for name in ["left-residuals", "right-residuals", "left-distortion", "right-distortion"] {
        assert!(names.contains(&name), "{names:?}");
    }
    let count = names.len();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), count, "each name once");
    for camera in ["left", "right"] {
        assert!(html.contains(&format!("<figcaption>{camera}: Residuals (adjusted less observed)")), "{camera}");
    }
}
