//! A whole report from records of a few points, whose figures are computed by hand.

pub(crate) mod small;
pub(crate) mod swept;

use calibench_records::stored::Table;
use small::{Family, line, row};

use crate::verdicts;

/// Errors of `centroid`, px: in trial 0 (0.03, 0.04) and (-0.01, 0.02), `c` rejected; in trial 1 (0.05, 0), `b` lost at (3, 4), (0.02, -0.02).
#[test]
fn the_figures_of_a_method_are_those_computed_by_hand() {
    let page = Family::new().page();
    // Squares of the kept points 25e-4, 5e-4, 25e-4, 8e-4: mean 15.75e-4; with the lost one (25 + 63e-4) / 5.
    let found = row(&page, &["`centroid:window=15`", "6"]);
    assert_eq!(found[2..5], ["1 border", "1 (16.7 ± 15.2 %)", "0.0397"]);
    assert!(found[7].starts_with("2.2363 ± "), "{found:?}");
    // Sums over trials of kept dx: 0.02 and 0.07 of two points each. The mean is 0.0225, the residuals of the sums -0.025 and 0.025; times 2 / (2 - 1),
    // the root over four points: 0.0125.
    let found = row(&page, &["`centroid:window=15`", "+0.0225 ± 0.0125"]);
    assert_eq!(found[2..4], ["+0.0100 ± 0.0200", "0.0311"]);
    // (0.3, 0.4), (0, 0), (0, 0.5), (0, 0.1), (0.1, 0), (-0.4, 0.3): the mean square is 0.77 / 6.
    assert_eq!(row(&page, &["`pixel`", "6"])[2..5], ["0", "0", "0.3582"]);
}

/// The two runs have 0.03 and 0.05, 0.04 and 0.
#[test]
fn a_printed_figure_is_judged_by_where_single_runs_lie() {
    let page = Family::new().page();
    let verdict = |name: &str, column: &str| row(&page, &[name, column]).last().unwrap().clone();
    assert_eq!(row(&page, &["a", "dx"])[2..4], ["0.03", "0.030"]);
    assert!(row(&page, &["a", "dx"])[4].starts_with("0.040"));
    assert_eq!(verdict("a", "dx"), "reproduces");
    assert_eq!(verdict("a", "dy"), "differs: 0.20 times");
    assert_eq!(verdict("b", "dy"), "not comparable (a)");
    // Of the first run: sqrt((0.03^2 + 0.01^2) / 2) in x alone, sqrt((25e-4 + 5e-4) / 2) in the plane.
    assert_eq!([&row(&page, &["all", "dx"])[3], &row(&page, &["all", "dy"])[3]], ["0.0224", "0.0387"]);
}

/// The page as a reader sees it, to the letter.
#[test]
fn the_page_of_a_small_family() {
    insta::assert_snapshot!(Family::new().page());
}

#[test]
fn records_that_are_not_the_scenario_of_the_file_are_named() {
    let family = Family::new();
    assert!(!family.page().contains("Not the scenario"), "two trials, as the file says");
    family.ask_for_three_trials();
    let page = family.page();
    assert_eq!(line(&page, "**Not the scenario"), "**Not the scenario as its file says: 2 trials in place of 3.**");
}

#[test]
fn what_is_missing_or_broken_is_named_with_its_path() {
    let family = Family::new();
    family.put(Table::Points, "a,b\n1,2\n");
    let message = family.message();
    assert!(message.contains("records.csv.gz: line 1: expected the columns scenario,trial,view"), "{message}");
    std::fs::remove_file(family.records()).unwrap();
    let older = family.records().with_extension("");
    std::fs::write(&older, "scenario,trial\n").unwrap();
    let message = family.message();
    assert!(message.contains("records.csv: records of an older version") && message.contains("run the scenario again"), "{message}");
    std::fs::remove_file(older).unwrap();
    insta::assert_snapshot!(family.message(), @"no scenario of `small` was run: `calibench run small` runs `small/scene`");
}

const MORE: &str = r#"
title = "Table 2: more"
source = "Nobody 2000, p. 2"
unit = "px"
scenario = "small/scene"
method = "METHOD"
columns = ["dx"]

