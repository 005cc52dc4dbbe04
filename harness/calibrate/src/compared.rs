//! What several sets of parameters make of the same observations.

use calibench_adjust::{Comparison, Significance};

/// The adjustments of several sets.
#[derive(Clone, Debug)]
pub struct Compared {
    /// In the order given.
    pub sets: Vec<ComparedSet>,
}

/// A set and its adjustment.
#[derive(Clone, Debug)]
pub struct ComparedSet {
    /// The parameters that are solved for.
    pub names: Vec<String>,
    /// What came out; or what the network does not determine, in words.
    pub result: Result<SetResult, String>,
    /// The largest other set that is a part of this one, and the test of what this one has more. `None` without such a set.
    pub against: Option<(usize, Comparison)>,
}

/// What came out of a set.
#[derive(Clone, Debug)]
pub struct SetResult {
    /// The estimated standard deviation of an image coordinate, px (that of unit weight times the a-priori one).
    pub sigma0_px: f64,
    /// Observations, unknowns.
    pub counts: (usize, usize),
    /// Akaike's criterion, corrected for few observations: the smaller is the better, its differences count.
    pub aicc: f64,
    /// Each parameter against zero, with its name (and its camera's, if there are several).
    pub tests: Vec<(String, Significance)>,
    /// How far its cameras lie from those of the calibration, after the best rotation: RMS and most over the frame, px; `None` where they cannot be compared.
    pub change_px: Option<[f64; 2]>,
}
