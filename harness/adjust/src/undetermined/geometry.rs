//! Properties of a network that make it weak.

use nalgebra::{Matrix3, Point3, SymmetricEigen, Vector3};

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
    let points: Vec<&Point3<f64>> = measured.into_iter().map(|i| &state.points[i]).collect();
    let axes: Vec<Vector3<f64>> = images.iter().map(|&i| state.poses[i].rotation.row(2).transpose()).collect();
    let converges = axes.iter().any(|axis| axis.angle(&axes[0]) > CONVERGENCE);
    let mut reasons = Vec::new();
    let mut add = |holds: bool, reason: Reason| holds.then(|| reasons.push(reason));
    let [thin, middle] = extents(&points);
    add(images.len() == 1, Reason::OneImage);
    add(middle < FLAT, Reason::OnALine);
    add(thin < FLAT && middle >= FLAT, Reason::NoDepth);
    add(images.len() > 1 && !converges, Reason::NoConvergence);
    add(images.len() > 1 && !rolls(state, &images), Reason::NoRoll);
    reasons
}

/// The smallest and the middle extent of points, relative to the largest.
fn extents(points: &[&Point3<f64>]) -> [f64; 2] {
    let middle = points.iter().map(|point| point.coords).sum::<Vector3<f64>>() / points.len().max(1) as f64;
    let spread = points.iter().map(|point| point.coords - middle).map(|d| d * d.transpose()).sum::<Matrix3<f64>>();
    let mut squares: [f64; 3] = SymmetricEigen::new(spread).eigenvalues.into();
    squares.sort_by(f64::total_cmp);
    [0, 1].map(|i| (squares[i].max(0.0) / squares[2].max(f64::MIN_POSITIVE)).sqrt())
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
