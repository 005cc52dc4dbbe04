//! Learns the tables of likelihoods of contours from rendered campaigns, and writes them where the crate reads them:
//! `cargo run --release -p calibench-recognise --example learn_contours`.

#[path = "../tests/campaign/mod.rs"]
mod campaign;

use campaign::{LEARNED, Lesson, learn};

fn main() -> std::io::Result<()> {
    std::fs::write(concat!(env!("CARGO_MANIFEST_DIR"), "/data/contours.csv"), learn(&LEARNED, Lesson::All).to_csv())?;
    std::fs::write(concat!(env!("CARGO_MANIFEST_DIR"), "/data/contours-few.csv"), learn(&LEARNED[..1], Lesson::Few).to_csv())
}
