//! Coded fields of another design.

use calibench_model::Image;
use calibench_synth::testfield::Coded;

use crate::campaign::{Setting, shots};
use crate::{BOTH, recogniser, told};

fn images(setting: &Setting, tilts: &[(f64, [f64; 2])]) -> Vec<Image<'static>> {
    shots(setting, &setting.testfield(), tilts, &[0.0, 33.0]).into_iter().map(|shot| shot.image).collect()
}

const TILTS: [(f64, [f64; 2]); 3] = [(0.0, [0.0, 0.0]), (30.0, [30.0, 0.0]), (45.0, [0.0, 45.0])];

/// Other places within the squares, other sizes; sharp and blurred.
#[test]
fn a_field_of_another_design_is_refused() {
    let known = Setting::paper(2301, 0.6, 46.0).testfield();
    let smaller = Coded { small: [8.0, 11.0, 13.0, 11.0], large: [15.0, 22.0, 22.0, 21.0], ..Coded::paper() };
    let others = (2302..2312).map(|seed| Setting::paper(seed, 0.6, 46.0));
    let blurred = (2312..2318).map(|seed| Setting::paper(seed, 1.0, 26.0));
    let sizes = [smaller].map(|field| Setting { field, ..Setting::paper(2301, 0.6, 46.0) });
    let recognisers = BOTH.map(|classifier| recogniser(&known, classifier));
    let mut counts = std::collections::BTreeMap::<String, usize>::new();
    for (number, other) in others.chain(blurred).chain(sizes).enumerate() {
        for image in images(&other, &TILTS) {
            for recogniser in &recognisers {
                let found = recogniser.recognise(&image);
                *counts.entry(told(&found)).or_default() += 1;
                assert!(found.is_err_and(|error| ["other_field", "other_sizes"].contains(&error.name())), "field {number}");
            }
        }
    }
    println!("{counts:?}");
    assert!(counts["other_sizes"] > 0 && counts["other_field"] > 150);
}

/// Of a single square in view nothing else speaks: of many squares of other fields none is taken for the known field's.
#[test]
fn a_single_square_of_another_field_is_refused() {
    let setting = Setting { distance: 1500.0, ..Setting::paper(2320, 0.6, 46.0) };
    let known = recogniser(&Setting::paper(2301, 0.6, 46.0).testfield(), BOTH[0]);
    for seed in 2321..2331 {
        let other = Setting { seed, ..setting.clone() };
        for image in images(&other, &TILTS[..2]) {
            let found = known.recognise(&image);
            assert!(found.is_err(), "seed {seed}: {}", told(&found));
        }
    }
}
