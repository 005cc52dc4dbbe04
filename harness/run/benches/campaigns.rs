//! Seconds of whole campaigns, one thread: 36 images of Vosselman and Förstner rendered, recognised, measured, adjusted in blocks; calibrations of the Canon T3 study
//! applied to its wall. `cargo bench --workspace --bench campaigns`.

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::path::Path;
use std::time::Instant;

use calibench_measure::registry::Build;
use calibench_measure::{Registry, opencv_subpix};
use calibench_run::Plan;
use calibench_scenario::{Scenario, parse};

const NAME: &str = "vosselman-1988/campaign";
const STUDY: &str = "canon-t3/study";
/// Cases of the study that are not mistakes put in.
const FIRST_CASES: usize = 4;
/// Trials of the study beyond the first.
const TRIALS: u64 = 20;
/// Campaigns beyond the first, which has the bounds of all targets besides.
const MORE: u64 = 3;
/// What the paper's took, s an image.
const PAPER: f64 = 1800.0;

fn main() -> Result<(), Box<dyn Error>> {
    if std::env::args().any(|argument| argument == "--list" || argument == "--test") {
        return Ok(());
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios").join(format!("{NAME}.toml"));
    let text = std::fs::read_to_string(&path)?;
    let second = text.match_indices("[[method]]").nth(1).map_or(text.len(), |(at, _)| at);
    let one = text[..second].replace("[\"modern\", \"contours\"]", "[\"modern\"]");
    println!("{:<64} {:>10} {:>18}", "one thread; the paper: 36 images of 1800 s", "s", "the paper's, times");
    for (what, text) in
        [("a campaign, one method, one recogniser (2 s asked)", &one), ("as in the scenario: four methods, two recognisers", &text)]
    {
        let scenario = parse(NAME, "campaign.toml", text, &Registry::builtin()).map_err(|problems| problems.to_string())?;
        let seconds = campaign(&scenario)?;
        println!("{what:<64} {seconds:>10.2} {:>18.0}", 36.0 * PAPER / seconds);
    }
    transfer()
}

/// Milliseconds of a trial of the Canon T3 study, with its decompositions and without.
fn transfer() -> Result<(), Box<dyn Error>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios").join(format!("{STUDY}.toml"));
    let text = std::fs::read_to_string(&path)?;
    let plain = &text[..text.find("[[transfer.decomposition]]").unwrap_or(text.len())];
    let first = &plain[..plain.match_indices("[[transfer.case]]").nth(FIRST_CASES).map_or(plain.len(), |(at, _)| at)];
    println!("\n{:<64} {:>10}", "a trial of `canon-t3/study`, one thread", "ms");
    for (what, text) in [
        ("six methods, poses held and resected, exact and naive (30 ms asked)", first),
        ("all cases", plain),
        ("all cases and decompositions", text.as_str()),
    ] {
        let registry = Registry::builtin().with(opencv_subpix::method(Build::Unavailable("a bench"), "none".into()));
        let scenario = parse(STUDY, &path.display().to_string(), text, &registry).map_err(|problems| problems.to_string())?;
        println!("{what:<64} {:>10.1}", 1e3 * several(&scenario, TRIALS)?);
    }
    Ok(())
}

/// Seconds of one campaign of Vosselman and Förstner.
fn campaign(scenario: &Scenario) -> Result<f64, Box<dyn Error>> {
    several(scenario, MORE)
}

/// Seconds of a trial, from the difference of `more` trials and the first.
fn several(scenario: &Scenario, more: u64) -> Result<f64, Box<dyn Error>> {
    let single = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let run = |trials: u64| -> Result<f64, String> {
        let plan = Plan { trials, ..Plan::new(scenario, calibench_run::Tools::default(), ".".into()) };
        let start = Instant::now();
        single.install(|| plan.run(&|| (), &mut |_| Ok(()))).map_err(|error| error.to_string())?;
        Ok(start.elapsed().as_secs_f64())
    };
    let first = run(1)?;
    Ok((run(1 + more)? - first) / more as f64)
}
