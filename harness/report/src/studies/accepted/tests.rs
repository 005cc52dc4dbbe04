//! What pages say of networks that must keep something.

use calibench_records::description::{Classes, TestLengths};
use calibench_records::figures::{FigureName, Quantity};

use super::picture::{Curve, picture};
use super::{answer, of_classes, of_lengths, table};
use crate::load::adjustments::{Summaries, Summary};
use crate::sweep::share;
use crate::tests::small::{row, running};

/// Three trials that pass, one that fails, one that cannot tell, one that could not be adjusted.
fn found() -> Summaries {
    let mut found = Summaries { methods: vec!["pixel".into()], sets: vec!["network".into()], trials: 6, ..Summaries::default() };
    let mut put = |quantity: Quantity, values: &[f64]| {
        let summary = Summary { value: running(values), ..Summary::default() };
        found.figures.insert(("pixel".into(), "network".into(), quantity.into()), summary);
    };
    put(Quantity::AcceptancePass, &[1.0, 1.0, 1.0, 0.0, 0.0]);
    put(Quantity::AcceptanceFail, &[0.0, 0.0, 0.0, 1.0, 0.0]);
    put(Quantity::AcceptanceCannotTell, &[0.0, 0.0, 0.0, 0.0, 1.0]);
    put(Quantity::LargestOverLimit, &[0.5, 0.6, 0.7, 1.2, 1.0]);
    let group = FigureName::from(Quantity::AcceptancePass).group();
    found.failed.insert(("pixel".into(), "network".into(), group), (1, "no lens".into()));
    found
}

#[test]
fn a_trial_that_could_not_be_adjusted_does_not_pass() {
    let text = table(&found()).unwrap();
    let cells = row(&text, &["`pixel`"]);
    assert_eq!(cells[1..3], ["6", "50.0"]);
    // Wilson's interval of 3 in 6, by hand: 1.96^2 = 3.8415; half its width 1.96 / (1 + .64024) sqrt(.25 / 6 + 3.8415 / 144) = .3124.
    assert_eq!(cells[3..5], ["18.8", "81.2"]);
    assert_eq!(cells[5..], ["16.7", "16.7", "1", "0.80"]);
    assert!(answer(&found()).unwrap().starts_with("50 of 100 networks (19 to 81) keep their limits"));
    assert!(table(&Summaries { methods: vec!["pixel".into()], ..Summaries::default() }).is_none());
}

#[test]
fn what_must_be_kept_is_said() {
    let lengths = TestLengths { count: 35, lines: 7, limit: [0.1, 5e-5], most: Some(0.2), sigma: 0.005 };
    let text = of_lengths(&lengths, "mm");
    assert!(text.contains("35 lengths on 7 lines, calibrated to 0.005 mm, against the limit 0.1 + 0.00005 L, at most 0.2, mm"), "{text}");
    let bare = of_lengths(&TestLengths { limit: [0.0, 1e-4], most: None, sigma: 0.0, ..lengths }, "m");
    assert!(bare.contains("taken as exact, against the limit 0.0001 L m"), "{bare}");
    let classes = of_classes(Classes { horizontal: Some(0.05), vertical: None, spatial: Some(0.1) }, "m");
    assert!(classes.contains("the class horizontal 0.05 m, 3D 0.1 m"), "{classes}");
}

#[test]
fn curves_are_drawn_where_there_are_two_values() {
    let curve = |points: Vec<(f64, u64)>| Curve {
        method: "pixel".into(),
        name: "pixel".into(),
        points: points.into_iter().map(|(x, count)| (x, share(count, 10).unwrap())).collect(),
    };
    assert!(picture(&[curve(vec![(5.0, 2), (9.0, 10)])], "stations").is_some());
    assert!(picture(&[curve(vec![(5.0, 2)])], "stations").is_none());
    assert!(picture(&[], "stations").is_none());
}
