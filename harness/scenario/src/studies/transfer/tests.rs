//! Every kind of mistake in the tables is one diagnostic: place, what was expected, nearest name.

use std::fs;
use std::path::Path;

use calibench_measure::registry::Build;
use calibench_measure::{Registry, opencv_subpix};

use super::{Calibrates, Solver};
use crate::{StudyPlan, Subject, Transfer, parse};

const GOOD: &str = r#"why = "A transfer."
source = "a test"
seed = 1
trials = 3
[transfer]
apply = "wall.toml"
stations = ["*"]
control = ["G*"]
check = ["V*"]
sigma_px = 0.5
survey_sigma = 0.002
pitch = 5.38085
sensor_width = 22.0
start_c = 18.0
poses_of = "control"
[transfer.board]
file = "board.toml"
views = 17
distance = [600, 900]
tilt = 35
aside = [280, 180]
[[transfer.method]]
name = "control"
from = "control"
model = "metashape"
parameters = ["f", "cx", "cy", "k1"]
[[transfer.method]]
name = "board"
from = "board"
model = "opencv"
sigma_px = 0.03
[[transfer.method]]
name = "nothing"
from = "nothing"
[[transfer.case]]
name = "plain"
poses = "held"
methods = ["b*"]
[[transfer.decomposition]]
name = "split"
methods = ["board"]
bend = 1.0
"#;

/// With the one method of the wall and the board that is not built in.
fn registry() -> Registry {
    Registry::builtin().with(opencv_subpix::method(Build::Unavailable("a test"), "none".into()))
}

/// The text in the folder of the project's scenarios; its diagnostics, one a line, with the folder left out.
fn read_in(folder: &Path, text: &str) -> Result<Transfer, String> {
    let path = folder.join("test.toml").display().to_string();
    let scenario = parse("canon-t3/test", &path, text, &registry()).map_err(|problems| problems.to_string().replace(&path, "test.toml"))?;
    let Subject::Views(views) = scenario.subject else { panic!("a scenario of views") };
    Ok(views.study.transfer().unwrap().clone())
}

fn diagnostics(old: &str, new: &str) -> String {
    assert_eq!(GOOD.matches(old).count(), 1, "`{old}` stands once");
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/canon-t3");
    read_in(&folder, &GOOD.replace(old, new)).err().unwrap_or_default()
}

#[test]
fn the_good_scenario_is_read() {
    assert_eq!(diagnostics("seed = 1", "seed = 2"), "");
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/canon-t3");
    let found = read_in(&folder, GOOD).unwrap();
    assert_eq!((found.stations.len(), found.control.len(), found.check.len()), (12, 33, 14));
    assert_eq!(found.sets(), ["plain", "split"]);
    assert_eq!((found.cases[0].methods.as_slice(), found.poses_of), (&[1][..], 0));
    assert_eq!(found.methods[1].parameters.len(), 9);
    let names: Vec<&str> = found.decompositions[0].switches.iter().map(|switch| switch.name()).collect();
    assert_eq!(names, ["measurement", "survey", "naive conversion", "exchanged poses", "bent board"]);
}

#[test]
fn pitches_that_disagree_are_said() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/canon-t3");
    let warning = read_in(&folder, GOOD).unwrap().warning().unwrap();
    assert!(warning.contains("5.38085 um") && warning.contains("5.14981 um, -4.29 %"), "{warning}");
    let agreeing = GOOD.replace("sensor_width = 22.0", "sensor_width = 22.987");
    assert_eq!(read_in(&folder, &agreeing).unwrap().warning(), None);
}

#[test]
fn images_are_measured_by_what_is_named() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/canon-t3");
    let measured = GOOD
        .replace("sigma_px = 0.5", "sigma_px = 0.5\nmeasured_by = \"forstner:window=15\"")
        .replace("sigma_px = 0.03", "sigma_px = 0.03\nmeasured_by = \"opencv_subpix\"\ndetected = true\nsolver = \"opencv\"");
    let found = read_in(&folder, &measured).unwrap();
    assert_eq!(found.measured_by.unwrap().operator.label, "forstner:window=15");
    let board = found.methods[1].measured_by.as_ref().unwrap();
    assert!(board.detected && board.operator.operator.is_err(), "{board:?}");
    assert_eq!(found.methods[1].calibrates, Calibrates::FromBoard { sigma_px: 0.03, solver: Solver::Opencv });
    let unknown = read_in(&folder, &measured.replace("forstner:window", "forster:window")).unwrap_err();
    assert!(unknown.starts_with("test.toml:11:15: no method is called `forster`") && unknown.lines().count() == 1, "{unknown}");
    let drawn = measured.replace("methods = [\"b*\"]", "board_sigma_px = 0.2");
    let wrong = read_in(&folder, &drawn).unwrap_err();
    assert!(wrong.starts_with("test.toml:42:18: `board_sigma_px` is of corners that are drawn"), "{wrong}");
}

