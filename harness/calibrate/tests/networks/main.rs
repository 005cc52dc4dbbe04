//! Calibrations of networks drawn at random, and of networks that others made, from nothing.

mod draw;
mod others;
mod score;

use draw::{CLASSES, Drawn};
use rayon::prelude::*;
use score::{End, Ended, calibrated, ended};

/// Networks of a class. `cargo bench --workspace --bench networks` draws more, by another seed.
const COUNT: u64 = 29;

#[test]
fn networks_of_every_class_arrive_at_the_minimum() {
    for class in CLASSES {
        let one = |number| {
            let drawn = Drawn::network(class, 1, number);
            ended(class, &drawn, calibrated(class, &drawn))
        };
        let ends: Vec<Ended> = (0..COUNT).into_par_iter().map(one).collect();
        let determined = ends.iter().filter(|ended| ended.least.is_some()).count();
        assert!(determined > 5, "{class:?}: {determined} of {COUNT} determined");
        let missed: Vec<(usize, &Ended)> =
            ends.iter().enumerate().filter(|(_, ended)| !matches!(ended.end, End::Reached | End::Undetermined)).collect();
        assert!(missed.is_empty(), "{class:?}: {missed:#?}");
    }
}
