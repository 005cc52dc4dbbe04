//! What `[acceptance]` reads.

use calibench_accept::{Limit, Rule};
use calibench_measure::Registry;

use super::{Classes, TestLines};
use crate::studies::networks::Kind;
use crate::{Study, Subject, parse};

const HEAD: &str = r#"why = "A board."
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
count = 4
distance = [300, 500]
tilt = 35
[pointing]
sigma = 0
whole_pixels = false
[[method]]
name = "pixel"
"#;
const FREE: &str = "[free_network]\nmodel = \"opencv5\"\nnoise_px = 0.1\n[[distance]]\nbetween = [\"r1c1\", \"r1c9\"]\nsigma = 0.02\n";
const LENGTHS: &str =
    "[acceptance]\nlines = [[\"r1c1\", \"r1c2\", \"r1c9\"], [\"r6c9\", \"r1c1\"]]\nlimit = [0.1, 1e-5, 0.2]\nsigma = 0.01\n";
const CALIBRATION: &str = "[calibration]\nsets = [\"c,x0,y0\"]\nstart_c = 5.1\nsigma_px = 0.1\ndrawn = {}\n";
const CHECK: &str = "[calibration.check]\nviews = [\"s01\", \"s02\"]\ncontrol = [\"r1c1\", \"r1c9\", \"r6c1\", \"r6c9\"]\n";
const CLASSES: &str = "[acceptance]\nhorizontal = 0.5\nspatial = 1\n";

fn study(tables: &str) -> Result<Study, String> {
    let scenario = parse("s", "s.toml", &format!("{HEAD}{tables}"), &Registry::builtin()).map_err(|problems| problems.to_string())?;
    match scenario.subject {
        Subject::Views(views) => Ok(views.study),
        _ => panic!("it has stations"),
    }
}

fn lengths(tables: &str) -> TestLines {
    match study(tables).unwrap() {
        Study::Networks(found) => match found.kind {
            Kind::Free { acceptance, .. } => acceptance.unwrap(),
            other @ Kind::Rig(_) => panic!("{other:?}"),
        },
        other => panic!("{other:?}"),
    }
}

#[test]
fn lengths_go_from_the_first_target_of_a_line() {
    let found = lengths(&format!("{FREE}{LENGTHS}"));
    assert_eq!(found.lines, [vec![0, 1, 8], vec![53, 0]]);
    assert_eq!(found.lengths().collect::<Vec<_>>(), [(0, [0, 1]), (0, [0, 8]), (1, [53, 0])]);
    assert_eq!((found.sigma, found.limit, found.rule), (0.01, Limit { constant: 0.1, rate: 1e-5, most: 0.2 }, Rule::Probability(0.95)));
    // 8 and 5 squares of 25.
    assert!((found.diagonal - 200.0_f64.hypot(125.0)).abs() < 1e-9, "{}", found.diagonal);
    let told = lengths(&format!("{FREE}{}", LENGTHS.replace("sigma = 0.01", "volume = [2, 3, 6]\nguard_band = 2")));
    assert_eq!((told.sigma, told.diagonal, told.rule), (0.0, 7.0, Rule::GuardBand(2.0)));
}

#[test]
fn check_points_have_classes() {
    let Study::Network(found) = study(&format!("{CALIBRATION}{CHECK}{CLASSES}")).unwrap() else { panic!("it is [calibration]") };
    assert_eq!(found.check.unwrap().acceptance, Some(Classes { horizontal: Some(0.5), vertical: None, spatial: Some(1.0) }));
}

#[test]
fn what_is_wrong_with_the_table_is_said() {
    let rig = "[rig]\nmodel = \"opencv5\"\nnoise_px = 0.1\n[[mount]]\nname = \"left\"\n[[mount]]\nname = \"right\"\nat = [120, 0, 5]\n";
    for (tables, message) in [
        (format!("{FREE}{}", LENGTHS.replace("r1c2", "r1c20")), "no target is called `r1c20`"),
        (format!("{FREE}{}", LENGTHS.replace("\"r6c9\", ", "")), "a line of 1 targets: expected two at least"),
        (format!("{FREE}{}", LENGTHS.replace("r1c2", "r1c9")), "`r1c9` stands twice"),
        (format!("{FREE}[acceptance]\nlines = []\nlimit = [1]\n"), "`lines` is empty"),
        (format!("{FREE}{}", LENGTHS.replace("[0.1, 1e-5, 0.2]", "[]")), "`limit`: found ``"),
        (format!("{FREE}{}", LENGTHS.replace("1e-5", "-1")), "numbers of at least 0"),
        (format!("{FREE}{LENGTHS}probability = 0.9\nguard_band = 1\n"), "`guard_band` beside `probability`"),
        (format!("{FREE}{}", LENGTHS.replace("limit", "limits")), "unknown key `limits` in [acceptance]"),
        (format!("{FREE}{CLASSES}"), "unknown key `horizontal` in [acceptance]"),
        (format!("{}{LENGTHS}", FREE.split("[[distance]]").next().unwrap()), "[acceptance] without a [[distance]]"),
        (format!("{CALIBRATION}{CHECK}[acceptance]\n"), "[acceptance] without a class"),
        (format!("{CALIBRATION}{CLASSES}"), "[acceptance] without [calibration.check]"),
        (format!("{rig}{LENGTHS}"), "[acceptance] beside [rig]: expected it beside [calibration] or [free_network]"),
        (LENGTHS.to_owned(), "[acceptance] alone: expected it beside [calibration] or [free_network]"),
    ] {
        let found = study(&tables).unwrap_err();
        assert!(found.contains(message), "{message}: {found}");
    }
}
