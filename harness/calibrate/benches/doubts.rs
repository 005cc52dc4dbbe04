//! How often sound calibrations are doubted, and planted mistakes named: a table of as many draws of each kind as the first argument says, 1000 and 100 without one.

#[allow(dead_code, reason = "the tests use the rest")]
#[path = "../tests/surveys/network.rs"]
mod network;
#[allow(dead_code, reason = "the tests use the rest")]
#[path = "../tests/surveys/planted.rs"]
mod planted;

use planted::{MISTAKEN, SOUND, examined, suspects};
use rayon::prelude::*;

/// Draws of each sound kind, and of each mistake.
const DRAWS: [u64; 2] = [1000, 100];

fn main() {
    // Cargo adds words of its own.
    let asked_for = std::env::args().skip(1).find_map(|word| word.parse::<u64>().ok());
    let [sound, mistaken] = asked_for.map_or(DRAWS, |count| [count, count.div_ceil(10)]);
    println!("| sound: {sound} draws of each | refused | doubted | suspected |\n|---|--:|--:|--:|");
    for (what, draw) in SOUND {
        let of_seed = |seed| match examined(&draw(seed)) {
            Err(_) => [1, 0, 0],
            Ok((doubts, suspects)) => [0, usize::from(doubts > 0), usize::from(!suspects.is_empty())],
        };
        let add = |a: [usize; 3], b: [usize; 3]| [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
        let [refused, doubted, suspected] = (0..sound).into_par_iter().map(of_seed).reduce(|| [0; 3], add);
        println!("| {what} | {refused} | {doubted} | {suspected} |");
    }
    println!("\n| planted: {mistaken} draws of each | named first |\n|---|--:|");
    for (kind, (what, draw)) in MISTAKEN {
        let first = (0..mistaken).into_par_iter().filter(|seed| suspects(&draw(*seed)).first().is_some_and(|first| first.kind == kind));
        println!("| {what} | {} |", first.count());
    }
}
