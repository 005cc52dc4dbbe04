//! Many machines: a run is computed in parts, each on its own, and the parts are put together to what one run would have written, byte for byte.
//!
//! A part is a function of the scenario's text, the seed, the methods and its range of trials; it needs nothing of the others.

mod error;
mod gathered;
mod merge;
mod work;

pub use error::MergeError;
pub use merge::{Merged, merge};
pub use work::{Done, Wanted, run, run_sweep, trials};
