//! Properties of a network that make it weak.

use nalgebra::Vector3;

use crate::approximate::Shape;
use crate::defect::Reason;
use crate::network::{Layout, Sight};
use crate::state::State;

/// Extent, relative to the largest, below which points have none in a direction.
const FLAT: f64 = 1e-5;
/// Angles between axes, and rolls, below which there is no convergence or no roll: 6 and 20 degrees.
const CONVERGENCE: f64 = 0.105;
const ROLL: f64 = 0.35;

/// What holds of the images and points that take part.
pub(super) fn reasons(layout: &Layout, state: &State) -> Vec<Reason> {
    let images: Vec<usize> = (0..layout.of_image.len()).filter(|&i| !layout.of_image[i].is_empty()).collect();
    let mut measured: Vec<usize> = layout.sights.iter().map(Sight::point).collect();
    measured.sort_unstable();
    measured.dedup();
    let points = measured.iter().map(|&i| state.points[i]);
    let axes: Vec<Vector3<f64>> = images.iter().map(|&i| state.poses[i].rotation.row(2).transpose()).collect();
    let converges = axes.iter().any(|axis| axis.angle(&axes[0]) > CONVERGENCE);
    let mut reasons = Vec::new();
    let mut add = |holds: bool, reason: Reason| holds.then(|| reasons.push(reason));
    let [thin, middle] = Shape::of(points).relative();
    add(images.len() == 1, Reason::OneImage);
    add(middle < FLAT, Reason::OnALine);
    add(thin < FLAT && middle >= FLAT, Reason::NoDepth);
    add(images.len() > 1 && !converges, Reason::NoConvergence);
    add(images.len() > 1 && !rolls(state, &images), Reason::NoRoll);
    reasons
}

/// Whether an image is rolled about its axis against the first.
fn rolls(state: &State, images: &[usize]) -> bool {
    let first = &state.poses[images[0]].rotation;
    images.iter().any(|&i| {
        let turn = state.poses[i].rotation * first.transpose();
        // The part of the rotation that is about the camera's axis.
        (turn[(1, 0)] - turn[(0, 1)]).atan2(turn[(0, 0)] + turn[(1, 1)]).abs() > ROLL
    })
}
