//! What a page says of measured lengths.

use calibench_records::description::Tasks;
use calibench_records::figures::Quantity;

use super::section::text;
use crate::load::adjustments::{Summaries, Summary};
use crate::tests::small::{row, running};

#[test]
fn a_row_says_how_often_intervals_hold_the_truth() {
    let mut found = Summaries { methods: vec!["pixel".into()], sets: vec!["tasks".into()], trials: 3, ..Summaries::default() };
    let mut put = |quantity: Quantity, way: &str, summary: Summary| {
        found.figures.insert(("pixel".into(), "tasks".into(), quantity.of(&[way])), summary);
    };
    for way in ["all", "before a plane"] {
        put(Quantity::TasksWithin, way, Summary { value: running(&[1.0, 0.9, 0.8]), ..Summary::default() });
        put(Quantity::SquareOfTasks, way, Summary { value: running(&[1.0, 1.1, 1.2]), ..Summary::default() });
        let length = Summary { value: running(&[80.0]), sigma: running(&[0.018, 0.024]), square: running(&[4e-4]), ..Summary::default() };
        put(Quantity::TaskLength, way, length);
    }
    found.figures.insert(
        ("pixel".into(), "tasks".into(), Quantity::IsDoubtful.into()),
        Summary { value: running(&[0.0, 1.0, 0.0]), ..Summary::default() },
    );
    let told = Tasks { model: "opencv5".into(), noise_px: 0.1, count: 20, print: 0.03, scale: 2e-4, flatness: 0.08 };
    let text = text(&found, &told, "mm");
    assert!(text.contains("each corner by 0.03 mm, the scale by 0.0002, each bend by 0.08 mm"), "{text}");
    let cells = row(&text, &["`pixel`", "before a plane"]);
    // t(0.975, 2) = 4.3027 times 0.1 over the root of 3.
    assert_eq!(cells[2..4], ["3", "90.00 ± 24.84"]);
    // The root of the mean of .018^2 and .024^2 is .03 over the root of 2.
    assert_eq!(cells[5..], ["0.0212", "0.0200", "1.061"]);
    let [plane, all] = ["before a plane", "| all "].map(|way| text.find(way).unwrap());
    assert!(plane < all, "all of them come last: {text}");
    assert!(text.contains("`pixel`: 33.3 % of the calibrations are in doubt."), "{text}");
}
