//! Tables of blocks of two trials whose figures are computed by hand: t(0.975, 1) = 12.7062. Every figure has a value of its own.

use calibench_records::adjustments::CalibrationWriter;
use calibench_records::description::Blocks;
use calibench_records::figures::Group;
use calibench_records::points::RunInfo;
use calibench_records::results::{Calibrated, Figure, MethodInfo};
use calibench_records::stored::Table;

use super::tables;
use crate::load::adjustments::{Summaries, load};
use crate::tests::small::{figure, new_table};

const SETS: [&str; 4] = ["one", "pairs", "residuals", "recognition"];

fn figures(named: &[(&str, f64)]) -> Vec<Figure> {
    named.iter().map(|(name, value)| figure(Group::Network, name, *value)).collect()
}

/// `one`: 32 images; sigma0 0.04 and 0.05 px. `pairs`: 16 networks, without a result in the second trial. Correlations of residuals.
fn trial(number: u64) -> Vec<Calibrated> {
    let sigma0 = 0.04 + 0.01 * number as f64;
    let one = figures(&[
        ("observations", 2055.0),
        ("unknowns", 288.0),
        ("redundancy", 1767.0),
        ("images", 32.0),
        ("points", 33.0),
        ("gross errors", 4.0 + 2.0 * number as f64),
        ("sigma0", sigma0),
        ("sigma0 in um", 27.0 * sigma0),
        ("rows over columns", 1.25),
        ("bend along X", 0.8),
        ("bend along Y", 0.05),
        ("error of a coordinate", 0.031),
        ("own sigma", 0.02),
        ("own sigma over sigma0", 0.5),
        ("lost", 0.015),
        ("rejected", 0.0225),
    ]);
    let pairs = figures(&[("networks", 16.0), ("redundancy", 424.5), ("sigma0", 0.02)]);
    let residuals = figures(&[("pairs", 16.0), ("correlation within pairs", 0.5), ("correlation across pairs", 0.09)]);
    let of = |set: usize, outcome| Calibrated { method: 0, set, outcome, check_failed: None };
    let pairs = if number == 0 { Ok(pairs) } else { Err("no convergence".to_owned()) };
    vec![of(0, Ok(one)), of(1, pairs), of(2, Ok(residuals)), of(3, Ok(figures(&[("redundancy", 7.0)])))]
}

fn summaries() -> Summaries {
    let folder = tempfile::tempdir().unwrap();
    let run = RunInfo { scenario: "s".into(), seed: 1, revision: "r".into(), detector: None };
    let file = new_table(folder.path(), Table::Adjustments);
    let methods = vec![MethodInfo { label: "lsm".into(), version: "1".into(), unavailable: None }];
    let mut writer = CalibrationWriter::new(file, run, methods, SETS.map(Into::into).to_vec()).unwrap();
    (0..2).for_each(|number| writer.trial(number, &trial(number)).unwrap());
    writer.finish().unwrap().finish().unwrap();
    load(folder.path(), "s").unwrap().unwrap()
}

/// The cells of all rows of a text, headers too.
fn rows(text: &str) -> Vec<Vec<&str>> {
    let lines = text.lines().filter(|line| line.starts_with('|') && !line.contains("---"));
    lines.map(|line| line.trim_matches('|').split('|').map(str::trim).collect()).collect()
}

#[test]
fn a_block_has_its_counts_and_sigma0_in_their_columns() {
    let text = tables::blocks(&summaries());
    let names = ["block", "method", "networks", "images", "points", "observations", "unknowns", "redundancy", "sigma0, px", "sigma0, um"];
    let header = [&names[..], &["gross errors", "rows over columns"]].concat();
    // Half of the range of two values is their standard error: 0.005 x 12.7062 = 0.0635.
    let one = ["one", "`lsm`", "1", "32", "33", "2055", "288", "1767", "0.0450 ± 0.0635", "1.22 ± 1.72", "5.0 ± 12.7", "1.25"];
    let pairs = ["pairs", "`lsm`", "16", "", "", "", "", "424", "0.0200", "", "", ""];
    assert_eq!(rows(&text), [header, one.to_vec(), pairs.to_vec()], "neither residuals nor recognition is a block");
    assert!(text.contains("mean of 2 trials"), "{text}");
    assert!(
        text.contains("- `one`, `lsm`: the object points bend by 0.800 along X (a single trial scatters by 0.000) and by 0.050 along Y.\n")
    );
}

#[test]
fn location_and_residuals_are_told_where_they_are_known() {
    let found = summaries();
    let location = rows(&tables::location(&found))[1..].iter().map(|row| row.join("; ")).collect::<Vec<_>>();
    assert_eq!(location, ["one; `lsm`; 0.0310; 0.0450 ± 0.0635; 0.0200; 0.50; 1.50; 2.25"]);
    let told = Blocks { pitch_um: 27.0, compared: vec!["one".into()], pairs: vec![["1211".into(), "1311".into()]] };
    let text = tables::residuals(&found, &told);
    assert_eq!(rows(&text)[1], ["`lsm`", "16", "0.500", "0.090"]);
    assert!(text.contains("(`one`) within 1 pairs, the first of which is 1211 with 1311"), "{text}");
}

#[test]
fn a_block_without_a_result_says_why() {
    assert_eq!(
        tables::failures(&summaries()),
        "**Without a result:**\n\n- `pairs`, `lsm`: 1 of 2 trials have no result, the first because no convergence.\n\n"
    );
    assert_eq!(tables::failures(&Summaries::default()), "");
}
