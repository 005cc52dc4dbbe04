//! `orient`: pairs of a rendered wall with a known truth, and pairs that have no orientation.

use std::path::Path;

use calibench_exchange::{read_control, read_stations};

use crate::calibrate::{Table, number, table, turn, wall, write};
use crate::project::{run, stderr};

const PAIR: [&str; 9] =
    ["orient", "--points", "points.csv", "--left", "s01-r1.png", "--right", "s04-r1.png", "--camera", "wall/camera.toml"];

/// The true positions of an image's targets, object units.
fn truth(folder: &Path, image: &str) -> Table {
    table(&folder.join(format!("wall/{image}.csv")))
}

fn of_status<'t>(rows: &'t Table, status: &str) -> Vec<&'t str> {
    rows.iter().filter(|row| row["status"] == status).map(|row| row["target"].as_str()).collect()
}

/// The true length of the base: with it, the model is the object in the left image's axes.
#[test]
fn the_model_of_a_rendered_pair_is_the_object_in_the_left_images_axes() {
    let folder = wall();
    let stations = read_stations(&folder.path().join("wall/stations.csv")).unwrap();
    let pose = |name: &str| stations.iter().find(|row| row.image == name).unwrap().pose;
    let (left, right) = (pose("s01-r1"), pose("s04-r1"));
    let base = (right.centre - left.centre).norm().to_string();
    // A gross error, and a target that the right image lacks.
    let points = std::fs::read_to_string(folder.path().join("points.csv")).unwrap();
    let mut lines: Vec<String> = points.lines().map(str::to_owned).collect();
    let wrong = lines.iter().position(|line| line.starts_with("s04-r1.png")).unwrap();
    let mut cells: Vec<String> = lines[wrong].split(',').map(str::to_owned).collect();
    let gross = cells[1].clone();
    cells[3] = (cells[3].parse::<f64>().unwrap() + 4.0).to_string();
    lines[wrong] = cells.join(",");
    let single = lines.remove(wrong + 2).split(',').nth(1).unwrap().to_owned();
    write(folder.path(), "points.csv", &(lines.join("\n") + "\n"));
    let output =
        run(folder.path(), &[&PAIR[..], &["--base", &base, "--tolerance", "0.5", "-o", "model.csv", "--poses", "pair.csv"]].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    let rows = table(&folder.path().join("model.csv"));
    assert_eq!(of_status(&rows, "rejected"), [gross.as_str()]);
    assert_eq!(of_status(&rows, "left_out"), [single.as_str()]);
    assert_eq!(of_status(&rows, "used").len(), 10);
    assert!(rows.iter().find(|row| row["target"] == single).unwrap()["reason"].contains("not measured in the right image"));
    let objects = truth(folder.path(), "s01-r1");
    for row in rows.iter().filter(|row| row["status"] == "used") {
        let object = objects.iter().find(|object| object["target"] == row["target"]).unwrap();
        let at = nalgebra::Point3::from(["X", "Y", "Z"].map(|axis| number(object, axis)));
        let expected = left.rotation * (at - left.centre);
        for (axis, expected) in ["X", "Y", "Z"].iter().zip(expected.iter()) {
            let (error, sigma) = (number(row, axis) - expected, number(row, &format!("s{axis}")));
            assert!(error.abs() < 4.5 * sigma, "{axis} of {}: {error}, {sigma}", row["target"]);
        }
        let v = ["v_left_x", "v_left_y", "v_right_x", "v_right_y"].map(|column| number(row, column).powi(2)).iter().sum::<f64>().sqrt();
        assert!((v - number(row, "parallax_px")).abs() < 1e-12 && v < 0.2);
    }
    let pair = table(&folder.path().join("pair.csv"));
    assert_eq!((number(&pair[1], "points"), number(&pair[1], "redundancy")), (11.0 - 1.0, 5.0));
    let centre = left.rotation * (right.centre - left.centre);
    for (column, expected) in ["X0", "Y0", "Z0"].into_iter().zip(centre.iter()) {
        let (error, sigma) = (number(&pair[1], column) - expected, number(&pair[1], &format!("s{column}")));
        assert!(error.abs() < 4.5 * sigma, "{column}: {error}, {sigma}");
    }
    let found = read_stations(&folder.path().join("pair.csv")).unwrap();
    assert_eq!(found.len(), 2);
    // Rotations in the left image's axes, with standard deviations in degrees: three ratios of a normal variable, none huge, not all tiny.
    let turn = turn(&found[1].pose.rotation, &(right.rotation * left.rotation.transpose()));
    let ratios: Vec<f64> =
        ["sx_deg", "sy_deg", "sz_deg"].iter().zip(turn.iter()).map(|(column, turn)| turn / number(&pair[1], column)).collect();
    let largest = ratios.iter().fold(0.0_f64, |largest, ratio| largest.max(ratio.abs()));
    assert!((0.1..4.5).contains(&largest), "{ratios:?}");
}

#[test]
fn pairs_without_an_orientation_are_named() {
    let folder = wall();
    let points = std::fs::read_to_string(folder.path().join("points.csv")).unwrap();
    let mut few: Vec<&str> = points.lines().take(5).collect();
    few.extend(points.lines().filter(|line| line.starts_with("s04-r1.png")));
    write(folder.path(), "few.csv", &few.join("\n"));
    let with = |changes: &[(&str, &'static str)]| {
        let mut arguments = PAIR.to_vec();
        for (option, value) in changes {
            let place = arguments.iter().position(|argument| argument == option).unwrap();
            arguments[place + 1] = value;
        }
        arguments
    };
    for (arguments, expected) in [
        (with(&[("--right", "s01-r2.png")]), "differ by a rotation alone: there is no base"),
        (with(&[("--points", "few.csv")]), "have 4 targets in common: five determine"),
        (with(&[("--right", "s04-r3.png")]), "--right s04-r3.png: no point is of this image; did you mean `s04-r"),
        (with(&[("--right", "s01-r1.png")]), "both name s01-r1.png"),
        (with(&[("--camera", "points.csv")]), "no camera file that is known"),
        ([&PAIR[..], &["--base", "0"]].concat(), "expected a positive number"),
    ] {
        let output = run(folder.path(), &arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(stderr(&output).contains(expected), "{arguments:?}: expected {expected}\n{}", stderr(&output));
    }
}

/// Seven points of a plane, far too few to choose between its two orientations: the pair is oriented, and said to be doubtful.
#[test]
fn a_plane_is_said_to_be_critical() {
    let folder = wall();
    let (mut points, mut control) = (String::from("image,target,x,y\n"), String::new());
    let camera = calibench_cameras::read_camera(&folder.path().join("wall/camera.toml")).unwrap().cameras.remove(0).camera;
    let stations = read_stations(&folder.path().join("wall/stations.csv")).unwrap();
    let known = read_control(&folder.path().join("wall/control.csv")).unwrap();
    // The plane through three of the targets.
    let [a, b, c] = [0, 4, 8].map(|i| nalgebra::Point3::from(known[i].position));
    for (index, (s, t)) in
        [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.5, 0.5), (0.3, 0.1), (0.1, 0.6), (0.4, 0.2), (0.7, 0.2)].into_iter().enumerate()
    {
        let at = a + (b - a) * s + (c - a) * t;
        for name in ["s01-r1", "s04-r1"] {
            let pose = stations.iter().find(|row| row.image == name).unwrap().pose;
            let pixel = calibench_model::camera::CameraModel::project(&camera, pose.ray(&at)).unwrap();
            points.push_str(&format!("{name}.png,{index},{},{}\n", pixel.x, pixel.y));
        }
        control.push_str(&format!("{at}"));
    }
    write(folder.path(), "points.csv", &points);
    let output = run(folder.path(), &[&PAIR[..], &["--tolerance", "0.5", "-o", "model.csv"]].concat());
    assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
    assert!(stderr(&output).contains("another orientation fits as well") && folder.path().join("model.csv").is_file());
    assert!(stderr(&output).contains("the model is nearly a plane"), "{}", stderr(&output));
}
