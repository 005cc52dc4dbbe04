//! Stations that have a blur and a light of their own.

use calibench_random::Key;
use calibench_records::results::PointResult;
use calibench_scenario::Scenario;

use super::{changed, trials};
use crate::shots::{Shot, shots};

const SCENARIO: &str = r#"
why = "A chessboard under changing light."
source = "ours"
seed = 3

[camera]
size = [300, 240]
pitch = 5.0
c = 5.0

[testfield]
kind = "chessboard"
rows = 4
columns = 5
square = 30

[[station]]
name = "one"
at = [60, -40, 700]
angles = [1, 1.5, 2]

[[station]]
name = "own"
at = [60, -40, 700]
angles = [1, 1.5, 2]

[optics]
blur = 0.6
corner_blur = 0.9

[sensor]
grey_noise = 0

[pointing]
sigma = 0
whole_pixels = false

[[method]]
name = "forstner"
"#;

/// The scenario whose second station has `keys` of its own.
fn own(keys: &str, changes: &[(&str, &str)]) -> Scenario {
    let (first, second) = SCENARIO.split_once("name = \"own\"\n").unwrap();
    changed(&format!("{first}name = \"own\"\n{keys}\n{second}"), changes)
}

fn pictures(scenario: &Scenario) -> [Shot; 2] {
    shots(scenario, 3, 0, &[]).unwrap().try_into().unwrap()
}

#[test]
fn light_of_its_own_is_a_factor_and_what_is_added() {
    let [one, lit] = pictures(&own("exposure = 0.5\nveil = -0.25", &[]));
    assert_eq!(one.image, pictures(&own("", &[]))[1].image, "other stations are as they were");
    for (lit, one) in lit.image.grey().iter().zip(one.image.grey()) {
        assert!((lit - (0.5 * one - 0.25)).abs() < 1e-7, "{lit} {one}");
    }
    assert_eq!(lit.targets, one.targets);
    let [one, lit] = pictures(&own("gradient_across = [0.4, -0.2]\nveil = 0.1", &[]));
    for (x, y) in [(0, 0), (299, 0), (150, 120), (17, 239)] {
        let factor = 1.0 + 0.4 * (x as f32 - 149.5) / 299.0 - 0.2 * (y as f32 - 119.5) / 239.0;
        let [one, lit] = [&one, &lit].map(|shot| shot.image.at(x, y));
        assert!((lit - (one * factor + 0.1)).abs() < 1e-6, "{x}, {y}: {one} {lit}");
    }
}

#[test]
fn light_of_its_own_needs_no_sensor() {
    let [one, lit] = pictures(&own("exposure = 2", &[("[sensor]\ngrey_noise = 0\n", "")]));
    assert!(lit.image.grey().iter().zip(one.image.grey()).all(|(lit, one)| *lit == 2.0 * one));
}

#[test]
fn a_blur_and_a_motion_of_its_own_are_those_of_a_lens_that_has_them() {
    let [one, other] = pictures(&own("blur = 1.2\nmotion = [2, 1]", &[]));
    let changes = [("blur = 0.6\ncorner_blur = 0.9", "blur = 1.2\ncorner_blur = 1.8\nmotion = [2, 1]")];
    let [all, _] = pictures(&own("", &changes));
    assert_eq!(other.image, all.image);
    assert_ne!(one.image, all.image);
}

/// The bounds of both stations, point by point.
fn bounds(scenario: &Scenario) -> [Vec<Option<f64>>; 2] {
    let points: Vec<PointResult> = trials(scenario, 3).remove(0).points;
    ["one", "own"].map(|view| points.iter().filter(|point| &*point.view == view).map(|point| point.bound).collect())
}

#[test]
fn bounds_are_those_of_the_light_and_the_lens_of_the_station() {
    let noisy = ("grey_noise = 0", "grey_noise = 0.01");
    let [one, lit] = bounds(&own("exposure = 0.5\nveil = 0.2", &[noisy]));
    assert_eq!(one.len(), 20);
    for (one, lit) in one.iter().zip(&lit) {
        assert!((lit.unwrap() / one.unwrap() - 2.0).abs() < 1e-9, "half the contrast, twice the bound: {one:?} {lit:?}");
    }
    let wide = ("blur = 0.6\ncorner_blur = 0.9", "blur = 1.2\ncorner_blur = 1.8");
    let [[_, blurred], [_, all]] = [own("blur = 1.2", &[noisy]), own("", &[noisy, wide])].map(|scenario| bounds(&scenario));
    assert!(blurred.iter().zip(&all).all(|(one, all)| (one.unwrap() / all.unwrap() - 1.0).abs() < 1e-12), "{blurred:?} {all:?}");
    assert!(bounds(&own("gradient_across = [0.1, 0]", &[noisy]))[1].iter().all(Option::is_none), "they are those of even light");
}

/// The noise is that of the place, whatever a station has of its own.
#[test]
fn what_is_drawn_stays_the_same() {
    let noisy = [("grey_noise = 0", "grey_noise = 0.01")];
    let of = |scenario: &Scenario| Key { seed: 3, of: &scenario.drawn, trial: 0, view: "", target: "" }.of.to_owned();
    assert_eq!(of(&own("exposure = 0.5", &noisy)), of(&own("", &noisy)));
}
