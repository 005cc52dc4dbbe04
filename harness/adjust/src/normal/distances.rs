//! Observed distances between points.

use crate::network::{DistanceObservation, Layout};
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
