//! What `calibrate` says of boards that are bent and of points that do not fit: image points by a pinhole written out here.

use std::path::Path;

use calibench_exchange::read_control;
use nalgebra::{Rotation3, Vector3};

use crate::calibrate::{number, table, write};
use crate::project::{root, run, stderr, stdout};

/// mm towards the camera: along the rows, along the columns, twist.
const BEND: [f64; 3] = [1.0, -0.4, 0.2];
const CALIBRATE: [&str; 10] =
    ["calibrate", "--points", "points.csv", "--control", "control.csv", "--size", "1600x1200", "--report", "report", "-o"];

/// Roughly normal: twelve numbers of a linear congruential generator (Knuth's MMIX) less six.
fn noise(state: &mut u64) -> f64 {
    let mut uniform = || {
        *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*state >> 11) as f64 / (1_u64 << 53) as f64
    };
    (0..12).map(|_| uniform()).sum::<f64>() - 6.0
}

/// `control.csv` of a board as the program writes it, and `points.csv` of nine views of it, bent, with 0.1 px of noise.
fn board([a, b, c]: [f64; 3]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let output = run(folder.path(), &["control", "9x6:25", "-o", "control.csv"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let control = read_control(&folder.path().join("control.csv")).unwrap();
    assert_eq!((control.len(), control[9].target.as_str(), control[9].position), (54, "r2c1", [0.0, -25.0, 0.0]));
    let (mut text, mut state) = (String::from("image,target,x,y\n"), 11);
    for view in 0..9 {
        let angle = 0.7 * f64::from(view);
        let turn = Rotation3::from_euler_angles(0.45 * angle.cos(), 0.45 * angle.sin(), 0.9 * angle);
        // The camera's axes: x right, y down, z ahead; at the board's middle, `away` from it.
        let axes = turn * Rotation3::from_euler_angles(std::f64::consts::PI, 0.0, 0.0);
        let away = Vector3::new(12.0 * angle.sin(), -9.0 * angle.cos(), 310.0 + 8.0 * f64::from(view));
        for row in &control {
            let [x, y, z] = row.position;
            let (u, v) = (x / 100.0 - 1.0, y / 62.5 + 1.0);
            let lift = a * (1.0 - u * u) + b * (1.0 - v * v) + c * u * v;
            let p = axes * Vector3::new(x - 100.0, y + 62.5, z + lift) + away;
            let (x, y) = (1400.0 * p.x / p.z + 790.0, 1400.0 * p.y / p.z + 605.0);
            assert!((0.0..1600.0).contains(&x) && (0.0..1200.0).contains(&y), "{} in {view}: {x} {y}", row.target);
            text += &format!("v{view}.png,{},{},{}\n", row.target, x + 0.1 * noise(&mut state), y + 0.1 * noise(&mut state));
        }
    }
    write(folder.path(), "points.csv", &text);
    folder
}

fn page(folder: &Path) -> String {
    std::fs::read_to_string(folder.join("report/README.md")).unwrap()
}

#[test]
fn a_bent_board_is_found_and_reported() {
    let folder = board(BEND);
    let output = run(folder.path(), &[&CALIBRATE[..], &["camera.yaml"]].concat());
    assert!(output.status.success(), "{}{}", stdout(&output), stderr(&output));
    assert!(stdout(&output).contains("board: bent (p < 0.0001) by ") && stdout(&output).contains("warning: the board is bent by "));
    let report = folder.path().join("report");
    let rows = table(&report.join("board.csv"));
    assert_eq!(rows.len(), 3);
    for (row, truth) in rows.iter().zip(BEND) {
        let (off, sigma) = (number(row, "value") - truth, number(row, "sigma"));
        assert!(off.abs() < 4.0 * sigma && sigma < 0.1 && row["status"] == "bent", "{row:?}");
    }
    assert!(page(folder.path()).contains("(board.png)") && report.join("board.png").is_file());
    // The middle of the bent board, in the table of points, is where it is.
    let points = read_control(&report.join("points.csv")).unwrap();
    let middle = points.iter().find(|row| row.target == "r3c5").unwrap().position;
    let lift = BEND[0] + BEND[1] * (1.0 - 0.04) + 0.0;
    assert!((middle[2] - lift).abs() < 0.1, "{middle:?} for {lift}");
}

#[test]
fn uncertainty_is_a_table_that_says_what_is_extrapolated() {
    let folder = board([0.0; 3]);
    let output = run(folder.path(), &[&CALIBRATE[..], &["camera.yaml"]].concat());
    assert!(output.status.success(), "{}{}", stdout(&output), stderr(&output));
    assert!(stdout(&output).contains("board: flat, as far as these images tell"), "{}", stdout(&output));
    assert!(stdout(&output).contains("gross errors of image points sound, the coordinates of control points sound"), "{}", stdout(&output));
    let rows = table(&folder.path().join("report/uncertainty.csv"));
    let [far, near] = [0, 1].map(|which| rows.iter().filter(|row| (row["distance"] == "far") == (which == 0)).collect::<Vec<_>>());
    assert_eq!((far.len(), near.len()), (48 * 36, 48 * 36));
    for row in &rows {
        let sum = number(row, "sxx") + number(row, "syy");
        assert!((number(row, "sigma") - sum.sqrt()).abs() < 1e-9 * sum.sqrt() && sum > 0.0, "{row:?}");
    }
    let nearest = |x: f64, y: f64| near.iter().min_by_key(|row| (number(row, "x") - x).hypot(number(row, "y") - y) as i64).unwrap();
    let (middle, corner) = (nearest(800.0, 600.0), nearest(0.0, 0.0));
    assert_eq!((middle["measured"].as_str(), corner["measured"].as_str()), ("inside", "outside"));
    assert!(number(corner, "sigma") > 5.0 * number(middle, "sigma"), "{middle:?} {corner:?}");
    // Standard deviations by images are of the size of the formal ones where noise is all there is.
    let parameters = table(&folder.path().join("report/parameters.csv"));
    let ratio = number(&parameters[0], "sigma_by_images") / number(&parameters[0], "sigma");
    assert!((0.3..3.0).contains(&ratio), "{ratio}");
}

#[test]
fn swapped_names_end_with_exit_code_3_and_everything_written() {
    let folder = board([0.0; 3]);
    let control = std::fs::read_to_string(folder.path().join("control.csv")).unwrap();
    let swapped = control.replace("r2c3,", "?,").replace("r4c5,", "r2c3,").replace("?,", "r4c5,");
    write(folder.path(), "control.csv", &swapped);
    let output = run(folder.path(), &[&CALIBRATE[..], &["camera.yaml"]].concat());
    assert_eq!(output.status.code(), Some(3), "{}{}", stdout(&output), stderr(&output));
    let headline = "doubtful: the names of control points r2c3 and r4c5 are swapped";
    assert!(stdout(&output).starts_with(headline), "{}", stdout(&output));
    assert!(page(folder.path()).starts_with(&format!("# Calibration\n\n**{headline}")), "{}", &page(folder.path())[..400]);
    assert!(page(folder.path()).contains("## What the model may leave out"));
    assert!(folder.path().join("camera.yaml").is_file());
}

#[test]
fn names_in_a_cause_are_no_markup() {
    let folder = board([0.0; 3]);
    for file in ["points.csv", "control.csv"] {
        let text = std::fs::read_to_string(folder.path().join(file)).unwrap();
        let text = text.replace("r2c3,", "<i>|r2c3,");
        let text =
            if file == "control.csv" { text.replace("<i>|r2c3,", "?,").replace("r4c5,", "<i>|r2c3,").replace("?,", "r4c5,") } else { text };
        write(folder.path(), file, &text);
    }
    let output = run(folder.path(), &[&CALIBRATE[..], &["camera.yaml"]].concat());
    assert_eq!(output.status.code(), Some(3), "{}{}", stdout(&output), stderr(&output));
    let page = page(folder.path());
    assert!(page.contains("are swapped") && !page.contains("<i>") && !page.contains("i>|r2c3"), "{}", &page[..400]);
}

#[test]
fn points_outside_the_images_are_said() {
    let folder = board([0.0; 3]);
    let arguments = CALIBRATE.map(|argument| if argument == "1600x1200" { "1000x800" } else { argument });
    let output = run(folder.path(), &[&arguments[..], &["camera.yaml"]].concat());
    assert!(stdout(&output).contains("image points lie outside the images: is their size right (--size)"), "{}", stdout(&output));
    assert_eq!(output.status.code(), Some(3), "{}", stdout(&output));
}

#[test]
fn residuals_that_no_operator_leaves_are_a_doubt() {
    let folder = board([0.0; 3]);
    // Corner after corner as if six stood in a row, and not nine.
    let corner = |i: usize| format!("r{}c{},{},{},0\n", i / 9 + 1, i % 9 + 1, 25 * (i % 6), -25 * (i as i64 / 6));
    write(folder.path(), "control.csv", &(0..54).fold("target,X,Y,Z\n".to_owned(), |all, i| all + &corner(i)));
    let output = run(folder.path(), &[&CALIBRATE[..], &["camera.yaml"]].concat());
    assert_eq!(output.status.code(), Some(3), "{}{}", stdout(&output), stderr(&output));
    assert!(stdout(&output).starts_with("doubtful: residuals of ") && stdout(&output).contains("no operator's"), "{}", stdout(&output));
}

#[test]
fn figures_in_another_unit_are_said() {
    let folder = board([0.0; 3]);
    let calibrated = |more: &[&str]| {
        let output = run(folder.path(), &[&CALIBRATE[..], &["camera.toml"], more].concat());
        assert!(output.status.success(), "{more:?}: {}{}", stdout(&output), stderr(&output));
        stdout(&output)
    };
    let sound = calibrated(&["--pitch", "5.15"]);
    for word in ["is --pitch in", "principal distance of the camera", "neighbours of the board"] {
        assert!(!sound.contains(word), "{sound}");
    }
    // In nm.
    let said = calibrated(&["--pitch", "5150"]);
    assert!(said.contains("warning: a pixel pitch of 5150 um makes a sensor of 8240 mm: is --pitch in micrometres?"), "{said}");
    assert!(page(folder.path()).contains("makes a sensor of 8240 mm"));
    // In um.
    let control = read_control(&folder.path().join("control.csv")).unwrap();
    let rows = control.iter().map(|row| format!("{},{},{},0\n", row.target, 1e3 * row.position[0], 1e3 * row.position[1]));
    write(folder.path(), "control.csv", &format!("target,X,Y,Z\n{}", rows.collect::<String>()));
    let said = calibrated(&[]);
    assert!(said.contains("warning: neighbours of the board are 25000 object units apart"), "{said}");
    // In mm, for 140 px.
    let rows = "rows: 3\n   cols: 3\n   dt: d\n   data: [ 140., 0., 790., 0., 140., 605., 0., 0., 1. ]";
    let distortion = "rows: 1\n   cols: 5\n   dt: d\n   data: [ 0., 0., 0., 0., 0. ]";
    let start = format!(
        "%YAML:1.0\n---\nimage_width: 1600\nimage_height: 1200\ncamera_matrix: !!opencv-matrix\n   {rows}\ndistortion_coefficients: !!opencv-matrix\n   {distortion}\n"
    );
    write(folder.path(), "start.yaml", &start);
    let said = calibrated(&["--start", "start.yaml"]);
    assert!(said.contains("warning: the principal distance of the camera started at 140 px and ended at "), "{said}");
}

/// A sheet with a tag cut out of the first photograph and laid beside it.
#[test]
fn a_tag_that_is_seen_twice_is_said_in_the_answer_the_pages_and_the_exit_code() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let rendered = run(here, &["--root", root().to_str().unwrap(), "render", "targets/aprilgrid", "-o", "tags", "-q"]);
    assert!(rendered.status.success(), "{}", stderr(&rendered));
    let photo = here.join("tags/s01-r1.png");
    let mut image = image::open(&photo).unwrap();
    let tag = image.crop_imm(302, 605, 106, 106);
    image::imageops::replace(&mut image, &tag, 10, 10);
    image.save(&photo).unwrap();
    let photos: Vec<String> = (1..=4).flat_map(|s| [1, 2].map(|r| format!("tags/s0{s}-r{r}.png"))).collect();
    let photos: Vec<&str> = photos.iter().map(String::as_str).collect();
    let board = std::fs::read_to_string(root().join("scenarios/targets/aprilgrid.toml")).unwrap();
    let number = |key: &str| {
        let line = board.lines().find(|line| line.starts_with(&format!("{key} = "))).unwrap();
        line.split_once(" = ").unwrap().1.trim().to_owned()
    };
    let board = format!("aprilgrid:{}x{}:{}:{}", number("columns"), number("rows"), number("tag"), number("spacing"));
    let asked = |command: &str, more: &[&str]| {
        let output = run(here, &[&[command, "--board", &board, "--json", "-q", "--report", command], &photos[..], more].concat());
        assert_eq!(output.status.code(), Some(3), "{command}: {}{}", stdout(&output), stderr(&output));
        let answer: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
        let doubt = answer["doubts"][0].as_str().unwrap().to_owned();
        assert!(doubt.contains("s01-r1.png"), "{answer}");
        assert!(stderr(&output).contains(&format!("in doubt: {doubt}")), "{}", stderr(&output));
        let read = |file: &str| std::fs::read_to_string(here.join(command).join(file)).unwrap();
        assert!(read("README.md").contains("**In doubt**: s01-r1.png"), "{}", read("README.md"));
        let head = read("report.html").split("<nav>").next().unwrap().to_owned();
        assert!(head.contains("class=\"verdict doubt\"") && head.contains(&format!("<li>{doubt}</li>")), "{}", &head[head.len() - 900..]);
    };
    asked("calibrate", &[]);
    asked("judge", &["-m", "parametric_corner", "--model", "opencv4", "--splits", "2"]);
}

/// A check that could not be made leaves no page green.
#[test]
fn what_was_not_tested_is_not_green() {
    let folder = board([0.0; 3]);
    for (more, class) in [(&["out.yaml"][..], "open"), (&["out.yaml", "--sigma", "0.1"], "good")] {
        let output = run(folder.path(), &[&CALIBRATE[..], more].concat());
        assert!(output.status.success(), "{}{}", stdout(&output), stderr(&output));
        let html = std::fs::read_to_string(folder.path().join("report/report.html")).unwrap();
        assert!(html.contains(&format!("class=\"verdict {class}\"")), "{class}: {}", stdout(&output));
        assert_eq!(html.contains("<li>not tested: the precision of image points: "), class == "open");
    }
}
