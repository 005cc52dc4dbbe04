//! What a task costs, as a user asks.

use calibench_report::calibration::CalibratedCameras;
use serde_json::Value;

use crate::calibrate::write;
use crate::project::{root, run, stderr, stdout};

const CAMERA: &str = "%YAML:1.0\n---\nimage_width: 2000\nimage_height: 1500\ncamera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: [ 2000., 0., 999.5, 0., 2000., 749.5, 0., 0., 1. ]\ndistortion_coefficients: !!opencv-matrix\n   rows: 5\n   cols: 1\n   dt: d\n   data: [ 0., 0., 0., 0., 0. ]\n";
const DEVIATIONS: &str = "cameraMatrix_std_dev: !!opencv-matrix\n   rows: 4\n   cols: 1\n   dt: d\n   data: [ 1., 1., 0.5, 0.5 ]\ndist_coeffs_std_dev: !!opencv-matrix\n   rows: 5\n   cols: 1\n   dt: d\n   data: [ 0., 0., 0., 0., 0. ]\n";
const TASK: &str = "unit = \"mm\"\nsigma = 0.1\n[measure]\nlength = [[-50, 0, 0], [50, 0, 0]]\n[known_plane]\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\n[[image]]\ncentre = [0, 0, 800]\nangles = [0, 0, 0]\n";

/// By hand: two image coordinates of 0.1 px at 0.4 mm a pixel are 0.0566 mm, with a camera known to 1 in 2000 at 100 mm 0.0755.
#[test]
fn an_answer_is_in_millimetres_and_says_what_it_takes_as_exact() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    write(here, "bare.yaml", CAMERA);
    write(here, "known.yaml", &format!("{CAMERA}{DEVIATIONS}"));
    write(here, "task.toml", TASK);
    let bare = run(here, &["task", "task.toml", "--camera", "bare.yaml"]);
    let words = stdout(&bare);
    assert_eq!(bare.status.code(), Some(3), "{words}{}", stderr(&bare));
    assert!(stderr(&bare).contains("in doubt: the camera's file says nothing of its uncertainty"), "{}", stderr(&bare));
    assert!(
        words.starts_with("length 100 mm: within \u{b1} 0.111 mm in 95 of 100 measurements (standard uncertainty 0.0566 mm)\n"),
        "{words}"
    );
    for exact in [
        "the camera (its file has no covariance)",
        "projection centres",
        "rotations of images",
        "the position of the plane",
        "the scale",
        "the object's temperature",
    ] {
        assert!(words.contains(&format!("taken as exact: {exact}")), "{exact}: {words}");
    }
    let known = run(here, &["task", "task.toml", "--camera", "known.yaml", "--json", "--map", "map.png", "--halves", "1.25"]);
    assert_eq!(known.status.code(), Some(0), "{}", stderr(&known));
    let found: Value = serde_json::from_str(&stdout(&known)).unwrap();
    let number = &found["numbers"][0];
    assert!((number["sigma"].as_f64().unwrap() / 0.0566_f64.hypot(1.25 * 0.05) - 1.0).abs() < 0.01, "{found}");
    let share: f64 = number["sources"].as_array().unwrap().iter().map(|one| one["share"].as_f64().unwrap()).sum();
    assert!((share - 1.0).abs() < 1e-9 && found["uncorrelated"] == true && number["unit"] == "mm" && found["halves"] == 1.25, "{found}");
    assert_eq!((found["maps"][0]["across"].as_str(), found["maps"][0]["at"].as_f64()), (Some("Z"), Some(0.0)));
    assert!(std::fs::read(here.join("map.png")).unwrap().starts_with(b"\x89PNG"));
    // A board in the plane gives the pose with the same camera, whose errors it makes up for.
    let held = run(here, &["task", "task.toml", "--camera", "known.yaml", "--board", "9x6:25", "--json"]);
    assert_eq!(held.status.code(), Some(0), "{}", stderr(&held));
    let held: Value = serde_json::from_str(&stdout(&held)).unwrap();
    let camera = held["numbers"][0]["sources"].as_array().unwrap().iter().find(|one| one["source"] == "camera").unwrap();
    assert!(camera["sigma"].as_f64().unwrap() < 0.045, "{held}");
    assert!(held["exact"].as_array().unwrap().iter().any(|one| one.as_str().unwrap().starts_with("the flatness of control")), "{held}");
}

