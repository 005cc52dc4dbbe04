//! Data snooping: one suspect of an image after the other.

use std::collections::{BTreeMap, BTreeSet};

use super::reliability::Test;
use super::robust::{Rays, without_gross};
use crate::AdjustError;
use crate::network::Network;
use crate::solution::{Options, Solution, adjust_from};
use crate::state::State;

/// How to look for wrong observations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Snooping {
    /// The test.
    pub test: Test,
    /// Image points that may be left out beside those that are gross together, at most.
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

/// Adjusts, leaves out what Baarda's test rejects, adjusts again, until nothing is rejected: the image point with the largest normalised residual beyond the
/// critical value of each image at a time, since an error shows most where it is. What was left out and fits in the end is taken in again.
///
/// Where more than a hundredth of the image points are beyond ten standard deviations they hide one another: then all of them that a robust adjustment shows are left out
/// first, together.
///
/// Returns the last solution and every image point that was rejected; none disappears: [`Solution::residuals`] lists them as left out.
///
/// # Errors
/// As [`crate::adjust`], of the network as given.
///
/// Source: Baarda 1968.
pub fn snoop<'n>(network: &'n Network, options: &Options, snooping: Snooping) -> Result<(Solution<'n>, Vec<Found>), AdjustError> {
    network.check()?;
    let (solution, found) = match without_gross(network, options) {
        Some(found) => found,
        None => (adjust_from(network, options, State::of(network))?, Vec::new()),
    };
    let mut search = Search { options, snooping, together: found.len(), solution, found };
    search.reject()?;
    if search.take_in_again() {
        search.reject()?;
    }
    Ok((search.solution, search.found))
}

/// Rejections so far.
struct Search<'o, 'n> {
    options: &'o Options,
    snooping: Snooping,
    solution: Solution<'n>,
    found: Vec<Found>,
    /// How many were left out first.
    together: usize,
}

impl<'n> Search<'_, 'n> {
    /// Least squares without what was left out, and without `more`.
    fn without(&self, more: &[usize]) -> Result<Solution<'n>, AdjustError> {
        let left_out = self.gone().into_iter().chain(more.iter().copied()).collect();
        adjust_from(self.solution.network(), &Options { left_out, ..self.options.clone() }, self.solution.end.state.clone())
    }

    /// What was left out.
    fn gone(&self) -> BTreeSet<usize> {
        let found = self.found.iter().filter(|found| found.left_out).map(|found| found.observation);
        self.options.left_out.iter().copied().chain(found).collect()
    }

    /// How many more may be left out.
    fn rest(&self) -> usize {
        let so_far = self.found.iter().filter(|found| found.left_out).count();
        (self.snooping.most + self.together).saturating_sub(so_far)
    }

    /// Leaves out what is rejected, until nothing is.
    fn reject(&mut self) -> Result<(), AdjustError> {
        loop {
            let mut suspects = self.suspects()?;
            if suspects.is_empty() {
                return Ok(());
            }
            let (mut rays, found) = (Rays::without(self.solution.network(), &self.gone()), &mut self.found);
            suspects.retain(|suspect| {
                let goes = rays.take(suspect.observation);
                found.extend((!goes).then_some(*suspect));
                goes
            });
            if suspects.is_empty() {
                continue;
            }
            let rest = self.rest().min(suspects.len());
            let observations: Vec<usize> = suspects[..rest].iter().map(|suspect| suspect.observation).collect();
            // Where the network needs one of them the worst is asked for alone.
            for count in [rest, 1.min(rest)].into_iter().filter(|count| *count > 0) {
                if let Ok(better) = self.without(&observations[..count]) {
                    self.solution = better;
                    suspects[..count].iter_mut().for_each(|suspect| suspect.left_out = true);
                    break;
                }
                suspects.truncate(1);
            }
            self.found.extend(suspects);
        }
    }

    /// Of each image the worst point that is rejected and was not so far, the worst of all first.
    fn suspects(&self) -> Result<Vec<Found>, AdjustError> {
        let reliability = self.solution.reliability(self.snooping.test)?;
        let refused: BTreeSet<usize> = self.found.iter().map(|found| found.observation).collect();
        let images = &self.solution.network().observations;
        let mut worst: BTreeMap<usize, Found> = BTreeMap::new();
        for point in reliability.points.iter().filter(|point| !refused.contains(&point.observation)) {
            let w = point.w[0].abs().max(point.w[1].abs());
            let of_image = worst.get(&images[point.observation].image).map_or(reliability.critical, |worst| worst.w);
            if w > of_image {
                let found = Found { observation: point.observation, w, critical: reliability.critical, left_out: false };
                worst.insert(images[point.observation].image, found);
            }
        }
        let mut suspects: Vec<Found> = worst.into_values().collect();
        suspects.sort_by(|a, b| b.w.total_cmp(&a.w));
        Ok(suspects)
    }

    /// Takes in what was left out and fits, as it is without it; whether there is any. What does not stand its test then is rejected again.
    fn take_in_again(&mut self) -> bool {
        let Ok((critical, sigma0)) = self.solution.bound(self.snooping.test) else { return false };
        let before = self.found.clone();
        let observations = &self.solution.network().observations;
        let residuals = self.solution.residuals();
        let fits = |found: &Found| {
            let white = residuals[found.observation].v.map(|v| observations[found.observation].precision.whitened(v));
            white.is_some_and(|v| v[0].abs().max(v[1].abs()) < critical * sigma0)
        };
        self.found.retain(|found| !(found.left_out && fits(found)));
        if self.found.len() == before.len() {
            return false;
        }
        match self.without(&[]) {
            Ok(solution) => self.solution = solution,
            Err(_) => self.found = before,
        }
        true
    }
}
