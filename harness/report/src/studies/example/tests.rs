//! What the example shows.

use calibench_records::figures::Quantity;
use calibench_records::statistics::running::Running;

use super::section;
use crate::load::adjustments::{Summaries, Summary};
use crate::studies::Section;
use crate::tests::small::row;

/// 100 and 102: t(0.975, 1) = 12.7062 times a standard deviation of the mean of 1.
#[test]
fn the_example_shows_a_mean_with_its_interval() {
    let mut value = Running::default();
    [100.0, 102.0].into_iter().for_each(|scale| value.add(scale));
    let mut found = Summaries { methods: vec!["a".into(), "b".into()], sets: vec!["scale".into()], trials: 2, ..Summaries::default() };
    let key = ("a".to_owned(), "scale".to_owned(), Quantity::ImageScale.into());
    found.figures.insert(key, Summary { value, ..Summary::default() });
    let table = section::table(&found);
    assert_eq!(row(&table, &["`a`"]), ["`a`", "101.00 \u{b1} 12.71"]);
    assert_eq!(row(&table, &["`b`"]), ["`b`", ""]);
    // It stands in the list of studies by this alone.
    let _: &'static dyn Section = &section::Scale;
}
