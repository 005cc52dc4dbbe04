//! `twin`: photographs whose making is known, and what a user may get wrong.

use std::path::Path;

use serde_json::Value;

use crate::project::{files, run, stderr, stdout};

/// A camera that blurs, sharpens and has noise; nine views of a board.
const MADE: &str = r#"
why = "photographs whose making is known"
source = "ours"
seed = 4
trials = 1

[camera]
size = [640, 480]
pitch = 10
c = 6
k1 = -0.002

[testfield]
kind = "chessboard"
rows = 6
columns = 9
square = 25
paper = 0.8

[stations]
kind = "random"
count = 9
distance = [330, 400]
tilt = 35
roll = 30

[optics]
blur = 0.8

[sensor]
grey_noise = 0.012
adc_bits = 12
bits = 8
sharpening = 0.6

[pointing]
detector = "board"

[[method]]
name = "parametric_corner"
"#;

/// The photographs in a folder `photos`.
fn photographs(folder: &Path) {
    std::fs::write(folder.join("made.toml"), MADE).unwrap();
    let output = run(folder, &["render", "made.toml", "-o", "photos", "-q"]);
    assert!(output.status.success(), "{}", stderr(&output));
}

fn twin(folder: &Path, name: &str, more: &[&str]) -> std::process::Output {
    let arguments = ["twin", "photos", "--board", "9x6:25", "-q", "-o", name, "-m", "forstner:window=11", "-m", "saddle:window=7"];
    run(folder, &[&arguments[..], more].concat())
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or(f64::NAN)
}

#[test]
fn the_twin_of_rendered_photographs_has_their_making_and_predicts_operators() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    photographs(here);
    let output = twin(here, "twin", &["--what-if", "light=4", "--what-if", "optics.blur=1.6", "--json"]);
    assert!(matches!(output.status.code(), Some(0 | 3)), "{}", stderr(&output));
    let answer: Value = serde_json::from_str(&stdout(&output)).unwrap();
    let part = |key: &str| answer["made_of"].as_array().unwrap().iter().find(|part| part["key"] == key).unwrap_or(&Value::Null).clone();
    for (key, truth, within) in [("station.blur", 0.8, 0.04), ("sensor noise", 255.0 * 0.012, 0.2), ("sensor.sharpening", 0.6, 0.15)] {
        let found = number(&part(key)["value"]);
        assert!((found - truth).abs() < within, "{key}: {found}, made with {truth}\n{}", stdout(&output));
    }
    assert!(number(&part("sensor.smoothing")["value"]) < 0.3 && number(&part("camera.local.sigma")["value"]) < 0.02, "{}", stdout(&output));
    // What operators do to the twin they did to the photographs, which have a truth of their own.
    let operators = answer["operators"].as_array().unwrap();
    assert_eq!(operators.len(), 3);
    // The corners of the board are of the maker's own points: its hold-out is too good.
    for operator in operators.iter().filter(|operator| operator["is_maker"] == false) {
        let ratio = number(&operator["twin_held_out_px"]) / number(&operator["held_out_px"]);
        assert!((0.85..1.18).contains(&ratio), "{operator}");
    }
    assert_eq!(answer["best"], serde_json::json!(["parametric_corner:window=15"]));
    let error = |place: usize, of: &Value| number(&of["operators"][place]["true_px"]);
    let cases = answer["what_if"].as_array().unwrap();
    for place in 0..3 {
        assert!(error(place, &cases[0]) < error(place, &answer), "more light");
    }
    // parametric_corner is as good as noise and blur let it be.
    assert!(error(2, &cases[1]) > 1.2 * error(2, &answer), "more blur");
    // The folder is whole: its scenario runs, its page has its pictures.
    let page = std::fs::read_to_string(here.join("twin/README.md")).unwrap();
    for picture in ["operators.png", "profile.png", "noise.png"] {
        assert!(page.contains(&format!("({picture})")) && image::open(here.join("twin").join(picture)).is_ok(), "{picture}");
    }
    assert_eq!(files(&here.join("twin/images")).len(), 9);
    let output = run(here, &["render", "twin/twin.toml", "-o", "again", "-q"]);
    assert!(output.status.success(), "{}", stderr(&output));
}

#[test]
fn a_twin_is_the_same_on_any_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    photographs(here);
    let made = |name: &str, threads: &str| {
        let output = twin(here, name, &["--what-if", "raw", "--threads", threads]);
        assert!(matches!(output.status.code(), Some(0 | 3)), "{}", stderr(&output));
        let all = files(&here.join(name));
        let own: Vec<_> = all.into_iter().map(|(path, bytes)| (path.file_name().unwrap().to_owned(), bytes)).collect();
        (own, stdout(&output))
    };
    assert!(made("one", "1") == made("two", "2"));
}

#[test]
fn what_makes_no_twin_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    photographs(here);
    let fails = |arguments: &[&str], said: &str| {
        let output = run(here, &[&["twin", "photos", "-q", "-o", "twin"], arguments].concat());
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(said), "{arguments:?}: expected {said}\n{}", stderr(&output));
        assert!(!here.join("twin").exists(), "nothing is left");
    };
    fails(&["--board", "charuco:9x7:25:18:DICT_4X4_50"], "of a chessboard");
    fails(&["--board", "8x6:25"], "found 0");
    fails(&["--board", "9x6:25", "--model", "nonsense"], "--model nonsense");
    fails(&["--board", "9x6:25", "--what-if", "light=0"], "a factor of 0.01 to 100");
    fails(&["--board", "9x6:25", "-m", "forstner:window=11", "--what-if", "nothing.at=1"], "the twin has no [nothing]");
    // Before anything is rendered: a minute of work is not lost.
    let started = std::fs::read_dir(here).unwrap().count();
    fails(&["--board", "9x6:25", "-m", "forstner:window=11", "--what-if", "sensor.smoothing=9"], "from 0 to 5");
    assert_eq!(std::fs::read_dir(here).unwrap().count(), started);
}
