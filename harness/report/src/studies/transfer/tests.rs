//! Tables of calibrations that are applied elsewhere, from two trials whose figures are computed by hand: t(0.975, 1) = 12.7062.

use calibench_records::adjustments::CalibrationWriter;
use calibench_records::figures::{Group, Quantity};
use calibench_records::points::RunInfo;
use calibench_records::results::{Calibrated, Figure, MethodInfo};
use calibench_records::stored::Table;
use tempfile::TempDir;

use super::check_points::has_check_points;
use super::{boards, cases, decomposition, errors};
use crate::load::adjustments::{Summaries, load, load_with};
use crate::tests::small::{figure, new_table};

const SETS: [&str; 2] = ["held", "split"];

fn plain(group: Group, name: &str, value: f64) -> Figure {
    figure(group, name, value)
}

/// Errors of X, Y, Z 0.03, 0.04 and 0.12 m, larger by a tenth in the second trial; the camera is 2 and 4 px off, c by 0.3 and 0.4 mm.
fn held(number: usize) -> Vec<Figure> {
    let times = 1.0 + 0.1 * number as f64;
    let named = [("rmse_x", 0.03), ("rmse_y", 0.04), ("rmse_z", 0.12), ("rmse_xy", 0.05), ("rmse_xyz", 0.13)];
    let c =
        Figure { name: Quantity::Parameter.of(&["c"]), value: 19.0, sigma: Some(0.1), error: Some(0.3 + 0.1 * number as f64), unit: "mm" };
    let mut figures: Vec<Figure> = named.iter().map(|(name, value)| plain(Group::Check, name, times * value)).collect();
    figures.extend([c, plain(Group::Frame, "rms", 2.0 + 2.0 * number as f64)]);
    for (axis, value, error) in [("X", 1.03, 0.03), ("Y", 2.04, 0.04), ("Z", 3.12, 0.12)] {
        figures.push(Figure { error: Some(error), ..plain(Group::Object, &format!("V1/{axis}"), value) });
    }
    figures
}

/// Two causes, `pitch` and `bend`.
fn split() -> Vec<Figure> {
    let named = [
        ("none", 0.01),
        ("all", 0.26),
        ("interactions", 0.005),
        ("alone/bend", 0.11),
        ("without/bend", 0.21),
        ("alone/pitch", 0.22),
        ("without/pitch", 0.12),
        ("share/bend", 0.3),
        ("share/pitch", 0.65),
        ("share/none", 0.04),
        ("share/interactions", 0.01),
        ("pair/bend+pitch", 0.006),
    ];
    named.iter().map(|(name, value)| plain(Group::Check, name, *value)).collect()
}

/// The folder of a run of two trials: `board`, and `none`, which fails in the second trial.
fn run() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let info = |label: &str| MethodInfo { label: label.into(), version: "1".into(), unavailable: None };
    let run = RunInfo { scenario: "s".into(), seed: 1, revision: "r".into(), detector: None };
    let file = new_table(folder.path(), Table::Adjustments);
    let mut writer = CalibrationWriter::new(file, run, vec![info("board"), info("none")], SETS.map(Into::into).to_vec()).unwrap();
    for number in 0..2 {
        let of = |method, set, outcome| Calibrated { method, set, outcome, check_failed: None };
        let none = if number == 0 { Ok(held(0)) } else { Err("a fold".to_owned()) };
        writer.trial(number as u64, &[of(0, 0, Ok(held(number))), of(0, 1, Ok(split())), of(1, 0, none)]).unwrap();
    }
    writer.finish().unwrap().finish().unwrap();
    folder
}

fn found() -> Summaries {
    load(run().path(), "s").unwrap().unwrap()
}

fn rows(text: &str) -> Vec<Vec<String>> {
    let lines = text.lines().filter(|line| line.starts_with('|') && !line.contains("---"));
    lines.map(|line| line.trim_matches('|').split('|').map(|cell| cell.trim().to_owned()).collect()).collect()
}

