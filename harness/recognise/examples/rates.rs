//! Rates of the recognition over campaigns: `cargo run --release -p calibench-recognise --example rates [-- SEED...]`.

#![allow(clippy::print_stdout)]

#[path = "../tests/campaign/mod.rs"]
mod campaign;

use calibench_recognise::{Classifier, Recogniser};
use campaign::{Counts, Setting, paper_tilts, shots};

fn main() {
    let seeds: Vec<u64> = std::env::args().skip(1).filter_map(|seed| seed.parse().ok()).collect();
    let seeds = if seeds.is_empty() { vec![1001] } else { seeds };
    for (blur, decibel) in [(0.6, 46.0), (0.6, 26.0), (0.8, 30.0), (0.8, 26.0), (1.0, 26.0), (1.3, 26.0)] {
        let mut counts = [Counts::default(), Counts::default()];
        for &seed in &seeds {
            let setting = Setting::paper(seed, blur, decibel);
            let field = setting.testfield();
            let taken = shots(&setting, &field, &paper_tilts(), &[0.0, 90.0, 180.0, 270.0]);
            for (classifier, counts) in [Classifier::Modern, Classifier::Contours].into_iter().zip(&mut counts) {
                let recogniser = Recogniser::new(&field, classifier).expect("a coded field");
                taken.iter().for_each(|shot| counts.add(&field, shot, &recogniser.recognise(&shot.image)));
            }
        }
        println!("blur {blur} px, {decibel} dB");
        counts[0].print("  modern");
        counts[1].print("  contours");
    }
}
