//! Adjustments that hold back gross errors, by the scale of the residuals and not by what was said of them.

use std::collections::BTreeSet;

use calibench_model::camera::CameraModel;

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
    let mut lengths: Vec<f64> = pairs.map(|[x, y]| x.hypot(y)).collect();
    let middle = lengths.len() / 2;
    if lengths.is_empty() {
        return None;
    }
    let (_, median, _) = lengths.select_nth_unstable_by(middle, f64::total_cmp);
    Some(*median / MEDIAN)
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
    let mut options = Options { huber: Some(bound), ..options.clone() };
    let mut solution = adjust_from(network, &options, State::of(network))?;
    for _ in 0..ROUNDS {
        let last = options.huber.unwrap_or(bound);
        let Some(next) = solution.scale().filter(|scale| *scale > ROUNDING).map(|scale| bound * scale) else { break };
        if (next / last - 1.0).abs() < STANDS {
            break;
        }
        options.huber = Some(next);
        solution = adjust_from(network, &options, solution.end.state.clone())?;
    }
    let bound = options.huber.unwrap_or(bound);
    Ok((solution, bound))
}

/// Least squares without all that is gross, where that is much: left out together, by a robust adjustment, and taken in again where they fit. `None` where
/// it is little, or where the others do not determine the network.
///
/// # Errors
/// As [`adjust`](crate::adjust).
pub(super) fn without_gross<'n>(network: &'n Network, options: &Options) -> Result<Option<(Solution<'n>, Vec<Found>)>, AdjustError> {
    let mut pictured = options.clone();
    pictured.left_out.extend(not_pictured(network));
    let (mut solution, _) = adjust_robustly(network, &pictured, BOUND)?;
    let never: BTreeSet<usize> = options.left_out.iter().copied().collect();
    let mut gross: Vec<(usize, f64)> = Vec::new();
    for _ in 0..ROUNDS {
        let Some(scale) = solution.scale().filter(|scale| *scale > ROUNDING) else { return Ok(None) };
        let found = solution.gross(scale, &never);
        let same = found.iter().map(|(index, _)| index).eq(gross.iter().map(|(index, _)| index));
        gross = found;
        if gross.len() <= FEW.1.max((FEW.0 * network.observations.len() as f64) as usize) {
            return Ok(None);
        }
        if same {
            break;
        }
        let left_out = options.left_out.iter().copied().chain(gross.iter().map(|(index, _)| *index)).collect();
        let without = Options { left_out, ..options.clone() };
        let Ok(next) = adjust_from(network, &without, solution.end.state.clone()) else { return Ok(None) };
        solution = next;
    }
    let found = gross.into_iter().map(|(observation, w)| Found { observation, w, critical: GROSS, left_out: true });
    Ok(Some((solution, found.collect())))
}

/// Observations that the start values do not picture.
fn not_pictured(network: &Network) -> impl Iterator<Item = usize> + '_ {
    let state = State::of(network);
    (0..network.observations.len()).filter(move |&index| {
        let o = &network.observations[index];
        let ray = state.poses[o.image].ray(&state.points[o.point]);
        state.cameras[network.images[o.image].camera].project(ray).is_err()
    })
}
