//! How fast: every operator beside OpenCV's cornerSubPix on the same points, rendering, and the detector. `cargo bench --workspace --bench perf`.
//!
//! Rounds are interleaved (A B C A B C ...), so that a machine that is slower for a while is so for all; medians are printed.

mod classical;
mod points;
mod scene;

use std::time::Instant;

use calibench_measure::{Board, BoardDetector};
use calibench_model::{PixelPoint, Polygon};

fn main() {
    // Cargo asks for a list or a test run in some of its commands.
    if std::env::args().any(|argument| argument == "--list" || argument == "--test") {
        return;
    }
    classical::run();
    points::run();
    rendering();
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

fn rendering() {
    let pixels = (scene::WIDTH * scene::HEIGHT) as f64 / 1e6;
    let vertices = [(100.3, 90.1), (3900.7, 201.2), (3800.4, 2900.8), (205.5, 2801.6)].map(|(x, y)| PixelPoint::new(x, y));
    let polygon = Polygon { id: String::new(), vertices: vertices.into(), grey: 1.0 };
    let coverage = seconds(|| {
        std::hint::black_box(calibench_synth::coverage::coverage(&polygon, scene::WIDTH, scene::HEIGHT));
    });
    let cells = seconds(|| {
        std::hint::black_box(scene::corners());
    });
    println!("\nRendering, {pixels} megapixels, one thread, noise-free:");
    println!("  {:<44} {:>8.1} Mpx/s", "coverage of one quadrangle", pixels / coverage);
    println!("  {:<44} {:>8.1} Mpx/s", "10000 squares, each rendered in its cell", pixels / cells);
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
