//! Seconds of a whole campaign of Vosselman and Förstner, one thread: 36 images rendered, recognised, measured, adjusted in blocks. `cargo bench --workspace --bench campaigns`.

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::path::Path;
use std::time::Instant;

use calibench_measure::Registry;
use calibench_run::Plan;
use calibench_scenario::{Scenario, parse};

const NAME: &str = "vosselman-1988/campaign";
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
    Ok(())
}

/// Seconds of one campaign, from the difference of several and one.
fn campaign(scenario: &Scenario) -> Result<f64, Box<dyn Error>> {
    let single = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let run = |trials: u64| -> Result<f64, String> {
        let plan = Plan { trials, ..Plan::new(scenario, None, ".".into()) };
        let start = Instant::now();
        single.install(|| plan.run(&|| (), &mut |_| Ok(()))).map_err(|error| error.to_string())?;
        Ok(start.elapsed().as_secs_f64())
    };
    let first = run(1)?;
    Ok((run(1 + MORE)? - first) / MORE as f64)
}
