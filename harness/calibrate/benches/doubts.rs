//! How often sound calibrations are doubted, planted mistakes named, gross errors left out and broken assumptions said: tables of as many draws of each kind as the first
//! argument says (a tenth of that but of sound ones), 1000 and 100 without one.

#[allow(dead_code, reason = "the tests use the rest")]
#[path = "../tests/surveys/broken.rs"]
mod broken;
#[allow(dead_code, reason = "the tests use the rest")]
#[path = "../tests/surveys/network.rs"]
mod network;
#[allow(dead_code, reason = "the tests use the rest")]
#[path = "../tests/surveys/planted.rs"]
mod planted;

use broken::{BROKEN, GROSS, Given, SNOOPED, STRAINED, given, with};
use calibench_calibrate::GrossErrors;
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
    println!("\n| {mistaken} draws of each | asked for | px off, median | left out, mean | refused | doubted | wrong without a word |");
    println!("|---|---|--:|--:|--:|--:|--:|");
    for (what, draw) in GROSS.into_iter().chain(BROKEN).chain(STRAINED) {
        for (name, gross) in [("plain", GrossErrors::Kept), ("default", GrossErrors::Sought), ("snoop", SNOOPED)] {
            let of_seed = |seed| {
                let (input, truth) = draw(seed);
                given(&with(&input, gross), &truth).ok()
            };
            let found: Vec<Given> = (0..mistaken).into_par_iter().filter_map(of_seed).collect();
            println!("| {what} | {name} | {} |", row(&found, mistaken as usize));
        }
    }
}

/// The rest of a row.
fn row(found: &[Given], of: usize) -> String {
    let mut off: Vec<f64> = found.iter().map(|given| given.off_px).collect();
    off.sort_by(f64::total_cmp);
    let median = off.get(off.len() / 2).copied().unwrap_or(f64::INFINITY);
    let left_out = found.iter().map(|given| given.left_out).sum::<usize>() as f64 / found.len().max(1) as f64;
    let count = |is: fn(&Given) -> bool| found.iter().filter(|given| is(given)).count();
    let [doubted, silent] = [count(|given| !given.doubts.is_empty()), count(Given::is_silent)];
    format!("{median:.3} | {left_out:.1} | {} | {doubted} | {silent}", of - found.len())
}
