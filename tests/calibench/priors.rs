//! `calibrate` with observed parameters and poses, with sets of parameters beside each other, and the rows of what was not measured.

use std::path::Path;

use calibench_model::NamedCamera;
use calibench_model::camera::CameraModel;

use crate::calibrate::{WALL, number, one, table, wall, write};
use crate::project::{root, run, stderr, stdout};

fn value(camera: &NamedCamera, name: &str) -> f64 {
    camera.camera.parameters().iter().find(|p| p.name == name).unwrap().value
}

fn calibrate(folder: &Path, more: &[&str]) -> (String, NamedCamera) {
    let output = run(folder, &[&WALL[..], &["-o", "found.toml", "--report", "report"], more].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    (stdout(&output), one(&folder.join("found.toml")))
}

fn sigma(camera: &NamedCamera, name: &str) -> f64 {
    let covariance = camera.covariance.as_ref().unwrap();
    let place = covariance.parameters.iter().position(|known| known == name).unwrap();
    covariance.values[place * (covariance.parameters.len() + 1)].sqrt()
}

#[test]
fn an_observed_parameter_weighs_as_its_standard_deviation_says() {
    let folder = wall();
    let (_, alone) = calibrate(folder.path(), &[]);
    let truth = one(&folder.path().join("wall/camera.toml"));
    // One that says nothing changes nothing.
    let (_, vague) = calibrate(folder.path(), &["--prior", "c=8.1:1e6"]);
    for name in ["c", "x0", "k1"] {
        assert!((value(&vague, name) - value(&alone, name)).abs() < 1e-6 * sigma(&alone, name), "{name}");
    }
    // One that says all holds the parameter; a second method holds it by not solving for it.
    let start = std::fs::read_to_string(folder.path().join("wall/camera.toml")).unwrap();
    write(folder.path(), "start.toml", &start);
    let prior = format!("c={}:1e-9", value(&truth, "c"));
    let (text, tight) = calibrate(folder.path(), &["--prior", &prior, "--solve", "x0,y0,k1,k2,p1,p2"]);
    assert!(text.contains("observed as well: c = "), "{text}");
    assert!((value(&tight, "c") - value(&truth, "c")).abs() < 1e-8);
    let (_, held) = calibrate(folder.path(), &["--start", "start.toml", "--solve", "x0,y0,k1,k2,p1,p2"]);
    for name in ["x0", "y0", "k1", "k2", "p1", "p2"] {
        assert!((value(&held, name) - value(&tight, name)).abs() < 1e-3 * sigma(&held, name), "{name}");
        let (error, sigma) = (value(&tight, name) - value(&truth, name), sigma(&tight, name));
        assert!(error.abs() < 4.0 * sigma, "{name}: {error} {sigma}");
    }
    let parameters = table(&folder.path().join("report/parameters.csv"));
    assert_eq!(parameters.iter().find(|row| row["parameter"] == "c").unwrap()["status"], "fixed");
    for (wrong, expected) in [("k9=0:1", "has no parameter k9"), ("c=8", "is no observed parameter"), ("c=8:0", "is no observed parameter")]
    {
        let output = run(folder.path(), &[&WALL[..], &["--prior", wrong]].concat());
        assert!(output.status.code() == Some(2) && stderr(&output).contains(expected), "{wrong}: {}", stderr(&output));
    }
}

#[test]
fn observed_centres_strengthen_the_camera() {
    let folder = wall();
    let (_, alone) = calibrate(folder.path(), &[]);
    let truth = one(&folder.path().join("wall/camera.toml"));
    let mut stations = String::from("image,X0,Y0,Z0,omega_deg,phi_deg,kappa_deg,sX0,sY0,sZ0\n");
    for row in table(&folder.path().join("wall/stations.csv")) {
        let cells = ["image", "X0", "Y0", "Z0", "omega_deg", "phi_deg", "kappa_deg"].map(|column| row[column].clone());
        stations.push_str(&format!("{},5e-4,5e-4,5e-4\n", cells.join(",")));
    }
    write(folder.path(), "gnss.csv", &stations);
    let (text, with) = calibrate(folder.path(), &["--poses", "gnss.csv"]);
    assert!(text.contains("observed as well: 8 projection centres"), "{text}");
    assert!(sigma(&with, "c") < 0.8 * sigma(&alone, "c"), "{} {}", sigma(&with, "c"), sigma(&alone, "c"));
    let error = value(&with, "c") - value(&truth, "c");
    assert!(error.abs() < 4.0 * sigma(&with, "c"), "{error} {}", sigma(&with, "c"));
    write(folder.path(), "other.csv", &stations.replacen("s01-r1", "s77-r1", 1));
    for (file, expected) in [
        ("other.csv", "the pose of `s77-r1` was observed, but no point is of this image"),
        ("wall/stations.csv", "holds no standard deviation"),
    ] {
        let output = run(folder.path(), &[&WALL[..], &["--poses", file]].concat());
        assert!(output.status.code() == Some(2) && stderr(&output).contains(expected), "{file}: {}", stderr(&output));
    }
}

/// A property: for one parameter more, F is the square of its t.
#[test]
fn sets_of_parameters_are_compared() {
    let folder = wall();
    let sets = "c,x0,y0,k1;c,x0,y0,k1,k2;c,x0,y0,k1,k2,p1,p2;c,x0,y0,k1,k2,k3,p1,p2,b1,b2";
    let (text, _) = calibrate(folder.path(), &["--compare", sets]);
    assert!(text.contains("dAICc") && text.contains("| c, x0, y0, k1, k2 "), "{text}");
    let rows = table(&folder.path().join("report/sets.csv"));
    assert_eq!(rows.len(), 4 + 5 + 7 + 10);
    let row = |set: &str, parameter: &str| rows.iter().find(|row| row["set"] == set && row["parameter"] == parameter).unwrap();
    let (f, t) = (number(row("2", "k2"), "f"), number(row("2", "k2"), "t"));
    assert!((f / (t * t) - 1.0).abs() < 0.05, "{f} {t}");
    assert_eq!((row("2", "k2")["against"].as_str(), row("3", "c")["against"].as_str(), row("1", "c")["against"].as_str()), ("1", "2", ""));
    // The truth has k1, k2, p1 and p2, and no more.
    assert!(number(row("3", "c"), "f_p") < 0.01 && number(row("4", "c"), "f_p") > 0.01);
    assert!(number(row("3", "c"), "aicc") < number(row("1", "c"), "aicc") && number(row("3", "c"), "aicc") < number(row("4", "c"), "aicc"));
    assert!(number(row("3", "c"), "change_max_px") < 1e-6 && number(row("1", "c"), "change_max_px") > 0.1);
    let page = std::fs::read_to_string(folder.path().join("report/README.md")).unwrap();
    assert!(page.contains("## Sets of parameters"));
    let output = run(folder.path(), &[&WALL[..], &["--compare", "c,,x0"]].concat());
    assert!(output.status.code() == Some(2) && stderr(&output).contains("is no set of parameters"), "{}", stderr(&output));
}

/// No observation disappears without a row that says so.
#[test]
fn every_corner_of_a_photograph_has_a_row() {
    let folder = tempfile::tempdir().unwrap();
    let root = root();
    let output = run(folder.path(), &["--root", root.to_str().unwrap(), "render", "testfields/chessboard", "-o", "board", "-q"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let stations = table(&folder.path().join("board/stations.csv"));
    let mut photos: Vec<String> = stations.iter().map(|row| format!("board/{}.png", row["image"])).collect();
    let black = image::GrayImage::from_pixel(640, 480, image::Luma([9]));
    black.save(folder.path().join("black.png")).unwrap();
    photos.push("black.png".into());
    // A roundness that corners seen obliquely do not have.
    let mut arguments = vec!["calibrate", "--chessboard", "9x6:25", "-m", "forstner:window=9,roundness=0.98", "--report", "report", "-q"];
    arguments.extend(photos.iter().map(String::as_str));
    let output = run(folder.path(), &arguments);
    assert!(output.status.code() != Some(2), "{}", stderr(&output));
    let rows = table(&folder.path().join("report/residuals.csv"));
    let count = |status: &str| rows.iter().filter(|row| row["status"] == status).count();
    assert!(count("rejected") > 0 && count("used") > 0);
    assert_eq!((count("used") + count("rejected"), count("not_found")), (54 * stations.len(), 1));
    assert!(rows.iter().filter(|row| row["status"] == "rejected").all(|row| row["reason"].contains("forstner") && row["vx"].is_empty()));
    assert!(rows.iter().any(|row| row["image"] == "black.png" && row["reason"].contains("no board of 9 x 6 inner corners")));
    let page = std::fs::read_to_string(folder.path().join("report/README.md")).unwrap();
    assert!(page.contains("were not measured: the method rejected them"), "{page}");
}
