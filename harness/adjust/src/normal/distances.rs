//! Observed distances between points.

use super::blocks::Normals;
use crate::network::{DistanceObservation, Layout, Network};
use crate::state::State;

/// A distance at some state, and its derivatives.
pub(crate) struct Stretch {
    /// How long it is, object units.
    pub(crate) length: f64,
    /// By X, Y, Z of each end; zero along what may not change.
    pub(crate) slopes: [[f64; 3]; 2],
}

impl Stretch {
    pub(crate) fn of(layout: &Layout, state: &State, distance: &DistanceObservation) -> Self {
        let [from, to] = distance.points.map(|point| state.points[point]);
        let (length, along) = ((to - from).norm(), (to - from).normalize());
        let slope = |end: usize, sign: f64| {
            let free = layout.triple_free[distance.points[end]];
            std::array::from_fn(|axis| if free[axis] { sign * along[axis] } else { 0.0 })
        };
        Self { length, slopes: [slope(0, -1.0), slope(1, 1.0)] }
    }
}

/// Adds the equations of all distances.
pub(super) fn add(network: &Network, layout: &Layout, state: &State, into: &mut Normals) {
    into.point_point.clear();
    for distance in &network.distances {
        let Stretch { length, slopes } = Stretch::of(layout, state, distance);
        let (p, w) = (1.0 / (distance.sigma * distance.sigma), distance.value - length);
        for (point, slope) in distance.points.into_iter().zip(&slopes) {
            for i in 0..3 {
                (0..3).for_each(|j| into.point[point][3 * i + j] += p * slope[i] * slope[j]);
                into.point_right[point][i] += p * w * slope[i];
            }
        }
        let [from, to] = &slopes;
        into.point_point.push(std::array::from_fn(|k| p * from[k / 3] * to[k % 3]));
        into.cost += p * w * w;
    }
}
