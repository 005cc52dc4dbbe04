//! `calibrate`, `resect` and `intersect`: rendered testfields with a known truth, and what a user may get wrong.

use std::collections::HashMap;
use std::path::Path;

use calibench_cameras::read_camera;
use calibench_exchange::{read_control, read_stations};
use calibench_model::camera::CameraModel;
use calibench_model::{NamedCamera, StationRow};
use nalgebra::{Matrix3, Rotation3, Vector3};

use crate::project::{root, run, stderr, stdout};

pub type Table = Vec<HashMap<String, String>>;

/// A CSV by columns; no cell of these files holds a comma.
pub fn table(path: &Path) -> Table {
    let text = std::fs::read_to_string(path).unwrap();
    let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
    let header = lines.next().unwrap();
    lines.map(|cells| header.iter().cloned().zip(cells).collect()).collect()
}

pub fn number(row: &HashMap<String, String>, column: &str) -> f64 {
    row[column].parse().unwrap_or_else(|_| panic!("{column}: {row:?}"))
}

/// The wall of control points, rendered and measured at its chess corners: the truth in `wall/`, `points.csv`, and `control.csv` with the standard
/// deviations of the survey.
pub fn wall() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let root = root();
    let output = run(folder.path(), &["--root", root.to_str().unwrap(), "render", "testfields/wall", "-o", "wall", "-q"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let mut starts = String::from("image,target,x,y\n");
    let mut photos = Vec::new();
    for station in table(&folder.path().join("wall/stations.csv")) {
        let name = &station["image"];
        for row in table(&folder.path().join(format!("wall/{name}.csv"))) {
            if row["kind"] == "chess_corner" && row["visibility"] == "visible" {
                let [x, y] = ["x", "y"].map(|column| number(&row, column).round());
                starts.push_str(&format!("{name}.png,{},{x},{y}\n", row["target"]));
            }
        }
        photos.push(format!("wall/{name}.png"));
    }
    write(folder.path(), "starts.csv", &starts);
    let mut arguments = vec!["measure", "--points", "starts.csv", "-m", "forstner:window=11", "-o", "points.csv", "-q"];
    arguments.extend(photos.iter().map(String::as_str));
    assert!(run(folder.path(), &arguments).status.success());
    // The survey's standard deviation stands in the scenario.
    assert!(read_control(&folder.path().join("wall/control.csv")).unwrap().iter().all(|row| row.sigmas == Some([2e-4; 3])));
    std::fs::copy(folder.path().join("wall/control.csv"), folder.path().join("control.csv")).unwrap();
    folder
}

pub fn write(folder: &Path, name: &str, text: &str) {
    std::fs::write(folder.join(name), text).unwrap();
}

pub fn one(path: &Path) -> NamedCamera {
    read_camera(path).unwrap().cameras.remove(0)
}

pub const WALL: [&str; 11] =
    ["calibrate", "--points", "points.csv", "--control", "control.csv", "--size", "1600x1200", "--pitch", "4.5", "--sigma", "0.02"];

#[test]
fn a_rendered_wall_gives_its_camera_back_within_its_own_standard_deviations() {
    let folder = wall();
    let output = run(folder.path(), &[&WALL[..], &["-o", "found.toml", "--report", "report", "--scene", "wall.ply"]].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(stdout(&output).contains("direct linear transformation"), "{}", stdout(&output));
    let (truth, found) = (one(&folder.path().join("wall/camera.toml")), one(&folder.path().join("found.toml")));
    let covariance = found.covariance.as_ref().unwrap();
    assert_eq!(covariance.parameters, ["c", "x0", "y0", "k1", "k2", "p1", "p2"]);
    let value = |camera: &NamedCamera, name: &str| camera.camera.parameters().iter().find(|p| p.name == name).unwrap().value;
    for (i, name) in covariance.parameters.iter().enumerate() {
        let (error, sigma) = (value(&found, name) - value(&truth, name), covariance.values[i * 8].sqrt());
        assert!(error.abs() < 4.0 * sigma, "{name}: {error} with a standard deviation of {sigma}");
    }
    assert!(covariance.values[0].sqrt() < 0.005, "c in mm");
    let report = folder.path().join("report");
    for (row, truth) in table(&report.join("stations.csv")).iter().zip(table(&folder.path().join("wall/stations.csv"))) {
        assert_eq!(row["image"], format!("{}.png", truth["image"]));
        for (column, sigma) in [("X0", "sX0"), ("Y0", "sY0"), ("Z0", "sZ0")] {
            let (error, sigma) = (number(row, column) - number(&truth, column), number(row, sigma));
            assert!(error.abs() < 4.5 * sigma, "{column} of {}: {error}, {sigma}", row["image"]);
        }
    }
    the_report_is_whole(&report);
    the_scene_is_whole(&std::fs::read_to_string(folder.path().join("wall.ply")).unwrap(), &table(&report.join("stations.csv")));
    let output = run(folder.path(), &[&WALL[..], &["--scene", "wall.obj"]].concat());
    assert!(output.status.code() == Some(2) && stderr(&output).contains("a scene ends in .ply"), "{}", stderr(&output));
}

/// The page's table of what to photograph next says what the answer for programs says.
#[test]
fn what_to_photograph_next_is_the_same_on_the_page_and_for_programs() {
    let folder = wall();
    let output = run(folder.path(), &[&WALL[..], &["--json", "--report", "report"]].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    let answer: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
    let next = &answer["cameras"][0]["next"];
    assert!(answer["cameras"][0]["why_no_next"].is_null());
    let value = |of: &serde_json::Value| of.as_f64().unwrap();
    let page = std::fs::read_to_string(folder.path().join("report/README.md")).unwrap();
    let section = page.split("## What to photograph next").nth(1).unwrap().split("\n## ").next().unwrap();
    let rows: Vec<Vec<&str>> =
        section.lines().filter(|line| line.starts_with("| ")).map(|line| line.split('|').map(str::trim).collect()).collect();
    let column = |name: &str| rows[0].iter().position(|cell| *cell == name).unwrap();
    let photographs = next["photographs"].as_array().unwrap();
    assert_eq!((photographs.len(), rows.len()), (3, 5));
    let plain = calibench_report::plain;
    for (one, row) in photographs.iter().zip(&rows[2..]) {
        assert_eq!(row[column("x px")], format!("{:.0}", value(&one["middle_px"][0])));
        assert_eq!(row[column("y px")], format!("{:.0}", value(&one["middle_px"][1])));
        assert_eq!(row[column("tilt")], format!("{:.0}\u{b0}", value(&one["tilt_deg"])));
        assert_eq!(row[column("distance")], plain(value(&one["distance"])));
        assert_eq!(row[column("points")], one["points"].to_string());
        assert_eq!(row[column("then px")], plain(value(&one["then_px"])));
        assert_eq!(row[column("nearer")] == "none", one["nearer_deg"].is_null());
    }
    let [now, usual] = ["now_px", "usual_px"].map(|key| value(&next[key]));
    assert!(
        section.contains(&format!("standard deviation of {} px", plain(now)))
            && section.contains(&format!("makes that {} px", plain(usual)))
    );
    let then: Vec<f64> = photographs.iter().map(|one| value(&one["then_px"])).collect();
    assert!(now > usual && usual > then[0] && then[0] > then[1] && then[1] > then[2], "{next}");
    // Without known control nothing is proposed, for a reason that both tell.
    let output = run(folder.path(), &[&WALL[..], &["--datum", "free", "--json", "--report", "free"]].concat());
    let answer: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
    let camera = &answer["cameras"][0];
    let why = camera["why_no_next"].as_str().unwrap();
    assert!(camera["next"].is_null() && why.contains("control points are known"), "{camera}");
    let page = std::fs::read_to_string(folder.path().join("free/README.md")).unwrap();
    assert!(page.contains(&format!("Nothing is proposed: {why}.")), "{page}");
}

/// As many vertices and faces as the head says, and a vertex at each projection centre.
fn the_scene_is_whole(scene: &str, stations: &[HashMap<String, String>]) {
    let said = |what: &str| -> usize { scene.split(what).nth(1).unwrap().lines().next().unwrap().trim().parse().unwrap() };
    let (vertices, faces) = (said("element vertex"), said("element face"));
    let body: Vec<&str> = scene.lines().skip_while(|line| *line != "end_header").skip(1).collect();
    assert_eq!(body.len(), vertices + faces);
    let places: Vec<Vec<f64>> = body[..vertices].iter().map(|line| line.split(' ').map(|word| word.parse().unwrap()).collect()).collect();
    for station in stations {
        let is_there = |place: &Vec<f64>| (0..3).all(|i| (place[i] - number(station, ["X0", "Y0", "Z0"][i])).abs() < 1e-6);
        assert!(places.iter().any(is_there), "{}", station["image"]);
    }
    assert!(body[vertices..].iter().flat_map(|line| line.split(' ').skip(1)).all(|corner| corner.parse::<usize>().unwrap() < vertices));
    assert!(scene.contains("ellipsoids of one standard deviation"));
}

fn the_report_is_whole(report: &Path) {
    let page = std::fs::read_to_string(report.join("README.md")).unwrap();
    let pictures = [
        "residuals",
        "residuals-by-image-1",
        "rms-by-image",
        "distortion",
        "distribution",
        "correlations",
        "uncertainty-far",
        "uncertainty-near",
        "next",
    ];
    for picture in pictures {
        assert!(page.contains(&format!("({picture}.png)")), "{picture}");
        let image = image::open(report.join(format!("{picture}.png"))).unwrap().to_rgb8();
        assert!(image.pixels().any(|pixel| pixel.0 == [0, 0, 0]) && image.width() >= 420, "{picture}");
    }
    let residuals = table(&report.join("residuals.csv"));
    let points = residuals.iter().map(|row| number(row, "redundancy_x") + number(row, "redundancy_y")).sum::<f64>();
    let redundancy: f64 = page.split("redundancy ").nth(1).unwrap().split_whitespace().next().unwrap().parse().unwrap();
    // The rest of it is the weighted control's.
    assert!(points > 0.5 * redundancy && points < redundancy, "{points} of {redundancy}");
    assert!(residuals.iter().all(|row| row["status"] == "used"));
    assert_eq!(table(&report.join("parameters.csv")).len(), 10);
    assert_eq!(table(&report.join("correlations.csv")).len(), 7 * 6 / 2);
    assert!(read_control(&report.join("points.csv")).unwrap().iter().all(|row| row.sigmas.is_some()));
    assert_eq!(read_stations(&report.join("stations.csv")).unwrap().len(), 8);
}

#[test]
fn a_blunder_is_found_and_named_and_a_point_of_no_control_is_intersected() {
    let folder = wall();
    let points = std::fs::read_to_string(folder.path().join("points.csv")).unwrap();
    let mut lines: Vec<String> = points.lines().map(str::to_owned).collect();
    let mut cells: Vec<String> = lines[20].split(',').map(str::to_owned).collect();
    cells[2] = (cells[2].parse::<f64>().unwrap() + 3.0).to_string();
    let (image, target) = (cells[0].clone(), cells[1].clone());
    lines[20] = cells.join(",");
    // A control point becomes a tie point, and a target that one image alone sees takes no part.
    let tie = lines[1].split(',').nth(1).unwrap().to_owned();
    lines.push(lines[1].replacen(&tie, "lonely", 1));
    write(folder.path(), "points.csv", &(lines.join("\n") + "\n"));
    let control = std::fs::read_to_string(folder.path().join("control.csv")).unwrap();
    let known = control.lines().find(|line| line.starts_with(&format!("{tie},"))).unwrap().to_owned();
    write(folder.path(), "control.csv", &control.lines().filter(|line| *line != known).collect::<Vec<_>>().join("\n"));
    let output = run(folder.path(), &[&WALL[..], &["--snoop", "--report", "report"]].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    let residuals = table(&folder.path().join("report/residuals.csv"));
    let of = |status: &str| -> Vec<(String, String)> {
        let rows = residuals.iter().filter(|row| row["status"] == status);
        rows.map(|row| (row["image"].clone(), row["target"].clone())).collect()
    };
    assert!(of("rejected").contains(&(image, target)), "{:?}", of("rejected"));
    assert!(of("rejected").len() < 5);
    assert_eq!(of("left_out").into_iter().map(|(_, target)| target).collect::<Vec<_>>(), ["lonely"]);
    assert_eq!(residuals.len(), lines.len() - 1);
    let points = read_control(&folder.path().join("report/points.csv")).unwrap();
    let found = points.iter().find(|row| row.target == tie).unwrap();
    let truth: Vec<f64> = known.split(',').skip(1).take(3).map(|cell| cell.parse().unwrap()).collect();
    for axis in 0..3 {
        assert!((found.position[axis] - truth[axis]).abs() < 4.0 * found.sigmas.unwrap()[axis].hypot(2e-4), "{found:?} {truth:?}");
    }
}

#[test]
fn the_datum_changes_coordinates_and_not_the_camera() {
    let folder = wall();
    let calibrate = |datum: &str, file: &str| {
        let output = run(folder.path(), &[&WALL[..], &["--datum", datum, "-o", file]].concat());
        assert!(output.status.success(), "{datum}: {}", stderr(&output));
        one(&folder.path().join(file))
    };
    let names: Vec<String> = read_control(&folder.path().join("control.csv")).unwrap().into_iter().map(|row| row.target).collect();
    let measured = |name: &&String| std::fs::read_to_string(folder.path().join("points.csv")).unwrap().contains(&format!(",{name},"));
    let seen: Vec<&String> = names.iter().filter(measured).collect();
    let minimal = format!("minimal:{0},{1},{0},{1},{2}", seen[0], seen[3], seen[seen.len() - 1]);
    let (free, minimal) = (calibrate("free", "a.toml"), calibrate(&minimal, "b.toml"));
    for (a, b) in free.camera.parameters().iter().zip(minimal.camera.parameters()) {
        assert!((a.value - b.value).abs() <= 1e-7 * a.value.abs().max(1e-6), "{}: {} {}", a.name, a.value, b.value);
    }
}

#[test]
fn resection_and_intersection_go_there_and_back() {
    let folder = wall();
    let common = ["--camera", "wall/camera.toml", "--points", "points.csv"];
    let output = run(folder.path(), &[&["resect"], &common[..], &["--control", "wall/control.csv", "-o", "poses.csv"]].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    for (row, truth) in table(&folder.path().join("poses.csv")).iter().zip(table(&folder.path().join("wall/stations.csv"))) {
        for (column, sigma) in [("X0", "sX0"), ("Y0", "sY0"), ("Z0", "sZ0")] {
            assert!((number(row, column) - number(&truth, column)).abs() < 4.5 * number(row, sigma), "{column}: {row:?}");
        }
    }
    let ratios = turns_over_sigmas(&folder.path().join("poses.csv"), &folder.path().join("wall/stations.csv"));
    let rms = (ratios.iter().map(|ratio| ratio * ratio).sum::<f64>() / ratios.len() as f64).sqrt();
    assert!(ratios.len() == 24 && (0.5..2.0).contains(&rms), "{rms}: {ratios:?}");
    let output = run(folder.path(), &[&["intersect"], &common[..], &["--stations", "wall/stations.csv", "-o", "points3d.csv"]].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    let known: HashMap<_, _> =
        read_control(&folder.path().join("wall/control.csv")).unwrap().into_iter().map(|r| (r.target, r.position)).collect();
    let found = table(&folder.path().join("points3d.csv"));
    assert!(found.len() > 10);
    for row in &found {
        for (axis, column) in ["X", "Y", "Z"].into_iter().enumerate() {
            // The survey's error is in the control.
            let sigma = number(row, &format!("s{column}")).hypot(2e-4);
            assert!((number(row, column) - known[&row["target"]][axis]).abs() < 4.5 * sigma, "{column}: {row:?}");
        }
    }
}

/// The errors of rotations, about the camera's axes, over their standard deviations; both in degrees, as the columns say.
fn turns_over_sigmas(found: &Path, truth: &Path) -> Vec<f64> {
    let poses = read_stations(found).unwrap();
    let truth = read_stations(truth).unwrap();
    let of = |(row, (found, truth)): (&HashMap<String, String>, (&StationRow, &StationRow))| {
        let turn = turn(&found.pose.rotation, &truth.pose.rotation);
        ["sx_deg", "sy_deg", "sz_deg"].iter().zip(turn.iter()).map(|(column, turn)| turn / number(row, column)).collect::<Vec<_>>()
    };
    table(found).iter().zip(poses.iter().zip(&truth)).flat_map(of).collect()
}

/// The small rotation from `truth` to `found` about the camera's axes, degrees.
pub fn turn(found: &Matrix3<f64>, truth: &Matrix3<f64>) -> Vector3<f64> {
    Rotation3::from_matrix_unchecked(found * truth.transpose()).scaled_axis().map(f64::to_degrees)
}

/// A plane of 5 x 4 points as a frontal camera sees it from `images` distances, a little noisy.
fn frontal(images: usize) -> (String, String) {
    let (mut points, mut control) = (String::from("image,target,x,y\n"), String::from("target,X,Y,Z\n"));
    for (i, j) in (0..5).flat_map(|i| (0..4).map(move |j| (i, j))) {
        control.push_str(&format!("{i}-{j},{i},{j},0\n"));
        for image in 0..images {
            let scale = 100.0 + 10.0 * image as f64;
            let noise = |k: usize| 0.05 * ((((i * 7 + j * 13 + image * 29 + k * 17) % 31) as f64) / 15.0 - 1.0);
            let (x, y) = (150.0 + scale * f64::from(i as u32) + noise(1), 500.0 - scale * f64::from(j as u32) + noise(2));
            points.push_str(&format!("i{image},{i}-{j},{x},{y}\n"));
        }
    }
    (points, control)
}

#[test]
fn what_cannot_be_estimated_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let common = ["calibrate", "--points", "p.csv", "--control", "c.csv", "--size", "800x600", "--pitch", "5"];
    for (images, solve, expected) in [
        (3, "c", &["c of the camera", "Z0 of all images", "no depth", "no convergence"][..]),
        (3, "c,x0,y0", &["c of the camera", "Z0 of all images"]),
        (1, "c", &["c of the camera", "Z0 of image i0", "one image"]),
    ] {
        let (points, control) = frontal(images);
        write(folder.path(), "p.csv", &points);
        write(folder.path(), "c.csv", &control);
        let output = run(folder.path(), &[&common[..], &["--solve", solve, "-o", "out.toml"]].concat());
        assert_eq!(output.status.code(), Some(2), "{solve}: {}", stdout(&output));
        for part in expected {
            assert!(stderr(&output).contains(part), "{solve}: {part}: {}", stderr(&output));
        }
        assert!(!folder.path().join("out.toml").exists());
    }
}

#[test]
fn bad_input_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let (points, control) = frontal(2);
    write(folder.path(), "p.csv", &points);
    write(folder.path(), "c.csv", &control);
    write(
        folder.path(),
        "few.csv",
        &(points.lines().filter(|line| !line.starts_with("i1") || line.contains("0-")).take(26).collect::<Vec<_>>().join("\n")),
    );
    write(
        folder.path(),
        "three.csv",
        &points
            .lines()
            .filter(|l| l.starts_with("image") || ["i0,0-0,", "i0,1-0,", "i0,0-1,"].iter().any(|p| l.starts_with(p)))
            .collect::<Vec<_>>()
            .join("\n"),
    );
    write(folder.path(), "missing.csv", "target,X,Y\n0-0,1,2\n");
    write(folder.path(), "others.csv", "target,X,Y,Z\n0_0,1,2,3\n");
    write(folder.path(), "sigma.csv", "target,X,Y,Z,sX,sY,sZ\n0-0,1,2,3,0,1,1\n");
    write(folder.path(), "nowhere.csv", "image,X0,Y0,Z0,omega_deg,phi_deg,kappa_deg\nother,1,2,3,0,0,0\n");
    let size = ["--size", "800x600"];
    let given = |points, control| [&["calibrate", "--points", points, "--control", control][..], &size].concat();
    let with = |more: &[&'static str]| [&given("p.csv", "c.csv")[..], more].concat();
    for (arguments, expected) in [
        (given("p.csv", "missing.csv"), "missing.csv:1, column `Z`: missing in the header"),
        (given("p.csv", "sigma.csv"), "sigma.csv:2, column `sX`: expected a positive standard deviation"),
        (given("p.csv", "others.csv"), "no measured target is a control point: `0-0` was measured, `0_0` is known"),
        (given("p.csv", "no.csv"), "no.csv: No such file"),
        (given("three.csv", "c.csv"), "image i0: 3 known points, a resection takes at least 4"),
        (with(&["--solve", "c,x0"]), "give the pixel pitch with --pitch UM"),
        (with(&["--model", "photogrammetric"]), "give the pixel pitch with --pitch UM"),
        (with(&["--model", "opencv6"]), "no camera model is called opencv6"),
        (with(&["--solve", "fx,k9"]), "has no parameter k9: it has fx, fy"),
        (with(&["--datum", "loose"]), "`loose` is no datum"),
        (with(&["--datum", "minimal:0-0,0-1,0-0,0-1,9-9"]), "the datum names 9-9, which is no measured control point"),
        (with(&["--huber", "0"]), "expected a positive number"),
        (with(&["--bits", "12", "--ignore-orientation"]), "--ignore-orientation, --bits: for photographs, and --points has none"),
        (vec!["judge", "--board", "9x6:25", "--size", "640x480", "--points", "a=p.csv", "--bits", "12"], "--bits: for photographs"),
        (with(&["--to", "opencv5"]), "--output"),
        (with(&["--start", "c.csv"]), "no camera file that is known"),
        (vec!["calibrate", "--points", "p.csv"], "--size"),
        (vec!["calibrate", "a.png", "--chessboard", "9x6"], "expected inner corners and the side of a square"),
        (vec!["calibrate", "a.png", "--chessboard", "9x6:25"], "a.png: No such file"),
        (vec!["resect", "--camera", "c.csv", "--points", "p.csv", "--control", "c.csv"], "no camera file that is known"),
        (vec!["intersect", "--camera", "k.toml", "--points", "p.csv", "--stations", "nowhere.csv"], "k.toml"),
    ] {
        let output = run(folder.path(), &arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", stdout(&output));
        assert!(stderr(&output).contains(expected), "{arguments:?}: expected {expected}\n{}", stderr(&output));
        assert!(!stderr(&output).contains("panicked"), "{arguments:?}");
    }
}

/// Photographs to a camera in one command.
#[test]
fn photographs_of_a_rendered_board_give_its_camera_back() {
    let folder = tempfile::tempdir().unwrap();
    let root = root();
    let output = run(folder.path(), &["--root", root.to_str().unwrap(), "render", "testfields/chessboard", "-o", "board", "-q"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let stations = table(&folder.path().join("board/stations.csv"));
    let photos: Vec<String> = stations.iter().map(|row| format!("board/{}.png", row["image"])).collect();
    let mut arguments = vec!["calibrate", "--chessboard", "9x6:25", "-m", "forstner:window=9", "-o", "found.yaml", "-q"];
    arguments.extend(photos.iter().map(String::as_str));
    // With k3 the distortion turns back before the corners of the frame, where no point was measured.
    let output = run(folder.path(), &arguments);
    assert!(output.status.code() == Some(3) && stdout(&output).starts_with("doubtful: the camera folds over "), "{}", stdout(&output));
    let own = [&arguments[..5], &["--model", "photogrammetric", "--pitch", "7"], &arguments[7..]].concat();
    let sound = run(folder.path(), &own);
    assert!(sound.status.success() && stdout(&sound).starts_with("known to 0.0"), "{}{}", stdout(&sound), stderr(&sound));
    assert!(stdout(&output).contains("Zhang's closed form"), "{}", stdout(&output));
    // The file has a place for standard deviations; what it has none for is said.
    let spreads = one(&folder.path().join("found.yaml")).covariance.expect("standard deviations");
    assert!(spreads.parameters.len() >= 8 && stderr(&output).contains("the correlations of the parameters"), "{}", stderr(&output));
    let output = run(folder.path(), &["diff", "board/camera.toml", "found.yaml"]);
    assert!(output.status.success(), "{}", stderr(&output));
}
