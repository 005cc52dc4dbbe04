//! Data snooping: one suspect after the other.

use super::reliability::Test;
use super::robust::without_gross;
use crate::AdjustError;
use crate::network::Network;
use crate::solution::{Options, Solution, adjust_from};
use crate::state::State;

/// How to look for wrong observations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Snooping {
    /// The test.
    pub test: Test,
    /// Image points that may be left out one after the other, at most.
    pub most: usize,
}

impl Default for Snooping {
    fn default() -> Self {
        Self { test: Test::default(), most: 100 }
    }
}

/// A rejected image point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    /// Its index among the observations given.
    pub observation: usize,
    /// The normalised residual for which it was rejected, the larger of x and y in absolute value, or its length where it was left out with others: a number.
    pub w: f64,
    /// What it had to exceed, a number.
    pub critical: f64,
    /// It was left out. `false` if the network needs it, or if as many were left out as may be.
    pub left_out: bool,
}

/// Adjusts, leaves out the image point with the largest normalised residual beyond the critical value, adjusts again, until none is left.
///
/// Where more than a hundredth of the image points are beyond ten standard deviations they hide one another: then all of them that a robust adjustment shows are left out
/// first, together.
///
/// Returns the last solution and every image point that was rejected, in that order; none disappears: [`Solution::residuals`] lists them as left out.
///
/// # Errors
/// As [`crate::adjust`], of the network as given.
///
/// Source: Baarda 1968.
pub fn snoop<'n>(network: &'n Network, options: &Options, snooping: Snooping) -> Result<(Solution<'n>, Vec<Found>), AdjustError> {
    let mut options = options.clone();
    network.check()?;
    let (mut solution, mut found) = match without_gross(network, &options) {
        Some(found) => found,
        None => (adjust_from(network, &options, State::of(network))?, Vec::new()),
    };
    options.left_out.extend(found.iter().map(|found| found.observation));
    let together = found.len();
    loop {
        let reliability = solution.reliability(snooping.test)?;
        let refused = |observation: usize| found.iter().any(|found| found.observation == observation);
        let size = |w: [f64; 2]| w[0].abs().max(w[1].abs());
        let worst = reliability.points.iter().filter(|point| !refused(point.observation)).max_by(|a, b| size(a.w).total_cmp(&size(b.w)));
        let Some(worst) = worst.filter(|worst| size(worst.w) > reliability.critical) else { return Ok((solution, found)) };
        let mut suspect = Found { observation: worst.observation, w: size(worst.w), critical: reliability.critical, left_out: false };
        if found[together..].iter().filter(|found| found.left_out).count() < snooping.most {
            options.left_out.push(suspect.observation);
            match adjust_from(network, &options, solution.end.state.clone()) {
                Ok(better) => (solution, suspect.left_out) = (better, true),
                Err(_) => drop(options.left_out.pop()),
            }
        }
        found.push(suspect);
        if found.len() >= network.observations.len() {
            return Ok((solution, found));
        }
    }
}
