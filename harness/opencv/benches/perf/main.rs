//! How fast: every operator beside OpenCV's cornerSubPix on the same points, rendering, and the detector. `cargo bench --workspace --bench perf`.
//!
//! Rounds are interleaved (A B C A B C ...), so that a machine that is slower for a while is so for all; medians are printed.

mod classical;
mod points;
mod render;
mod required;
mod scene;
mod warp;

use std::time::Instant;

use calibench_measure::{Board, BoardDetector};
use calibench_model::upper_median;

fn main() {
    // Cargo asks for a list or a test run in some of its commands.
    if std::env::args().any(|argument| argument == "--list" || argument == "--test") {
        return;
    }
    // A part alone, by its name: `cargo bench --workspace --bench perf -- rendering`.
    let parts: [(&str, fn()); 5] = [
        ("required", required::run),
        ("points", points::run),
        ("classical", classical::run),
        ("rendering", render::run),
        ("detection", detection),
    ];
    let asked: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with('-')).collect();
    for (_, run) in parts.iter().filter(|(name, _)| asked.is_empty() || asked.iter().any(|part| part == name)) {
        run();
    }
}

/// Seconds that `work` takes: the median of five runs.
fn seconds(mut work: impl FnMut()) -> f64 {
    median((0..5).map(|_| timed(&mut work)).collect())
}

fn timed(work: &mut impl FnMut()) -> f64 {
    let clock = Instant::now();
    work();
    clock.elapsed().as_secs_f64()
}

fn median(values: Vec<f64>) -> f64 {
    upper_median(values).expect("a round")
}

fn detection() {
    println!("\nChessboard detector, 12 megapixels, looking for 9x6, or for the board that is there:");
    let detector = calibench_opencv::detector();
    for (name, image) in scene::frames() {
        let board = if name.contains("30x22") { Board { columns: 29, rows: 21 } } else { Board { columns: 9, rows: 6 } };
        let mut found = false;
        let clock = Instant::now();
        found |= detector.detect(&image, board).is_some();
        let seconds = clock.elapsed().as_secs_f64();
        println!("  {name:<44} {seconds:>8.3} s   {}", if found { "found" } else { "not found" });
    }
}
