//! Wrong decisions by contours on small squares and triangles, %, by what the table of likelihoods was learned on:
//! `cargo run --release -p calibench-recognise --example lessons [-- SEED...]`. Printed: 3, 7 and 17 % at 0, 30 and 45 degrees.

#![allow(clippy::print_stdout)]

#[path = "../tests/campaign/mod.rs"]
mod campaign;

use calibench_recognise::{Classifier, ContourTable, Recogniser, SizeGroup};
use campaign::{Counts, LEARNED, Lesson, Setting, learn, paper_tilts, shots};

const SETTINGS: [(f64, f64); 8] = [(0.6, 46.0), (0.6, 26.0), (0.7, 30.0), (0.8, 46.0), (0.8, 30.0), (0.8, 26.0), (0.9, 26.0), (1.0, 26.0)];

fn main() {
    let seeds: Vec<u64> = std::env::args().skip(1).filter_map(|seed| seed.parse().ok()).collect();
    let seeds = if seeds.is_empty() { (1001..=1005).collect() } else { seeds };
    let lessons = vec![
        ("all positions and settings", learn(&LEARNED, Lesson::All)),
        ("frontal, all settings", learn(&LEARNED, Lesson::Frontal)),
        ("three sharp frontal images", learn(&LEARNED[..1], Lesson::Few)),
        ("nothing", ContourTable::default()),
    ];
    println!("| blur, px | contrast, dB | learned on | phi 0 | phi 30 | phi 45 | 45 over 30 |\n|--:|--:|---|--:|--:|--:|--:|");
    for setting in SETTINGS {
        let counts = counted(&seeds, setting, &lessons);
        for ((name, _), counts) in lessons.iter().zip(&counts) {
            let [a, b, c] = counts.decisions.map(|groups| {
                let [all, _, joint] = groups[SizeGroup::SmallAngular as usize];
                100.0 * joint as f64 / all.max(1) as f64
            });
            println!("| {} | {} | {name} | {a:.2} | {b:.2} | {c:.2} | {:.2} |", setting.0, setting.1, c / b);
        }
    }
}

fn counted(seeds: &[u64], (blur, decibel): (f64, f64), lessons: &[(&str, ContourTable)]) -> Vec<Counts> {
    let mut counts = vec![Counts::default(); lessons.len()];
    for &seed in seeds {
        let setting = Setting::paper(seed, blur, decibel);
        let field = setting.testfield();
        let taken = shots(&setting, &field, &paper_tilts(), &[0.0, 90.0, 180.0, 270.0]);
        for ((_, table), counts) in lessons.iter().zip(&mut counts) {
            let recogniser = Recogniser::new(&field, Classifier::Contours).expect("a coded field").with_table(table.clone());
            taken.iter().for_each(|shot| counts.add(&field, shot, &recogniser.recognise(&shot.image)));
        }
    }
    counts
}
