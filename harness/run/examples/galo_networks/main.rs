//! Networks that could have been Galo et al. 2011's: `cargo run --release --example galo_networks [-- CHAINS]`.
//!
//! The paper prints of its network: ten images, of which 6 to 10 are convergent, 326 image points, the camera and its pixel, and of images 6, 1 and 9 base to
//! height and distance. Networks that have this much are drawn (`drawn.rs` says how), and each is calibrated once with noise. Those whose four standard
//! deviations agree with the first column of Table 2 within a tenth are kept, with what the *same* calibration says of everything else.
//!
//! Of 40,000 networks drawn apart three agreed in one of eight calibrations; so each chain starts at one that does and then draws one part of it anew at a time, staying where the new one does
//! not agree: approximate Bayesian computation by a Markov chain (Marjoram et al. 2003), under the distribution of `drawn.rs`. Subpixel coordinates have as
//! much noise as gives sigma of c in their column; nothing else of these columns is used, and nothing of Tables 3 and 4.
//!
//! The rows go to `reference/published/galo-2011/networks.csv`, which the report of the paper reads.

mod chain;
mod drawn;
mod kept;
mod screened;

use std::error::Error;

use rayon::prelude::*;

use kept::Kept;

/// Chains, each from another start.
const CHAINS: u64 = 40;

fn main() -> Result<(), Box<dyn Error>> {
    let chains = std::env::args().nth(1).map_or(Ok(CHAINS), |text| text.parse())?;
    let walked: Vec<chain::Walked> = (0..chains).into_par_iter().map(chain::walk).collect();
    let sum = |of: fn(&chain::Walked) -> u64| walked.iter().map(of).sum::<u64>();
    println!(
        "{} networks were drawn before {chains} agreed with the print; of {} steps from there {} were taken.",
        sum(|walked| walked.before),
        sum(|walked| walked.steps),
        sum(|walked| walked.taken)
    );
    let kept: Vec<Kept> = walked.into_iter().flat_map(|walked| walked.kept).collect();
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../reference/published/galo-2011/networks.csv");
    kept::write(path.as_ref(), &kept)
}
