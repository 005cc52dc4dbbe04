//! Adjustments that hold back gross errors, by the scale of the residuals and not by what was said of them.

use std::collections::BTreeSet;

use calibench_model::upper_median;

use super::snooping::Found;
use crate::AdjustError;
use crate::network::Network;
use crate::solution::{Options, Solution, adjust_from};
use crate::state::State;

/// The median of the length of a vector of two normal numbers.
const MEDIAN: f64 = 1.177_41;
/// Standard deviations below which residuals are rounding.
const ROUNDING: f64 = 1e-5;
/// The scale stands when it changes by less than this part.
const STANDS: f64 = 0.01;
/// Adjustments at most, until scale or rejections stand.
const ROUNDS: usize = 12;
/// Huber's bound of the adjustment that shows gross errors, in standard deviations.
const BOUND: f64 = 1.5;
/// Residuals (as vectors) beyond so many standard deviations are gross: what an operator scatters now and then is left to Baarda's test.
const GROSS: f64 = 10.0;
/// Share of the image points beyond, and their number, up to which they are left to be looked at one after the other.
const FEW: (f64, usize) = (0.01, 3);

impl Solution<'_> {
    /// The standard deviation of an image coordinate against the a-priori one, a number, from the median residual of those in use ([`scale_of`]). `None`
    /// without residuals.
    pub fn scale(&self) -> Option<f64> {
        scale_of(self.each_white_residual())
    }

    /// Whether any image point has less than its full weight.
    pub(super) fn is_weighted(&self) -> bool {
        self.end.normals.residuals.iter().any(|residual| residual.weight < 1.0)
    }

    /// The variance factor of an estimate with Huber's weights, against cofactors of the weighted equations: the mean square of what residuals count as by the squared mean of how that changes
    /// with them, and a correction for the number of unknowns. `None` without redundancy.
    ///
    /// Of a vector that is held back to the length `k` the part along it does not change, the one across does by its weight.
    ///
    /// Source: Huber 1981, section 7.6.
    pub(super) fn variance_under_weights(&self) -> Option<f64> {
        let (counts, network) = (self.counts(), self.network());
        let redundancy = counts.redundancy();
        if redundancy <= 0 {
            return None;
        }
        let (mut squares, mut weights, mut slopes, mut slope_squares) = (self.cost(), 0.0, 0.0, 0.0);
        for (sight, residual) in self.engine.layout.sights.iter().zip(&self.end.normals.residuals) {
            let weight = residual.weight;
            let [x, y] = sight.observed(&network.observations).precision.whitened(residual.px);
            let square = x * x + y * y;
            // Its cost is 2 k |v| - k^2, with k = w |v|, and it counts as k^2.
            squares -= 2.0 * square * weight * (1.0 - weight);
            weights += weight;
            let along = if weight < 1.0 { 0.0 } else { 1.0 };
            slopes += 0.5 * (along + weight);
            slope_squares += 0.5 * (along + weight * weight);
        }
        let points = 0.5 * counts.image_coordinates as f64;
        let [weight, slope, slope_square] = [weights, slopes, slope_squares].map(|sum| sum / points);
        let variance = slope_square - slope * slope;
        let few = 1.0 + counts.unknowns as f64 / (2.0 * points) * variance / (slope * slope);
        Some(few * few * squares / redundancy as f64 * weight / (slope * slope))
    }

    /// Every observation whose residual is gross by a scale, but those of `never`; with its length in standard deviations.
    fn gross(&self, scale: f64, never: &BTreeSet<usize>) -> Vec<(usize, f64)> {
        let observations = &self.network().observations;
        let length = |index: usize, v: [f64; 2]| {
            let [x, y] = observations[index].precision.whitened(v);
            x.hypot(y) / scale
        };
        // What cannot be pictured any more is as far off as can be.
        let each = self.each_residual().map(|r| (r.observation, r.v.map_or(f64::INFINITY, |v| length(r.observation, v))));
        each.filter(|(index, length)| *length > GROSS && !never.contains(index)).collect()
    }
}

/// The standard deviation of pairs of numbers of a normal distribution, from the median of their lengths: gross errors hardly change it. `None` of none.
///
/// Source: Rousseeuw & Leroy 1987.
pub fn scale_of(pairs: impl Iterator<Item = [f64; 2]>) -> Option<f64> {
    Some(upper_median(pairs.map(|[x, y]| x.hypot(y)))? / MEDIAN)
}

/// [`adjust`](crate::adjust) with Huber's weights by a `bound` in standard deviations that the residuals show, whatever was said of the precision of image points.
///
/// Returns the solution, and the bound in a-priori standard deviations with which it was found.
///
/// # Errors
/// As [`adjust`](crate::adjust).
///
/// Source: Huber 1981, chapter 7.
pub fn adjust_robustly<'n>(network: &'n Network, options: &Options, bound: f64) -> Result<(Solution<'n>, f64), AdjustError> {
    let at = |scaled: f64| Options { huber: Some(scaled), ..options.clone() };
    let mut scaled = bound;
    let mut solution = adjust_from(network, &at(scaled), State::of(network))?;
    for _ in 0..ROUNDS {
        let Some(scale) = solution.scale().filter(|scale| *scale > ROUNDING) else { break };
        if (bound * scale / scaled - 1.0).abs() < STANDS {
            break;
        }
        scaled = bound * scale;
        solution = adjust_from(network, &at(scaled), solution.end.state.clone())?;
    }
    Ok((solution, scaled))
}

/// Least squares of a checked network without all that is gross, where that is much: left out together, by a robust adjustment, and taken in again where it
/// fits. `None` where it is little, or where this does not come to an end.
pub(super) fn without_gross<'n>(network: &'n Network, options: &Options) -> Option<(Solution<'n>, Vec<Found>)> {
    let left_out = |more: &mut dyn Iterator<Item = usize>| Options {
        left_out: options.left_out.iter().copied().chain(more).collect(),
        ..options.clone()
    };
    let start = State::of(network);
    let mut not_pictured = (0..network.observations.len()).filter(|&i| start.pixel(network, &network.observations[i]).is_none());
    let (mut solution, _) = adjust_robustly(network, &left_out(&mut not_pictured), BOUND).ok()?;
    let never: BTreeSet<usize> = options.left_out.iter().copied().collect();
    let few = FEW.1.max((FEW.0 * network.observations.len() as f64) as usize);
    let mut gross: Vec<(usize, f64)> = Vec::new();
    for _ in 0..ROUNDS {
        let scale = solution.scale().filter(|scale| *scale > ROUNDING)?;
        let found = solution.gross(scale, &never);
        let same = found.iter().map(|(index, _)| index).eq(gross.iter().map(|(index, _)| index));
        gross = found;
        if gross.len() <= few {
            return None;
        }
        if same {
            break;
        }
        let without = left_out(&mut gross.iter().map(|(index, _)| *index));
        solution = adjust_from(network, &without, solution.end.state.clone()).ok()?;
    }
    let found = gross.into_iter().map(|(observation, w)| Found { observation, w, critical: GROSS, left_out: true });
    Some((solution, found.collect()))
}
