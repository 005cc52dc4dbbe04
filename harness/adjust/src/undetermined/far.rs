//! Points that run away from their images, since these do not tell how far off they are.

use nalgebra::Matrix3;

use super::defects_by_count::counted;
use crate::AdjustError;
use crate::datum::hold;
use crate::descent::EXACT;
use crate::network::{Layout, Network};
use crate::normal::Loss;
use crate::solve::{End, Engine};
use crate::state::State;

/// A standard deviation of a distance, relative to itself, from which it is not known: on the way, and at rest, where points may be weak and are not lost.
const UNKNOWN: [f64; 2] = [0.5, 10.0];

/// The points of `network`, by their index, whose distance from the nearest of their images is known to half of itself or worse after `iterations`, the images being
/// where they are then; where it comes to rest before, those that have none to ten times itself, and `None` without any.
///
/// Where rays are as good as parallel nothing holds a point, and no number of iterations brings it to rest.
///
/// # Errors
/// As of [`crate::adjust`]: what is no network.
pub fn far_points(network: &Network, iterations: usize) -> Result<Option<Vec<usize>>, AdjustError> {
    network.check()?;
    let held = hold(network, &network.datum)?;
    let layout = Layout::new(network, &held, &[])?;
    if let Some(defect) = counted(network, &layout, &held) {
        return Err(AdjustError::Undetermined(Box::new(defect)));
    }
    let engine = Engine::new(network, layout, Loss::Squares);
    let end = engine.descend(State::of(network), iterations, EXACT)?;
    let points = of_unknown_distance(&engine, &end, UNKNOWN[usize::from(end.converged)]);
    Ok((!end.converged || !points.is_empty()).then_some(points))
}

fn of_unknown_distance(engine: &Engine<'_>, end: &End, most: f64) -> Vec<usize> {
    let (network, layout) = (engine.network, &engine.layout);
    let sigma0 = (end.normals.cost / layout.counts.redundancy().max(1) as f64).sqrt();
    let is_unknown = |point: &usize| {
        let block = Matrix3::from_row_slice(&end.normals.point[*point]);
        let information = block.symmetric_eigenvalues().min().max(f64::MIN_POSITIVE);
        let to = |sight: usize| (end.state.points[*point] - end.state.poses[layout.sights[sight].image()].centre).norm();
        let distance = layout.of_triple(*point).map(to).fold(f64::INFINITY, f64::min);
        sigma0 / information.sqrt() > most * distance
    };
    (0..network.points.len()).filter(|&point| layout.triple_free[point] == [true; 3]).filter(is_unknown).collect()
}