[[cell]]
row = "far"
column = "dx"
printed = "0.05"
metric = "dx"
kind = "prediction"
target = "a"

[[cell]]
row = "near"
column = "dx"
printed = "0.04"
metric = "dx"
kind = "prediction"
target = "a"
"#;

/// `a` is 0.03 off in the first trial and 0.05 in the second: 0.05 lies among runs around 0.04, and is no rounding of 0.03; 0.04 may be one.
#[test]
fn verdicts_are_those_of_the_page() {
    let family = Family::new();
    let scene = family.records();
    let records = scene.ancestors().nth(3).unwrap();
    let published = records.with_file_name("published");
    std::fs::write(published.join("small/table-2.toml"), MORE.replace("METHOD", "centroid:window=15")).unwrap();
    std::fs::write(published.join("small/table-3.toml"), MORE.replace("METHOD", "absent")).unwrap();
    assert_eq!(verdicts::scenarios(&published).unwrap(), ["small/scene"]);
    let of = |table: &str| -> Vec<String> {
        let all = verdicts::verdicts(records, &published).unwrap();
        all.into_iter().filter(|([name, ..], _)| name == table).map(|([_, row, column], word)| format!("{row} {column} {word}")).collect()
    };
    assert_eq!(
        of("small/table-1"),
        [
            "a dx reproduces (prediction)",
            "a dy differs (prediction)",
            "b dx reproduces (prediction)",
            "b dy not comparable",
            "all dx reproduces (prediction)",
            "all dy reproduces (prediction)"
        ]
    );
    assert_eq!(of("small/table-2"), ["far dx reproduces (prediction)", "near dx reproduces (prediction)"]);
    assert_eq!(of("small/table-3"), ["far dx not comparable", "near dx not comparable"]);
    let page = family.page();
    assert!(page.contains("where 95 % of single runs lie") && page.contains("hold no method `absent`"), "{page}");
    // The first trial alone.
    let text = family.text();
    let one: String = text.lines().filter(|line| !line.starts_with("small/scene,1,")).map(|line| format!("{line}\n")).collect();
    family.put(Table::Points, &one);
    assert_eq!(of("small/table-2"), ["far dx differs (prediction)", "near dx reproduces (prediction)"]);
    let page = family.page();
    assert!(!page.contains("where 95 % of single runs lie") && page.contains("when ours is within half a unit"), "{page}");
    assert_eq!(row(&page, &["near", "0.04"]), ["near", "0.04", "0.030", "prediction", "reproduces"]);
    std::fs::remove_file(&scene).unwrap();
    assert_eq!(verdicts::verdicts(records, &published).unwrap(), []);
}

/// Records without a point, as of coordinates that are drawn, name their methods.
#[test]
fn a_run_without_points_is_known_by_its_methods() {
    let family = Family::new();
    let text = family.text();
    let header = text.lines().next().unwrap();
    let figures = calibench_records::adjustments::COLUMNS.join(",");
    let said = |methods: &[&str], seed: u64| {
        let named: String =
            methods.iter().map(|method| format!("small/scene,,,,{method},1,,,,,,,,adjusted,measures no point,{seed},r\n")).collect();
        family.put(Table::Points, &format!("{header}\n{named}"));
        let row = |trial: u64, method: &str| format!("small/scene,{trial},{method},c,iop,c,1.0,0.1,0.0,mm,adjusted,,{seed}\n");
        let rows: String = (0..2).flat_map(|trial| methods.iter().map(move |method| row(trial, method))).collect();
        family.put(Table::Adjustments, &format!("{figures}\n{rows}"));
        family.page().lines().find(|line| line.contains("Not the scenario")).map(str::to_owned)
    };
    let methods = ["pixel", "centroid:window=15"];
    assert_eq!(said(&methods, 5), None);
    assert_eq!(said(&methods, 6).unwrap(), "**Not the scenario as its file says: seed 6 in place of 5.**");
    assert_eq!(said(&methods[..1], 5).unwrap(), "**Not the scenario as its file says: other methods.**");
}
