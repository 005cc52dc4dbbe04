//! The worked example of a study.

use calibench_records::figures::Quantity;
use calibench_records::results::find;

use super::{EXACT, KEY, scenario, trials, views};
use crate::studies::Adjust;
use crate::studies::example::Scale;

/// The camera of 2000 px per unit of slope looks from 6 m squarely at the wall.
#[test]
fn the_example_finds_the_scale_of_an_image() {
    let scenario = scenario(&[]);
    let mut points = trials(&scenario, 3).swap_remove(0).points;
    points.retain(|point| &*point.view == "front" && point.method == EXACT);
    let found = Scale { between: [0, 11] }.adjust(views(&scenario), &points, &[0, EXACT], KEY);
    let scale = found[1].outcome.as_ref().map(|figures| find(figures, Quantity::ImageScale).unwrap().value);
    assert!(scale.is_ok_and(|scale| (scale - 2000.0 / 6.0).abs() < 1e-6), "{:?}", found[1]);
    assert_eq!((found[0].method, &found[0].outcome), (0, &Err("no image has both targets".to_owned())));
}