/// Stations of a case are of those where calibrations are applied; the same ones are one network.
#[test]
fn networks_are_of_fewer_stations() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/canon-t3");
    let text = GOOD
        .replace("stations = [\"*\"]", "stations = [\"?\"]")
        .replace("methods = [\"b*\"]", "stations = [\"1*\", \"2\"]")
        .replace("bend = 1.0", "stations = [\"1\", \"2\"]");
    let found = read_in(&folder, &text).unwrap();
    assert_eq!((found.stations.len(), &found.networks), (9, &vec![vec![0, 1]]));
    assert_eq!((found.cases[0].conditions.network, found.decompositions[0].on.network), (Some(0), Some(0)));
    let names: Vec<&str> = found.decompositions[0].switches.iter().map(|switch| switch.name()).collect();
    assert_eq!(names.last(), Some(&"network"));
}

#[test]
fn each_mistake_is_one_diagnostic_with_its_place() {
    let cases: &[(&str, &str, &str, &[&str])] = &[
        ("\"k1\"]", "\"k9\"]", "26:32", &["the model metashape has no parameter `k9`: expected some of f, cx"]),
        ("parameters = [\"f\", \"cx\", \"cy\", \"k1\"]", "parameters = []", "26:14", &["`parameters` is empty"]),
        ("apply = \"wall.toml\"", "apply = \"wal.toml\"", "6:9", &["`wal.toml` cannot be read"]),
        ("apply = \"wall.toml\"", "apply = \"study.toml\"", "6:9", &["`study.toml` has a [transfer] itself"]),
        ("stations = [\"*\"]", "stations = [\"13\"]", "7:13", &["no station is called `13`"]),
        ("stations = [\"*\"]", "stations = [\"12\"]", "7:12", &["applied in 1 stations: expected at least 2"]),
        ("stations = [\"*\"]", "stations = []", "7:12", &["`stations` is empty"]),
        ("control = [\"G*\"]", "control = [\"H*\"]", "8:12", &["no target is called `H*`"]),
        ("control = [\"G*\"]", "control = [\"G1\", \"G2\", \"G3\"]", "8:11", &["3 control points: expected at least 4"]),
        ("check = [\"V*\"]", "check = [\"V*\", \"G1\"]", "9:9", &["`G1` is a control point and a check point"]),
        ("check = [\"V*\"]", "check = []", "9:9", &["`check` is empty"]),
        ("poses_of = \"control\"", "poses_of = \"contrl\"", "15:12", &["no method is called `contrl`", "did you mean `control`"]),
        ("poses_of = \"control\"", "poses_of = \"board\"", "15:12", &["`board` has no exterior orientations there"]),
        ("views = 17", "views = 2", "18:9", &["2 views of the board: expected at least 3"]),
        ("tilt = 35", "tilt = 0", "20:8", &["all boards are parallel"]),
        ("file = \"board.toml\"", "file = \"wall.toml\"", "17:8", &["`wall.toml` has no chessboard"]),
        ("model = \"opencv\"\n", "", "27:1", &["method `board` calibrates and has no `model`"]),
        ("sigma_px = 0.03\n", "", "29:8", &["method `board` calibrates from a board and has no `sigma_px`"]),
        ("model = \"metashape\"", "model = \"metashape\"\nsigma_px = 1", "26:12", &["expected `from = \"board\"`"]),
        ("name = \"nothing\"", "name = \"board\"", "33:8", &["the name `board` is empty or taken"]),
        ("methods = [\"b*\"]", "methods = [\"c?\"]", "38:12", &["no method is called `c?`"]),
        ("name = \"split\"", "name = \"plain\"", "40:8", &["the name `plain` is taken"]),
        ("poses = \"held\"", "poses = \"hold\"", "37:9", &["hold", "resected"]),
        ("survey_sigma = 0.002", "survey_sigmas = 0.002", "11:1", &["unknown key `survey_sigmas`", "did you mean `survey_sigma`"]),
        ("[[transfer.case]]\nname = \"plain\"\nposes = \"held\"\nmethods = [\"b*\"]\n", "", "5:2", &["without a [[transfer.case]]"]),
        ("bend = 1.0", "stations = [\"1\"]", "42:12", &["1 stations are left: expected at least 2"]),
        ("bend = 1.0", "stations = [\"13\"]", "42:13", &["no station is called `13`"]),
        ("poses = \"held\"", "poses = \"held\"\nstations = []", "38:12", &["`stations` is empty"]),
        (
            "sigma_px = 0.5",
            "sigma_px = 0.5\nmeasured_by = \"pixel\"",
            "30:8",
            &["method `board` calibrates from a board and has no `measured_by`"],
        ),
        ("sigma_px = 0.03", "sigma_px = 0.03\nmeasured_by = \"pixel\"", "32:15", &["expected one in [transfer] too"]),
        (
            "name = \"nothing\"",
            "name = \"nothing\"\nmeasured_by = \"pixel\"",
            "34:15",
            &["`measured_by` of a method is what measures a board's corners"],
        ),
        ("name = \"nothing\"", "name = \"nothing\"\nsolver = \"own\"", "34:10", &["`solver` of a method is what makes a camera"]),
        (
            "sigma_px = 0.03",
            "sigma_px = 0.03\nsolver = \"opencv\"\nparameters = [\"fx\"]",
            "32:10",
            &["expected `model = \"opencv\"` and no `parameters`"],
        ),
        ("[transfer]\n", "[sensor]\nsnr_contrast_db = 40\n[transfer]\n", "5:2", &["beside [transfer]"]),
    ];
    let wrong = |(old, new, place, parts): &(&str, &str, &str, &[&str])| {
        let found = diagnostics(old, new);
        let good =
            found.lines().count() == 1 && found.starts_with(&format!("test.toml:{place}")) && parts.iter().all(|part| found.contains(part));
        (!good).then(|| format!("{new:?}: expected {place} {parts:?}, found:\n{found}"))
    };
    let wrong: Vec<String> = cases.iter().filter_map(wrong).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// A wall whose control lies on a line, and one whose camera folds over.
#[test]
fn what_is_wrong_where_it_is_applied_is_told_where_that_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/canon-t3");
    for file in ["board.toml", "camera.xml", "wall.toml"] {
        fs::copy(own.join(file), folder.path().join(file)).unwrap();
    }
    let targets = ["G1", "G2", "G3", "G4"];
    let plate = |(i, id): (usize, &&str)| {
        format!("{{ id = \"{id}\", middle = [0, {}, 0], right = [0, 1, 0], up = [0, 0, 1], width = 0.3, height = 0.3 }},", i as f64 - 1.5)
    };
    let target = |id: &&str| format!("{{ id = \"{id}\", plate = \"{id}\", kind = \"chess_corner\", at = [0, 0], size = 0.1 }},");
    let plates: String = targets.iter().chain(&["V1"]).enumerate().map(plate).collect();
    let listed: String = targets.iter().chain(&["V1"]).map(target).collect();
    let head = "why = \"A line.\"\nsource = \"a test\"\nseed = 1\n[camera]\nfile = \"camera.xml\"\n[pointing]\nsigma = 0\nwhole_pixels = true\n[[method]]\nname = \"pixel\"\n";
    let stations =
        "[[station]]\nname = \"1\"\nat = [9, -1, 0]\ntowards = [0, 0, 0]\n[[station]]\nname = \"2\"\nat = [9, 1, 0]\ntowards = [0, 0, 0]\n";
    let line = format!("{head}[testfield]\nkind = \"wall\"\nunit = \"m\"\nplate = [{plates}]\ntarget = [{listed}]\n{stations}");
    fs::write(folder.path().join("line.toml"), line).unwrap();
    let found = read_in(folder.path(), &GOOD.replace("wall.toml", "line.toml")).unwrap_err();
    assert!(found.starts_with("test.toml:8:11: all control points lie on a line"), "{found}");
    let camera = fs::read_to_string(own.join("camera.xml")).unwrap();
    let folded = camera.replace("<k1>-0.1702</k1>", "<k1>-0.9</k1>");
    assert_ne!(camera, folded);
    fs::write(folder.path().join("camera.xml"), folded).unwrap();
    let wall = fs::read_to_string(own.join("wall.toml")).unwrap();
    fs::write(folder.path().join("wall.toml"), wall.replace("sees = 0.4", "")).unwrap();
    let found = read_in(folder.path(), GOOD).unwrap_err();
    assert!(found.contains("test.toml:6:9: the camera of `wall.toml` folds over inside its frame"), "{found}");
}
