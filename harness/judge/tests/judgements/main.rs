//! Verdicts on sets drawn at random, whose camera is known.

mod draw;
mod score;

use draw::{CLASSES, Drawn, Fault};
use rayon::prelude::*;
use score::{End, ended};

const SEED: u64 = 3;
const OF_A_CLASS: u64 = 4;

/// Of ten sound sets in eleven the error is within the stated limit, and what is not sound is in doubt or within it too.
#[test]
fn limits_hold_and_what_is_in_doubt_is_said() {
    let jobs: Vec<_> = CLASSES.into_iter().flat_map(|class| (0..OF_A_CLASS).map(move |number| (class, number))).collect();
    let ends: Vec<_> = jobs.into_par_iter().map(|(class, number)| (class, ended(class, &Drawn::set(class, SEED, number), SEED))).collect();
    let told = |end: &End| format!("{}: error {:.3}, limit {:?}, least {:.3}", end.model, end.error, end.limit, end.least);
    let is_uncovered = |end: &&End| end.limit.is_some_and(|limit| limit < end.error);
    let (rolling, sound): (Vec<_>, Vec<_>) = ends.iter().partition(|(class, _)| class.fault == Fault::Rolling);
    let of = |of: &[&(draw::Class, Option<End>)]| of.iter().filter_map(|(_, end)| end.clone()).collect::<Vec<_>>();
    let (rolling, sound) = (of(&rolling), of(&sound));
    assert_eq!((sound.len(), rolling.len()), (8 * OF_A_CLASS as usize, 2 * OF_A_CLASS as usize), "all are judged");
    let missed: Vec<String> = rolling.iter().filter(is_uncovered).map(told).collect();
    assert!(missed.len() <= 1, "rolling and trusted: {missed:?}");
    // With 95 of 100 covered, five or more of 32 are not in one of 80 tests; with 90 withheld of 1000 as many.
    let missed: Vec<String> = sound.iter().filter(is_uncovered).map(told).collect();
    assert!(missed.len() <= 4, "{missed:?}");
    // One of a hundred.
    let moved = sound.iter().filter(|end| end.moved).count();
    assert!(moved <= 2 && sound.iter().any(|end| end.holds), "{moved} true cameras have moved");
    let withheld = sound.iter().filter(|end| end.limit.is_none()).count();
    assert!(withheld <= 5, "{withheld} of {} in doubt", sound.len());
    let regret = (sound.iter().map(|end| (end.error / end.least).ln()).sum::<f64>() / sound.len() as f64).exp();
    let of_truth: Vec<f64> = sound.iter().filter_map(|end| Some((end.of_truth? / end.least).ln())).collect();
    let of_truth = (of_truth.iter().sum::<f64>() / of_truth.len() as f64).exp();
    eprintln!("regret {regret:.3}, of the true model {of_truth:.3}; {withheld} in doubt, {} not covered", missed.len());
    assert!(regret < 1.25 * of_truth, "{regret:.2}, of the true model {of_truth:.2}");
}
