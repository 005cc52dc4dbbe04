//! Time and memory of `measure`, `intersect` and `calibrate` by the number of rows, in 50 images: both must grow no faster than the rows.
//!
//! `cargo bench --workspace --bench rows`, followed by `-- ROWS...` for other numbers than 10^5, 10^6 and 10^7, and by names of commands for some of them
//! alone. Bytes a row are those between one number of rows and the next, without the growth of the file: what does not depend on the rows does not
//! count. Memory is the most that was resident, which Linux alone says.

mod network;
#[path = "../program.rs"]
mod program;

use std::error::Error;
use std::path::Path;

use network::Network;
use program::{Spent, run};

/// Rows without an argument.
const ROWS: [usize; 3] = [100_000, 1_000_000, 10_000_000];
/// Commands and the bytes that a row may take.
const MOST: [(&str, f64); 4] = [("measure", 150.0), ("intersect", 150.0), ("calibrate", 300.0), ("calibrate --report", 300.0)];

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if arguments.iter().any(|argument| argument == "--list" || argument == "--test") {
        return Ok(());
    }
    let mut rows: Vec<usize> = arguments.iter().filter_map(|argument| argument.parse().ok()).collect();
    if rows.is_empty() {
        rows.extend(ROWS);
    }
    let named = |command: &str| arguments.iter().any(|argument| argument == command);
    let all = !MOST.iter().any(|(command, _)| named(command));
    let folder = tempfile::tempdir()?;
    println!("{:<20} {:>10} {:>8} {:>9} {:>9} {:>10} {:>8}", "", "rows", "s", "MB", "file MB", "bytes/row", "at most");
    let mut before: Vec<Option<(usize, u64, Spent)>> = vec![None; MOST.len()];
    for rows in rows {
        let files = Network::of(rows).write(folder.path())?;
        for ((command, most), before) in MOST.iter().zip(&mut before).filter(|((command, _), _)| all || named(command)) {
            let spent = run(&arguments_of(command, folder.path()), folder.path())?;
            let grown = before.as_ref().map(|(fewer, file, earlier)| {
                let beyond = spent.peak as f64 - earlier.peak as f64 - (files as f64 - *file as f64);
                beyond / (rows - fewer) as f64
            });
            let grown_text = grown.map_or_else(|| "-".to_owned(), |bytes| format!("{bytes:.0}"));
            let [peak, file] = [spent.peak, files].map(|bytes| bytes as f64 / 1e6);
            println!("{command:<20} {rows:>10} {:>8.2} {peak:>9.0} {file:>9.0} {grown_text:>10} {most:>8.0}", spent.seconds);
            *before = Some((rows, files, spent));
        }
    }
    Ok(())
}

fn arguments_of(command: &str, folder: &Path) -> Vec<String> {
    let size = format!("{}x{}", network::WIDTH, network::HEIGHT);
    let words: Vec<&str> = match command {
        "measure" => vec!["measure", "--points", "points.csv", "-o", "measured.csv"],
        "intersect" => {
            vec!["intersect", "--camera", "camera.yml", "--points", "points.csv", "--stations", "stations.csv", "-o", "found.csv"]
        }
        _ => vec!["calibrate", "--points", "points.csv", "--control", "control.csv", "--size", &size, "-o", "found.toml"],
    };
    let mut words: Vec<String> = words.into_iter().map(str::to_owned).collect();
    match command {
        "measure" => words.extend((0..network::IMAGES).map(|image| format!("{}.png", network::name(image)))),
        "calibrate --report" => words.extend(["--report", "report"].map(str::to_owned)),
        _ => {}
    }
    words.push("-q".to_owned());
    // What the command before left may not be read by this one.
    for file in ["measured.csv", "found.csv", "found.toml"] {
        std::fs::remove_file(folder.join(file)).ok();
    }
    words
}
