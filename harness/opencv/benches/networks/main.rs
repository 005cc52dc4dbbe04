//! How many networks drawn at random are calibrated from nothing, by class, beside OpenCV. `cargo bench --workspace --bench networks`, followed by
//! `-- COUNT SEED` for other numbers than 286 of a class and seed 2, and by words for some classes alone: `-- 286 2 wall`.
//!
//! *Determined*: the adjustment that starts at the truth converges, the standard deviation of the first focal length is below 5 %, the predicted error over
//! the frame below 2 px. *Reached*: a sum of squares within 1e-4 of that adjustment's. Seconds are those of the calibrations alone. How OpenCV is asked:
//! `theirs.rs`; a dash stands where a class is outside its method.

#[path = "../../../calibrate/tests/networks/draw.rs"]
mod draw;
#[path = "../../../calibrate/tests/networks/score.rs"]
mod score;
mod theirs;

use std::time::Instant;

use draw::{CLASSES, Class, Drawn};
use rayon::prelude::*;
use score::{End, Ended, calibrated, ended};

fn main() -> opencv::Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if arguments.iter().any(|argument| argument == "--list" || argument == "--test") {
        return Ok(());
    }
    opencv::core::set_num_threads(1)?;
    // The LAPACK under `fisheye::calibrate` overflows the usual stack of a thread.
    rayon::ThreadPoolBuilder::new().stack_size(64 << 20).build_global().expect("no pool before");
    let mut numbers = arguments.iter().filter_map(|argument| argument.parse::<u64>().ok());
    let (count, seed) = (numbers.next().unwrap_or(286), numbers.next().unwrap_or(2));
    println!("{count} networks of a class, seed {seed}; OpenCV {}", calibench_opencv::version());
    println!(
        "{:<24} {:>10} {:>8} {:>13} {:>15} {:>8} {:>8} {:>15} {:>10}",
        "object, model", "determined", "reached", "above, warned", "above, unwarned", "stopped", "s, all", "OpenCV: reached", "s, all"
    );
    let words: Vec<&String> = arguments.iter().filter(|word| !word.starts_with('-') && word.parse::<u64>().is_err()).collect();
    let name = |class: &Class| format!("{:?} {}", class.object, class.model).to_lowercase();
    let asked = CLASSES.into_iter().filter(|class| words.iter().all(|word| name(class).contains(&word.to_lowercase())));
    asked.for_each(|class| row(class, count, seed));
    Ok(())
}

/// Draws a class, and prints how it ended.
fn row(class: Class, count: u64, seed: u64) {
    let drawn: Vec<Drawn> = (0..count).into_par_iter().map(|number| Drawn::network(class, seed, number)).collect();
    let begin = Instant::now();
    let results: Vec<_> = drawn.par_iter().map(|drawn| calibrated(class, drawn)).collect();
    let ours = begin.elapsed().as_secs_f64();
    let ends: Vec<Ended> = drawn.par_iter().zip(results).map(|(drawn, result)| ended(class, drawn, result)).collect();
    let begin = Instant::now();
    let peer = theirs::can(class);
    let theirs: Vec<bool> = drawn.par_iter().zip(&ends).map(|(drawn, end)| peer && theirs::reached(class, drawn, end.least)).collect();
    let seconds = if peer { format!("{:.1}", begin.elapsed().as_secs_f64()) } else { "-".into() };
    let reached = theirs.iter().filter(|reached| **reached).count();
    let of = |what: fn(&End) -> bool| ends.iter().filter(|ended| what(&ended.end)).count();
    println!(
        "{:<24} {:>10} {:>8} {:>13} {:>15} {:>8} {ours:>8.1} {:>15} {seconds:>10}",
        format!("{:?}, {}", class.object, class.model),
        ends.iter().filter(|ended| ended.least.is_some()).count(),
        of(|end| *end == End::Reached),
        of(|end| matches!(end, End::Above { warned: true, .. })),
        of(|end| matches!(end, End::Above { warned: false, .. })),
        of(|end| matches!(end, End::Stopped(_))),
        if peer { reached.to_string() } else { "-".into() }
    );
    for (number, (Ended { end, .. }, theirs)) in ends.iter().zip(&theirs).enumerate() {
        if !matches!(end, End::Reached | End::Undetermined) {
            let beside =
                [", outside OpenCV's method", "; OpenCV did not reach it", "; OpenCV reached it"][usize::from(peer) + usize::from(*theirs)];
            println!("    number {number}: {end:?}{beside}");
        }
    }
}
