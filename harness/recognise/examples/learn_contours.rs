//! Learns the table of likelihoods of contours from rendered campaigns, and writes it where the crate reads it:
//! `cargo run --release -p calibench-recognise --example learn_contours`. With `few`, from three frontal images alone, to standard output.

#![allow(clippy::print_stdout)]

#[path = "../tests/campaign/mod.rs"]
mod campaign;

use campaign::{LEARNED, learn};

fn main() -> std::io::Result<()> {
    if std::env::args().nth(1).as_deref() == Some("few") {
        print!("{}", learn(&LEARNED[..1], true).to_csv());
        return Ok(());
    }
    std::fs::write(concat!(env!("CARGO_MANIFEST_DIR"), "/data/contours.csv"), learn(&LEARNED, false).to_csv())
}
