//! What a page says of networks.

use calibench_records::description::Networks;
use calibench_records::figures::{FigureName, Quantity};

use super::section::text;
use crate::load::adjustments::{Summaries, Summary};
use crate::tests::small::{row, running};

#[test]
fn a_row_says_whether_what_is_stated_is_so() {
    let mut found = Summaries { methods: vec!["pixel".into()], sets: vec!["network".into()], trials: 4, ..Summaries::default() };
    let mut put = |name: FigureName, summary: Summary| found.figures.insert(("pixel".into(), "network".into(), name), summary);
    let mut values = |quantity: Quantity, all: &[f64]| put(quantity.into(), Summary { value: running(all), ..Summary::default() });
    values(Quantity::CostOverRedundancy, &[0.9, 1.1, 1.0]);
    values(Quantity::WithinRegion, &[1.0, 1.0, 0.0]);
    values(Quantity::IsWrongMinimum, &[1.0, 1.0, 0.0]);
    values(Quantity::IsWrongMinimumAndSilent, &[1.0, 0.0, 0.0]);
    let parameter = Summary { value: running(&[900.0]), sigma: running(&[0.2, 0.2]), square: running(&[0.01, 0.03]), ..Summary::default() };
    put(Quantity::Parameter.of(&["fx"]), parameter);
    found.failed.insert(("pixel".into(), "network".into(), FigureName::from(Quantity::Redundancy).group()), (1, "no lens".into()));
    let told = Networks {
        model: "opencv5".into(),
        sigma_px: 0.1,
        mounts: Vec::new(),
        distances: vec![["a".into(), "b".into()]],
        acceptance: None,
    };
    let text = text(&found, &told);
    assert!(text.starts_with("Free networks of one camera (opencv5), from image points and one measured distance"), "{text}");
    let cells = row(&text, &["`pixel`", "3"]);
    // t(0.975, 2) = 4.3027 times 0.1 over the root of 3.
    assert_eq!(cells[1..3], ["3", "1.0000 ± 0.2484"]);
    assert_eq!(&cells[4][..5], "66.67");
    assert_eq!(cells[8..], ["2", "1", "1: no lens"]);
    assert_eq!(row(&text, &["`pixel`", "`fx`"])[2..], ["0.200", "0.141", "0.707"]);
    let rigs = Networks { mounts: vec!["left".into(), "right".into()], ..told };
    assert!(super::section::text(&found, &rigs).starts_with("Rigs of 2 cameras (each opencv5), left, right, before known targets"));
}
