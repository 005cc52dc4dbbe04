//! What `[calibrators]` reads.

use calibench_measure::Registry;

use super::{Calibrators, Faults};
use crate::studies::StudyPlan;
use crate::{Study, Subject, parse};

const BOARD: &str = r#"why = "A board."
source = "ours"
seed = 3
[camera]
size = [1280, 960]
pitch = 5.0
c = 5.0
[testfield]
kind = "chessboard"
rows = 6
columns = 9
square = 25
[stations]
kind = "random"
count = 12
distance = [300, 500]
tilt = 35
each_trial = true
[pointing]
sigma = 0
whole_pixels = false
[[method]]
name = "pixel"
[calibrators]
model = "opencv5"
start_f = 900
distance = 500
noise_px = 0.1
[[calibrator]]
name = "ours"
[[calibrator]]
name = "opencv"
"#;

fn read(text: &str) -> Result<Calibrators, String> {
    let scenario = parse("s", "s.toml", text, &Registry::builtin()).map_err(|problems| problems.to_string())?;
    match scenario.subject {
        Subject::Views(views) => match views.study {
            Study::Calibrators(found) => Ok(*found),
            other => panic!("{other:?}"),
        },
        _ => panic!("it has stations"),
    }
}

fn with(old: &str, new: &str) -> Result<Calibrators, String> {
    assert!(BOARD.contains(old), "{old}");
    read(&BOARD.replacen(old, new, 1))
}

#[test]
fn calibrators_are_read_with_what_is_wrong_with_their_points() {
    let found = read(BOARD).unwrap();
    assert_eq!((found.sets(), found.sigma_px, found.faults), (vec!["ours".to_owned(), "opencv".to_owned()], None, Faults::default()));
    assert_eq!(found.drawn.as_deref(), Some(&[("pixel".to_owned(), Some(0.1))][..]));
    assert!(found.is_random() && found.runs_apart());
    let faults = "[calibrators.faults]\ngross = 0.02\ngross_px = [4, 5]\nexchanged = 0.1\ntold_scale = 1.01\nshutter = -2\nother_c = 1.05\n[[calibrator]]";
    let expected = Faults { gross: 0.02, gross_px: [4.0, 5.0], exchanged: 0.1, told_scale: 1.01, shutter: -2.0, other_c: 1.05 };
    assert_eq!(with("[[calibrator]]", faults).unwrap().faults, expected);
    let rendered = with("noise_px = 0.1\n", "").unwrap();
    assert!(rendered.drawn.is_none() && !rendered.is_random());
}

#[test]
fn what_is_wrong_with_the_tables_is_said() {
    for (old, new, message) in [
        ("\"opencv5\"", "\"opencv6\"", "`opencv6` is no camera model: expected one of photogrammetric,"),
        ("name = \"opencv\"", "name = \"ours\"", "the calibrator `ours` is listed twice"),
        ("start_f = 900\n", "", "[calibrators] has no `start_f`"),
        ("[[calibrator]]", "[calibrators.faults]\ngross_px = [5, 4]\n[[calibrator]]", "`gross_px` goes from 5 to 4"),
        ("[[calibrator]]", "[calibrators.faults]\ngros = 1\n[[calibrator]]", "unknown key `gros`"),
        (
            "noise_px = 0.1\n[[calibrator]]",
            "[calibrators.faults]\nshutter = 1\n[[calibrator]]",
            "`shutter` and `other_c` of [calibrators.faults] are for coordinates that are drawn",
        ),
    ] {
        let found = with(old, new).unwrap_err();
        assert!(found.contains(message), "{found}");
    }
    let none = BOARD.split("[[calibrator]]").next().unwrap();
    assert!(read(none).unwrap_err().contains("[calibrators] without a [[calibrator]]"));
    let alone = format!("{}[[calibrator]]\nname = \"ours\"\n", BOARD.split("[calibrators]").next().unwrap());
    assert!(read(&alone).unwrap_err().contains("[[calibrator]] without [calibrators]"));
}
