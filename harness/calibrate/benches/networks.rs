//! How many networks drawn at random are calibrated from nothing, by class. `cargo bench --workspace --bench networks`, followed by `-- COUNT SEED` for
//! other numbers than 286 of a class and seed 2.
//!
//! *Determined*: the adjustment that starts at the truth converges, the standard deviation of the first focal length is below 5 %, the predicted error over
//! the frame below 2 px. *Reached*: a sum of squares within 1e-4 of that adjustment's.

#[path = "../tests/networks/draw.rs"]
mod draw;
#[path = "../tests/networks/score.rs"]
mod score;

use std::time::Instant;

use draw::{CLASSES, Drawn};
use rayon::prelude::*;
use score::{End, ended};

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if arguments.iter().any(|argument| argument == "--list" || argument == "--test") {
        return;
    }
    let mut numbers = arguments.iter().filter_map(|argument| argument.parse::<u64>().ok());
    let (count, seed) = (numbers.next().unwrap_or(286), numbers.next().unwrap_or(2));
    println!("{count} networks of a class, seed {seed}");
    println!(
        "{:<24} {:>10} {:>8} {:>13} {:>15} {:>8} {:>10}",
        "object, model", "determined", "reached", "above, warned", "above, unwarned", "stopped", "s, all"
    );
    for class in CLASSES {
        let begin = Instant::now();
        let ends: Vec<End> = (0..count).into_par_iter().map(|number| ended(class, &Drawn::network(class, seed, number))).collect();
        let of = |what: fn(&End) -> bool| ends.iter().filter(|end| what(end)).count();
        println!(
            "{:<24} {:>10} {:>8} {:>13} {:>15} {:>8} {:>10.1}",
            format!("{:?}, {}", class.object, class.model),
            of(|end| *end != End::Undetermined),
            of(|end| *end == End::Reached),
            of(|end| matches!(end, End::Above { warned: true, .. })),
            of(|end| matches!(end, End::Above { warned: false, .. })),
            of(|end| matches!(end, End::Stopped(_))),
            begin.elapsed().as_secs_f64()
        );
        for (number, end) in ends.iter().enumerate().filter(|(_, end)| !matches!(end, End::Reached | End::Undetermined)) {
            println!("    number {number}: {end:?}");
        }
    }
}