/// The folder of a calibration tells more than a camera file: correlations, what leaving photographs out shows, and doubts.
#[test]
fn a_calibrations_folder_has_the_camera_and_what_is_in_doubt() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    for name in ["points.csv", "scale.csv"] {
        std::fs::copy(root().join("examples/acceptance").join(name), here.join(name)).unwrap();
    }
    let calibrate = [
        "calibrate",
        "-q",
        "--points",
        "points.csv",
        "--distances",
        "scale.csv",
        "--size",
        "4032x3024",
        "--sigma",
        "0.1",
        "--report",
        "report",
    ];
    let calibrated = run(here, &calibrate);
    assert!(calibrated.status.success(), "{}", stderr(&calibrated));
    let pair = "[[image]]\ncentre = [-600, 0, 3000]\ntarget = [0, 0, 0]\nsigma_centre = 0.05\nsigma_angles = 0.002\n[[image]]\ncentre = [600, 0, 3000]\ntarget = [0, 0, 0]\nsigma_centre = 0.05\nsigma_angles = 0.002\n";
    write(here, "task.toml", &format!("unit = \"mm\"\nsigma = 0.1\n[measure]\npoint = [100, 0, 50]\n{pair}"));
    let answer = |more: &[&str]| {
        let output = run(here, &[&["task", "task.toml", "--calibration", "report", "--json"][..], more].concat());
        (output.status.code(), serde_json::from_str::<Value>(&stdout(&output)).unwrap_or_else(|_| panic!("{}", stderr(&output))))
    };
    let (code, found) = answer(&[]);
    assert!(code == Some(0) && found["uncorrelated"] == false && found["numbers"].as_array().unwrap().len() == 3, "{found}");
    let file = here.join("report/cameras.json");
    let mut cameras = CalibratedCameras::parse(&std::fs::read_to_string(&file).unwrap()).unwrap();
    // Of a network whose points are unknown no photographs are left out: what its model leaves is not known, and said.
    let says_model =
        |found: &Value| found["exact"].as_array().unwrap().iter().any(|one| one.as_str().unwrap().starts_with("the camera's model"));
    assert!(cameras.cameras[0].halves().is_none() && found["halves"].is_null() && says_model(&found), "{found}");
    cameras.cameras[0].by_images_px = cameras.cameras[0].formal_px.map(|px| 1.5 * px);
    std::fs::write(&file, serde_json::to_string(&cameras).unwrap()).unwrap();
    let (_, known) = answer(&[]);
    assert!((known["halves"].as_f64().unwrap() - 1.5).abs() < 1e-9 && !says_model(&known), "{known}");
    let sigma = |found: &Value, source: &str| {
        let all = found["numbers"][2]["sources"].as_array().unwrap();
        all.iter().find(|one| one["source"] == source).and_then(|one| one["sigma"].as_f64())
    };
    let (_, doubled) = answer(&["--halves", "2"]);
    let ratio = sigma(&doubled, "model error").unwrap() / sigma(&doubled, "camera").unwrap();
    assert!((ratio - 3.0_f64.sqrt()).abs() < 1e-9, "{ratio}");
    cameras.doubts.push("the board is no board".into());
    cameras.cameras.push(cameras.cameras[0].clone());
    std::fs::write(&file, serde_json::to_string(&cameras).unwrap()).unwrap();
    let several = run(here, &["task", "task.toml", "--calibration", "report"]);
    assert!(several.status.code() == Some(2) && stderr(&several).contains("has several cameras"), "{}", stderr(&several));
    let name = cameras.cameras[0].named.name.clone();
    let doubted = run(here, &["task", "task.toml", "--calibration", "report", "--camera-name", &name]);
    assert!(
        doubted.status.code() == Some(3) && stderr(&doubted).contains("in doubt: the calibration: the board is no board"),
        "{}",
        stderr(&doubted)
    );
    std::fs::write(&file, "{}").unwrap();
    let none = run(here, &["task", "task.toml", "--calibration", "report"]);
    assert!(
        none.status.code() == Some(2) && stderr(&none).contains("cameras.json: is no file that `calibench calibrate --report` wrote"),
        "{}",
        stderr(&none)
    );
}

#[test]
fn what_is_no_task_is_refused_and_what_is_bent_is_doubted() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    write(here, "camera.yaml", &format!("{CAMERA}{DEVIATIONS}"));
    for (text, words) in [
        (TASK.replace("sigma = 0.1", "sigma = 0"), "expected a standard deviation above 0"),
        (TASK.replace("[known_plane]", "[plain]"), "unknown field `plain`"),
        (TASK.replace("[50, 0, 0]]", "[5000, 0, 0]]"), "point 2 of what is measured lies in the frame of 0 images"),
    ] {
        write(here, "task.toml", &text);
        let refused = run(here, &["task", "task.toml", "--camera", "camera.yaml"]);
        assert!(refused.status.code() == Some(2) && stderr(&refused).contains(words), "{words}: {}", stderr(&refused));
    }
    // Two rays that hardly cross: depth errs by as much as it is.
    let far = "sigma = 30.0\n[measure]\nlength = [[0, 0, 0], [0, 0, 300]]\n[[image]]\ncentre = [-30, 0, 1000]\nangles = [0, 0, 0]\n[[image]]\ncentre = [30, 0, 1000]\nangles = [0, 0, 0]\n";
    write(here, "task.toml", far);
    let doubted = run(here, &["task", "task.toml", "--camera", "camera.yaml"]);
    assert!(
        doubted.status.code() == Some(3) && stderr(&doubted).contains("in doubt: the errors are so large"),
        "{}{}",
        stdout(&doubted),
        stderr(&doubted)
    );
}
