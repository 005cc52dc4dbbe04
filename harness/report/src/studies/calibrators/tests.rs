//! What a page says of calibration systems.

use calibench_records::figures::Quantity;
use calibench_records::statistics::running::Running;

use super::section::table;
use crate::load::adjustments::{Summaries, Summary};
use crate::tests::small::row;

#[test]
fn a_row_has_the_distance_what_is_stated_and_how_often_it_was_wrong() {
    let running = |values: &[f64]| {
        let mut running = Running::default();
        values.iter().for_each(|value| running.add(*value));
        running
    };
    let mut found =
        Summaries { methods: vec!["pixel".into()], sets: vec!["ours".into(), "lost".into()], trials: 2, ..Summaries::default() };
    let mut put = |quantity: Quantity, values: &[f64], sigma: &[f64]| {
        let key = ("pixel".to_owned(), "ours".to_owned(), quantity.into());
        found.figures.insert(key, Summary { value: running(values), sigma: running(sigma), ..Summary::default() });
    };
    put(Quantity::OverFrame, &[0.1, 0.3], &[0.15, 0.25]);
    put(Quantity::IsCalibrated, &[1.0, 1.0], &[]);
    put(Quantity::IsWrongAndSilent, &[0.0, 1.0], &[]);
    let figure: calibench_records::figures::FigureName = Quantity::OverFrame.into();
    found.failed.insert(("pixel".into(), "lost".into(), figure.group()), (2, "there is no program".into()));
    let table = table(&found);
    // t(0.975, 1) = 12.7062 times 0.1.
    assert_eq!(row(&table, &["`ours`"])[2..4], ["0.200 ± 1.271", "0.200"]);
    assert_eq!(row(&table, &["`ours`"])[7..], ["100", "50"]);
    assert_eq!(row(&table, &["`lost`"])[2], "there is no program");
}
