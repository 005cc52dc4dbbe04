//! How fast: every operator beside OpenCV's cornerSubPix on the same points, rendering, and the detector. `cargo bench --workspace --bench perf`.
//!
//! Rounds are interleaved (A B C A B C ...), so that a machine that is slower for a while is so for all; medians are printed.

mod points;
mod render;
mod scene;
mod warp;

use std::time::Instant;

use calibench_measure::{Board, BoardDetector};

fn main() {
    // Cargo asks for a list or a test run in some of its commands.
    if std::env::args().any(|argument| argument == "--list" || argument == "--test") {
        return;
    }
    if std::env::args().all(|argument| argument != "--rendering") {
        points::run();
        detection();
    }
    render::run();
    detection();
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

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
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
