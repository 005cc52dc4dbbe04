//! Adjustments that hold back gross errors, by the scale of the residuals and not by what was said of them.

use std::collections::BTreeSet;

use calibench_model::upper_median;

use super::snooping::Found;
use crate::AdjustError;
use crate::descent::ROUGH;
use crate::network::{Network, Status};
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
/// Steps of each where gross errors are only to be shown.
const ROUGH_STEPS: usize = 30;
/// Huber's bound of the adjustment that shows gross errors, in standard deviations.
const BOUND: f64 = 1.5;
/// Residuals (as vectors) beyond so many standard deviations are gross: what an operator scatters now and then is left to Baarda's test.
const GROSS: f64 = 10.0;
/// Rays that a point needs.
const NEEDED: usize = 2;
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
        let mut gross: Vec<(usize, f64)> = each.filter(|(index, length)| *length > GROSS && !never.contains(index)).collect();
        // Of a point that would be left with too few rays the shortest stay.
        let mut rays = Rays::without(self.network(), never);
        gross.sort_by(|a, b| b.1.total_cmp(&a.1));
        gross.retain(|(index, _)| rays.take(*index));
        gross.sort_by_key(|(index, _)| *index);
        gross
    }
}

/// How many rays each point has, and which it cannot do without.
pub(super) struct Rays<'n> {
    network: &'n Network,
    left: Vec<usize>,
}

impl<'n> Rays<'n> {
    /// Of all observations but those of `gone`.
    pub(super) fn without(network: &'n Network, gone: &BTreeSet<usize>) -> Self {
        let mut left = vec![0; network.points.len()];
        network.observations.iter().enumerate().filter(|(index, _)| !gone.contains(index)).for_each(|(_, o)| left[o.point] += 1);
        Self { network, left }
    }

    /// Takes an observation out if its point can do without: what is wrong with one that cannot moves nothing else.
    pub(super) fn take(&mut self, observation: usize) -> bool {
        let point = self.network.observations[observation].point;
        let is_free = self.network.points[point].coordinates.contains(&Status::Free);
        let goes = !is_free || self.left[point] > NEEDED;
        self.left[point] -= usize::from(goes);
        goes
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
    robustly(network, options, bound, bound)
}

/// [`adjust_robustly`], of which the first adjustment has the bound `scaled`, in a-priori standard deviations.
fn robustly<'n>(network: &'n Network, options: &Options, bound: f64, mut scaled: f64) -> Result<(Solution<'n>, f64), AdjustError> {
    let at = |scaled: f64| Options { huber: Some(scaled), ..options.clone() };
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
    let (mut not_pictured, mut white) = (Vec::new(), Vec::new());
    for (index, observation) in network.observations.iter().enumerate() {
        match start.pixel(network, observation) {
            Some(pixel) => white.push(observation.precision.whitened([pixel.x - observation.position.x, pixel.y - observation.position.y])),
            None => not_pictured.push(index),
        }
    }
    // A bound far below what the residuals scatter makes all of them long: sums of lengths, which take a thousand steps to their least.
    let scaled = BOUND * scale_of(white.into_iter())?.max(1.0);
    let rough = Options { worth: ROUGH, most_iterations: ROUGH_STEPS, ..left_out(&mut not_pictured.into_iter()) };
    let (mut solution, _) = robustly(network, &rough, BOUND, scaled).ok()?;
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
