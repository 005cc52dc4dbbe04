//! Gross errors in the images of a rig.

use std::collections::{BTreeMap, BTreeSet};

use super::Rig;
use super::equations::RigState;
use super::solution::{RigSolution, adjust_rig_from};
use crate::AdjustError;
use crate::quality::{Found, Snooping};
use crate::solution::Options;

/// Huber's bound of the adjustment that shows gross errors, in standard deviations as the residuals show them.
const BOUND: f64 = 1.5;
/// Residuals (as vectors) beyond so many standard deviations are gross.
const GROSS: f64 = 10.0;
/// Share of the image points beyond, and their number, up to which they are left to be looked at one after the other.
const FEW: (f64, usize) = (0.01, 3);
/// Robust adjustments at most.
const ROUNDS: usize = 8;
/// Standard deviations below which residuals are rounding.
const ROUNDING: f64 = 1e-5;

/// Adjusts a rig, leaves out what Baarda's test rejects, adjusts again, until nothing is rejected: of each image the point with the largest normalised residual at
/// a time. Where many are gross, all of them that a robust adjustment shows are left out first, together.
///
/// # Errors
/// As [`super::adjust_rig`], of the rig as given.
///
/// Source: Baarda 1968; Huber 1981.
pub fn snoop_rig<'r>(rig: &'r Rig, options: &Options, snooping: Snooping) -> Result<(RigSolution<'r>, Vec<Found>), AdjustError> {
    let (mut solution, mut found) = match without_gross(rig, options) {
        Some(found) => found,
        None => (adjust_rig_from(rig, options, None)?, Vec::new()),
    };
    let together = found.len();
    loop {
        let mut suspects = suspects(&solution, snooping, &found)?;
        let left: usize = found.iter().filter(|found| found.left_out).count();
        suspects.truncate((snooping.most + together).saturating_sub(left));
        if suspects.is_empty() {
            return Ok((solution, found));
        }
        // Where the rig needs one of them the worst is asked for alone.
        for count in [suspects.len(), 1] {
            let gone = found.iter().filter(|found| found.left_out).chain(&suspects[..count]).map(|found| found.observation);
            if let Ok(better) = without(rig, options, gone, &solution.state) {
                suspects[..count].iter_mut().for_each(|suspect| suspect.left_out = true);
                solution = better;
                break;
            }
            suspects.truncate(1);
        }
        found.extend(suspects);
    }
}

fn without<'r>(
    rig: &'r Rig,
    options: &Options,
    gone: impl Iterator<Item = usize>,
    start: &RigState,
) -> Result<RigSolution<'r>, AdjustError> {
    let left_out = options.left_out.iter().copied().chain(gone).collect();
    adjust_rig_from(rig, &Options { left_out, ..options.clone() }, Some(start.clone()))
}

/// Least squares without all that is gross, where that is much.
fn without_gross<'r>(rig: &'r Rig, options: &Options) -> Option<(RigSolution<'r>, Vec<Found>)> {
    let mut state: Option<RigState> = None;
    let (mut bound, mut scale) = (f64::INFINITY, 0.0);
    for _ in 0..ROUNDS {
        let huber = if bound.is_finite() { bound } else { BOUND };
        let robust = adjust_rig_from(rig, &Options { huber: Some(huber), ..options.clone() }, state).ok()?;
        scale = robust.scale().filter(|scale| *scale > ROUNDING)?;
        state = Some(robust.state.clone());
        if (BOUND * scale / huber - 1.0).abs() < 0.01 {
            break;
        }
        bound = BOUND * scale;
    }
    let state = state?;
    let robust = adjust_rig_from(rig, &Options { huber: Some(BOUND * scale), ..options.clone() }, Some(state)).ok()?;
    let never: BTreeSet<usize> = options.left_out.iter().copied().collect();
    let observations = &rig.network.observations;
    let length = |r: &crate::quality::Residual| {
        r.v.map_or(f64::INFINITY, |v| {
            let [x, y] = observations[r.observation].precision.whitened(v);
            x.hypot(y) / scale
        })
    };
    let gross: Vec<Found> = robust
        .residuals()
        .iter()
        .filter(|r| !never.contains(&r.observation) && length(r) > GROSS)
        .map(|r| Found { observation: r.observation, w: length(r), critical: GROSS, left_out: true })
        .collect();
    let few = FEW.1.max((FEW.0 * observations.len() as f64) as usize);
    if gross.len() <= few {
        return None;
    }
    let solution = without(rig, options, gross.iter().map(|found| found.observation), &robust.state).ok()?;
    Some((solution, gross))
}

/// Of each image the worst point that is rejected and was not so far, the worst of all first.
fn suspects(solution: &RigSolution<'_>, snooping: Snooping, found: &[Found]) -> Result<Vec<Found>, AdjustError> {
    let reliability = solution.reliability(snooping.test)?;
    let refused: BTreeSet<usize> = found.iter().map(|found| found.observation).collect();
    let observations = &solution.rig().network.observations;
    let mut worst: BTreeMap<usize, Found> = BTreeMap::new();
    for point in reliability.points.iter().filter(|point| !refused.contains(&point.observation)) {
        let (w, image) = (point.w[0].abs().max(point.w[1].abs()), observations[point.observation].image);
        if w > worst.get(&image).map_or(reliability.critical, |worst| worst.w) {
            worst.insert(image, Found { observation: point.observation, w, critical: reliability.critical, left_out: false });
        }
    }
    let mut suspects: Vec<Found> = worst.into_values().collect();
    suspects.sort_by(|a, b| b.w.total_cmp(&a.w));
    Ok(suspects)
}
