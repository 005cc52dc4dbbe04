//! `--json`: answers for programs. Their numbers are those of the files and the words, and their exit codes the same.

use std::path::Path;
use std::process::Output;

use calibench_report::json::{COMMANDS, schema_of};
use serde_json::Value;

use crate::calibrate::{Table, WALL, number, table, wall, write};
use crate::project::{root, run, stderr, stdout};

/// The one document that a command answers.
fn answer(output: &Output) -> Value {
    let found: Value =
        serde_json::from_str(&stdout(output)).unwrap_or_else(|error| panic!("{error}: {}{}", stdout(output), stderr(output)));
    assert!(found["calibench"] == env!("CARGO_PKG_VERSION") && found["schema"].is_u64(), "{found}");
    assert!(COMMANDS.contains(&found["command"].as_str().unwrap()), "{found}");
    found
}

fn list(value: &Value) -> &[Value] {
    value.as_array().unwrap_or_else(|| panic!("no list: {value}"))
}

fn cell(row: &std::collections::HashMap<String, String>, column: &str) -> Option<f64> {
    Some(row[column].as_str()).filter(|text| !text.is_empty()).map(|text| text.parse().unwrap())
}

#[test]
fn the_committed_schemas_are_current() {
    for command in COMMANDS {
        let schema = schema_of(command).unwrap();
        let file = root().join(format!("docs/schemas/{command}-{}.schema.json", schema["properties"]["schema"]["const"]));
        let committed = std::fs::read_to_string(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
        assert!(
            committed == format!("{schema:#}\n"),
            "{} is stale: run `just schema`; where a key went or came to mean something else, its answer has a new version first",
            file.display()
        );
    }
    let files = std::fs::read_dir(root().join("docs/schemas")).unwrap().count();
    assert!(files >= COMMANDS.len() && schema_of("show").is_none());
}

#[test]
fn a_calibration_is_told_as_its_tables_tell_it() {
    let folder = wall();
    let words = run(folder.path(), &WALL);
    let output = run(folder.path(), &[&WALL[..], &["--json", "--report", "report", "--compare", "c,x0,y0;c,x0,y0,k1"]].concat());
    assert_eq!((output.status.code(), words.status.code()), (Some(0), Some(0)), "{}", stderr(&output));
    let found = answer(&output);
    assert!(found["command"] == "calibrate" && list(&found["doubts"]).is_empty(), "{found}");
    let words = stdout(&words);
    for check in list(&found["checks"]) {
        let what = check["what"].as_str().unwrap();
        let told = if check["verdict"] == "untested" { "not tested" } else { "sound" };
        assert!(words.contains(&format!("{what} {told}")), "{check}: {words}");
        assert_eq!(list(&found["untested"]).iter().any(|line| line.as_str().unwrap().starts_with(what)), told == "not tested", "{found}");
    }
    let read = |name: &str| table(&folder.path().join("report").join(name));
    same_parameters(&found, &read("parameters.csv"));
    let stations = read("stations.csv");
    assert_eq!(list(&found["images"]).len(), stations.len());
    for (image, row) in list(&found["images"]).iter().zip(&stations) {
        assert_eq!(image["name"], row["image"].as_str());
        for (place, [column, sigma]) in [["X0", "sX0"], ["Y0", "sY0"], ["Z0", "sZ0"]].into_iter().enumerate() {
            assert_eq!(image["centre"][place].as_f64(), cell(row, column), "{image}");
            assert_eq!(image["centre_sigma"][place].as_f64(), cell(row, sigma), "{image}");
        }
        for (place, column) in ["omega_deg", "phi_deg", "kappa_deg"].into_iter().enumerate() {
            assert_eq!(image["angles_deg"][place].as_f64(), cell(row, column), "{image}");
        }
    }
    let residuals = read("residuals.csv");
    let squares = residuals.iter().map(|row| number(row, "vx").powi(2) + number(row, "vy").powi(2)).sum::<f64>();
    let rms = (squares / residuals.len() as f64).sqrt();
    assert!((found["rms_px"].as_f64().unwrap() / rms - 1.0).abs() < 1e-12, "{rms}");
    let counts = |key: &str| found["counts"][key].as_i64().unwrap();
    assert_eq!(counts("image_points"), residuals.len() as i64);
    assert_eq!(counts("observations") + counts("constraints") - counts("unknowns"), counts("redundancy"));
    let of_image = |name: &Value| residuals.iter().filter(|row| *name == row["image"].as_str()).count();
    assert!(list(&found["images"]).iter().all(|image| image["points"] == of_image(&image["name"])));
    let sets = read("sets.csv");
    for (place, set) in list(&found["sets"]).iter().enumerate() {
        let row = sets.iter().find(|row| row["set"] == (place + 1).to_string()).unwrap();
        assert_eq!((set["sigma0_px"].as_f64(), set["aicc"].as_f64()), (cell(row, "sigma0_px"), cell(row, "aicc")));
        assert_eq!((set["against"].as_f64(), set["f_p"].as_f64()), (cell(row, "against"), cell(row, "f_p")));
    }
    assert_eq!(list(&found["sets"]).len(), 2);
}

fn same_parameters(found: &Value, rows: &Table) {
    let camera = &found["cameras"][0];
    let parameters = list(&camera["camera"]["parameters"]);
    assert_eq!(parameters.len(), rows.len());
    for (parameter, row) in parameters.iter().zip(rows) {
        assert_eq!((&parameter["name"], &parameter["unit"]), (&Value::from(row["parameter"].as_str()), &Value::from(row["unit"].as_str())));
        assert_eq!((parameter["value"].as_f64(), parameter["sigma"].as_f64()), (cell(row, "value"), cell(row, "sigma")), "{parameter}");
        let solved = list(&camera["solved"]).iter().find(|solved| solved["parameter"] == parameter["name"]);
        assert_eq!(solved.is_some(), row["status"] != "fixed", "{parameter}");
        let Some(solved) = solved else { continue };
        for (key, column) in [("sigma", "sigma"), ("sigma_by_images", "sigma_by_images"), ("t", "t"), ("p", "p")] {
            assert_eq!(solved[key].as_f64(), cell(row, column), "{key} of {parameter}");
        }
    }
    let covariance = &camera["camera"]["covariance"];
    for (place, name) in list(&covariance["parameters"]).iter().enumerate() {
        let sigma = parameters.iter().find(|parameter| parameter["name"] == *name).unwrap()["sigma"].as_f64().unwrap();
        assert!((covariance["values"][place][place].as_f64().unwrap().sqrt() / sigma - 1.0).abs() < 1e-12, "{name}");
    }
}

/// An image point in gross error: kept, it is a doubt; by default it is left out, and named.
#[test]
fn doubts_are_told_and_end_with_their_exit_code() {
    let folder = wall();
    let mut points = std::fs::read_to_string(folder.path().join("points.csv")).unwrap();
    let moved = points.lines().filter(|line| line.contains(",measured,")).nth(7).unwrap().to_owned();
    let cells: Vec<&str> = moved.split(',').collect();
    let x: f64 = cells[2].parse().unwrap();
    points = points.replacen(&moved, &moved.replacen(cells[2], &(x + 4.0).to_string(), 1), 1);
    write(folder.path(), "points.csv", &points);
    let words = run(folder.path(), &[&WALL[..], &["--plain"]].concat());
    let output = run(folder.path(), &[&WALL[..], &["--json", "--plain"]].concat());
    let found = answer(&output);
    assert_eq!((output.status.code(), words.status.code()), (Some(3), Some(3)), "{found}");
    let headline = stdout(&words).lines().next().unwrap().to_owned();
    let doubts: Vec<&str> = list(&found["doubts"]).iter().map(|doubt| doubt.as_str().unwrap()).collect();
    assert_eq!(headline, format!("doubtful: {}", doubts.join("; ")));
    let doubted = list(&found["doubted"]);
    assert_eq!(doubted.iter().map(|doubt| doubt["words"].as_str().unwrap()).collect::<Vec<_>>(), doubts);
    assert_eq!(doubted.iter().map(|doubt| doubt["subject"].as_str().unwrap()).collect::<Vec<_>>(), ["precision", "gross-errors"]);
    let number = |key: &str| doubted[1][key].as_f64().unwrap();
    assert!(number("p") < 1e-4 && number("moves") > 3.0 && doubted[1]["camera"].is_null(), "{found}");
    // What is refused says so in words, and answers nothing.
    let refused = run(folder.path(), &["calibrate", "--json", "--points", "none.csv", "--control", "control.csv", "--size", "1600x1200"]);
    assert_eq!((refused.status.code(), stdout(&refused).as_str()), (Some(2), ""));
    // Rejected points are named.
    for asked in [&["--json"][..], &["--json", "--snoop"]] {
        let output = run(folder.path(), &[&WALL[..], asked].concat());
        let found = answer(&output);
        let rejected = &list(&found["rejected"])[0];
        assert_eq!((rejected["image"].as_str(), rejected["target"].as_str()), (Some(cells[0]), Some(cells[1])), "{found}");
        assert!(rejected["left_out"] == true && found["counts"]["not_in_full"].as_u64() >= Some(1), "{found}");
        assert!(output.status.success(), "{found}");
    }
    let said = format!("1 image points were rejected and left out: the worst, {} in {}, is ", cells[1], cells[0]);
    assert!(stdout(&run(folder.path(), &WALL)).contains(&said));
}

#[test]
fn cameras_are_told_compared_and_converted() {
    let folder = wall();
    let here = folder.path();
    let shown = answer(&run(here, &["camera", "wall/camera.toml", "--json"]));
    let truth = calibench_cameras::read_camera(&here.join("wall/camera.toml")).unwrap().cameras.remove(0);
    let values: Vec<f64> = calibench_model::camera::CameraModel::parameters(&truth.camera).iter().map(|p| p.value).collect();
    let told = |camera: &Value| list(&camera["parameters"]).iter().map(|p| p["value"].as_f64().unwrap()).collect::<Vec<_>>();
    assert_eq!(told(&shown["camera"]), values);
    assert_eq!(
        (shown["count"].as_u64(), list(&shown["cameras"]).len(), shown["camera"]["size"]["width"].as_u64()),
        (Some(1), 1, Some(1600))
    );
    let words = stdout(&run(here, &["camera", "wall/camera.toml"]));
    let wide = shown["frame"]["view_wide_deg"].as_f64().unwrap();
    assert!(words.contains(&format!("{wide:.2}\u{b0} wide")) && shown["frame"]["without_ray"] == 0.0, "{words}");
    let corner = shown["frame"]["distortion_px"][2].as_f64().unwrap();
    assert!(words.contains(&format!(", {} px, ", calibench_report::plain(corner))), "{words}");

    let converted = run(here, &["convert", "wall/camera.toml", "--to", "opencv", "--json", "-o", "cv.yaml", "-q"]);
    let found = answer(&converted);
    assert_eq!((found["output"].as_str(), found["to"].as_str()), (Some("cv.yaml"), Some("opencv-yaml")));
    let camera = &found["cameras"][0];
    assert!(["exact", "fitted"].contains(&camera["method"].as_str().unwrap()) && camera["verdict"] == "good", "{camera}");
    assert_eq!(told(&camera["camera"]), told(&answer(&run(here, &["camera", "cv.yaml", "--json"]))["camera"]));
    // The residuals of the conversion are what the two differ by without a rotation.
    let apart = answer(&run(here, &["diff", "cv.yaml", "wall/camera.toml", "--no-rotation", "--json"]));
    let [fitted, after] = [&camera["residuals"], &apart["difference"]].map(|sizes| sizes["rms_px"].as_f64().unwrap());
    assert!((fitted - after).abs() <= 0.05 * fitted + 1e-9, "{fitted} and {after}");
    assert!(apart["rotation_deg"].is_null() && apart["inside"].is_null() && apart["on_object"].is_null(), "{apart}");

    write(here, "plain.yaml", OTHER);
    let naive = answer(&run(here, &["convert", "plain.yaml", "--to", "photogrammetric", "--naive", "--pitch", "4.5", "--json"]));
    assert_eq!((naive["cameras"][0]["method"].as_str(), naive["output"].as_str()), (Some("naive"), None));
    let arguments = ["diff", "cv.yaml", "wall/camera.toml", "--points", "points.csv", "--distance", "8"];
    let words = stdout(&run(here, &arguments));
    let apart = answer(&run(here, &[&arguments[..], &["--json"]].concat()));
    for part in ["inside", "outside"] {
        let [rms, most] = ["rms_px", "max_px"].map(|key| calibench_report::plain(apart[part][key].as_f64().unwrap()));
        assert!(words.lines().any(|line| line.starts_with(part) && line.contains(&format!("{rms} px RMS, {most} px at most"))), "{words}");
    }
    let object = &apart["on_object"];
    let ratio = object["rms"].as_f64().unwrap() / apart["difference"]["rms_px"].as_f64().unwrap();
    assert!(
        object["distance"] == 8.0
            && (ratio / (object["max"].as_f64().unwrap() / apart["difference"]["max_px"].as_f64().unwrap()) - 1.0).abs() < 1e-9
    );
}

#[test]
fn measured_points_are_told_row_by_row() {
    let folder = wall();
    let here = folder.path();
    write(here, "starts.csv", &(std::fs::read_to_string(here.join("starts.csv")).unwrap() + "gone.png,\u{202e}x,5,5\n"));
    let photos: Vec<String> =
        table(&here.join("wall/stations.csv")).iter().map(|station| format!("wall/{}.png", station["image"])).collect();
    let mut arguments = vec!["measure", "--points", "starts.csv", "-m", "forstner:window=11", "-m", "pixel", "-o", "p.csv", "--json"];
    arguments.extend(photos.iter().map(String::as_str));
    let output = run(here, &arguments);
    assert!(!stdout(&output).contains('\u{202e}'), "a name turns no text round");
    let (found, rows) = (answer(&output), quoted_table(&here.join("p.csv")));
    let points = list(&found["points"]);
    assert_eq!(points.len(), rows.len());
    for (point, row) in points.iter().zip(&rows) {
        assert_eq!(
            [&point["image"], &point["target"], &point["method"], &point["status"]].map(|text| text.as_str().unwrap()),
            [row["image"].as_str(), &row["target"], &row["method"], &row["status"]]
        );
        for column in ["x", "y", "sxx", "sxy", "syy"] {
            assert_eq!(point[column].as_f64(), cell(row, column), "{point}");
        }
        assert_eq!(point["reason"].as_str().unwrap_or_default(), row["reason"], "{point}");
    }
    for status in ["measured", "rejected", "unavailable"] {
        assert_eq!(found["counts"][status], rows.iter().filter(|row| row["status"] == status).count(), "{status}");
    }
    assert_eq!(found["counts"]["unavailable"], 2);
}

#[test]
fn a_judgement_is_told_as_its_table_tells_it() {
    let folder = tempfile::tempdir().unwrap();
    let images = crate::judge::board(folder.path());
    let more = ["-m", "pixel", "-m", "parametric_corner", "--model", "opencv4:fx,fy,cx,cy", "--model", "opencv4+bent", "--splits", "3"];
    let output = crate::judge::judge(folder.path(), &images, &[&more[..], &["--json", "--report", "page"]].concat());
    let words = crate::judge::judge(folder.path(), &images, &more);
    assert_eq!((output.status.code(), words.status.code()), (Some(0), Some(0)), "{}", stderr(&output));
    let found = answer(&output);
    assert_eq!((found["operator"].as_str(), found["model"].as_str()), (Some("parametric_corner:window=15"), Some("opencv4+bent")));
    let lines: Vec<String> = list(&found["words"]).iter().map(|line| format!("- {}\n", line.as_str().unwrap())).collect();
    assert_eq!(lines.concat(), stdout(&words));
    assert!(list(&found["doubts"]).is_empty() && found["in_use"].is_null() && found["published"].is_null(), "{found}");
    let px = |key: &str| calibench_report::plain(found[key].as_f64().unwrap());
    let (centre, corner, limit) = (px("sigma_centre_px"), px("sigma_corner_px"), px("limit_px"));
    for figure in [format!("{centre} px in the centre of the frame and {corner} px in its worst corner"), format!("within {limit} px RMS")]
    {
        assert!(stdout(&words).contains(&figure), "{figure}: {}", stdout(&words));
    }
    let halves = ["ratio", "ratio_of_modes"].map(|key| format!("{:.2}", found["halves"][key].as_f64().unwrap()));
    assert!(
        stdout(&words)
            .contains(&format!("differ by {} times what the sigmas say over the frame, {} times mode by mode", halves[0], halves[1]))
    );
    let rows = quoted_table(&folder.path().join("page/judgement.csv"));
    let of_view = |measure: &str, name: &Value| {
        let mut own = rows.iter().filter(|row| {
            row["method"] == "parametric_corner:window=15"
                && row["model"] == "opencv4+bent"
                && row["measure"] == measure
                && *name == row["place"].as_str()
        });
        own.next().map(|row| number(row, "value"))
    };
    let photographs = list(&found["photographs"]);
    assert_eq!(photographs.len(), images.len());
    for photograph in photographs {
        assert_eq!(photograph["rms_px"].as_f64(), of_view("residuals", &photograph["name"]), "{photograph}");
        assert_eq!(photograph["holdout_px"].as_f64(), of_view("holdout", &photograph["name"]), "{photograph}");
    }
    let best = list(&found["operators"]);
    assert!(best.len() == 2 && best[0]["p"].is_null() && best[1]["method"] == "pixel" && best[1]["p"].as_f64() < Some(0.05), "{found}");
    // The camera of another board.
    write(folder.path(), "other.yaml", OTHER);
    for (margin, code, verdict) in [("1", 1, "moved"), ("1000", 0, "holds")] {
        let more = [&more[..], &["--camera", "other.yaml", "--margin", margin, "--json"]].concat();
        let output = crate::judge::judge(folder.path(), &images, &more);
        let found = answer(&output);
        assert_eq!((output.status.code(), found["in_use"]["verdict"].as_str()), (Some(code), Some(verdict)), "{found}");
        assert!(found["published"]["rms_px"] == found["in_use"]["apart_px"], "{found}");
    }
}

/// Rows of a table with comments before it and commas in cells.
fn quoted_table(path: &Path) -> Table {
    let text = std::fs::read_to_string(path).unwrap();
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_reader(text.as_bytes());
    reader.deserialize().map(|row| row.unwrap()).collect()
}

const OTHER: &str = "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\ncamera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   \
                     data: [ 700., 0., 320., 0., 700., 240., 0., 0., 1. ]\ndistortion_coefficients: !!opencv-matrix\n   rows: 1\n   cols: 5\n   dt: d\n   \
                     data: [ -0.1, 0., 0., 0., 0. ]\n";