/// Half of the interval of two values is their half difference times t: X 3 and 3.3 cm have 0.15 x 12.7062.
#[test]
fn cases_have_their_errors_in_their_columns_and_failures_are_told() {
    let found = found();
    assert!(has_check_points(&found) && !has_check_points(&Summaries::default()));
    let text = cases::table(&found);
    let rows = rows(&text);
    let header = ["case", "method", "X", "Y", "Z", "planimetric", "in space", "camera, px", "error of c, mm", "failed"];
    assert_eq!(rows[0], header);
    let board =
        ["held", "board", "3.15 ± 1.91", "4.20 ± 2.54", "12.60 ± 7.62", "5.25 ± 3.18", "13.65 ± 8.26", "3.00 ± 12.71", "0.354", "0"];
    assert_eq!(rows[1], board);
    assert_eq!(rows[2][..3], ["held", "none", "3.00"]);
    assert_eq!((rows.len(), rows[2][9].as_str()), (3, "1"), "a split is no case");
    assert!(text.contains("- held, none: 1 of 2 trials failed, the first because a fold.\n"), "{text}");
}

#[test]
fn a_split_lists_causes_by_what_they_make_alone() {
    let text = decomposition::tables(&found());
    let expected = [
        ["cause", "on alone", "off alone", "share, %"],
        ["pitch", "22.00 ± 0.00", "12.00 ± 0.00", "65.0 ± 0.0"],
        ["bend", "11.00 ± 0.00", "21.00 ± 0.00", "30.0 ± 0.0"],
        ["none of them", "1.00 ± 0.00", "26.00 ± 0.00", "4.0 ± 0.0"],
        ["beyond their sum", "0.50 ± 0.00", "", "1.0 ± 0.0"],
    ];
    assert_eq!(rows(&text), expected);
    assert!(text.starts_with("### split: board\n") && text.contains("most for: bend with pitch 0.60.\n"), "{text}");
}

/// The method that failed in the second trial has kept its points of the first one alone.
#[test]
fn points_of_every_trial_are_drawn() {
    let pictures = errors::pictures(&found());
    assert_eq!(pictures.iter().map(|(case, _)| case.as_str()).collect::<Vec<_>>(), ["held"]);
    let vectors = errors::vectors(&found(), "board", "held");
    let [(at, error)] = vectors[..] else { panic!("{vectors:?}") };
    assert!(at.iter().zip([1.0, 2.0, 3.0]).all(|(a, b)| (a - b).abs() < 1e-9) && error == [0.03, 0.04, 0.12], "{at:?} {error:?}");
    assert!(errors::vectors(&found(), "none", "held").is_empty());
}

#[test]
fn a_sweep_has_medians_and_says_once_what_it_does_not_touch() {
    let folder = run();
    let mut distances = boards::Distances::default();
    load_with(folder.path(), "s", |row| distances.add(row)).unwrap();
    let medians = distances.medians();
    assert_eq!(medians.iter().map(|(method, median)| (method.as_str(), *median)).collect::<Vec<_>>(), [("board", 3.0), ("none", 2.0)]);
    let cell = |views: &str, board: f64| {
        let mut medians = medians.clone();
        medians.insert("board".into(), board);
        boards::Cell { values: vec![views.into(), "35".into()], found: found(), medians }
    };
    let (axes, cells) = (["views".to_owned(), "tilt".to_owned()], [cell("3", 3.0), cell("17", 1.5)]);
    let text = boards::table(&axes, &cells);
    let rows = rows(&text);
    let head = ["`views`", "`tilt`", "method", "camera, px: median", "mean", "sigma of c, um", "true error of c, um", "planimetric, held"];
    assert_eq!((&rows[0][..8], &*rows[0][8], rows[0].len()), (&head.map(str::to_owned)[..], "failed", 9));
    assert_eq!(rows[1][..8], ["3", "35", "board", "3.00", "3.00", "100.0", "353.6", "5.25 ± 3.18"]);
    assert_eq!((rows.len(), &*rows[2][0], &*rows[2][3]), (3, "17", "1.50"));
    assert!(text.contains("The same everywhere: none, 2.00 px in the median, planimetric 5.00 (held)"), "{text}");
    assert!(boards::picture(&axes, &cells).is_some() && boards::picture(&axes, &cells[..1]).is_none());
}
