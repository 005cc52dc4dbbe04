//! From one minimal datum to another.

use nalgebra::{DMatrix, DVector};

use super::held_coordinates::constraints;
use super::similarity::{Similarity, free};
use crate::network::{Datum, Network};
use crate::state::State;
use crate::state::Step;

const MOST_STEPS: usize = 100;

/// `state`, moved by the similarity that makes it obey `datum`: held coordinates take their start values; under inner constraints the points come as
/// close to their start values as a similarity can bring them. `None` if the datum does not fix the frame.
pub(crate) fn transformed(network: &Network, datum: &Datum, state: &State) -> Option<State> {
    let mut state = state.clone();
    for _ in 0..MOST_STEPS {
        let similarity = Similarity::about(state.points.iter());
        let forms = constraints(network, datum, &similarity, &state.points);
        let right = DVector::from_iterator(
            forms.len(),
            forms.iter().map(|form| {
                form.iter().map(|&(point, axis, factor)| factor * (network.points[point].position[axis] - state.points[point][axis])).sum()
            }),
        );
        let amounts = slope(network, &forms, &similarity, &state).lu().solve(&right)?;
        let motion = similarity.with(amounts.as_slice());
        state.points.iter_mut().for_each(|point| *point = motion.point(point));
        state.poses.iter_mut().for_each(|pose| *pose = motion.pose(pose));
        let size = state.points.iter().map(|point| point.coords.amax()).fold(0.0, f64::max);
        if !amounts.iter().all(|amount| amount.is_finite()) {
            return None;
        }
        if amounts.amax() <= 1e-14 * size {
            return Some(state);
        }
    }
    None
}

/// d(constraint) / d(generator).
fn slope(network: &Network, forms: &[Vec<(usize, usize, f64)>], similarity: &Similarity, state: &State) -> DMatrix<f64> {
    let mut slope = DMatrix::zeros(forms.len(), free(network));
    for (row, form) in forms.iter().enumerate() {
        for &(point, axis, factor) in form {
            let changes = similarity.of_point(&state.points[point]);
            (0..slope.ncols()).for_each(|k| slope[(row, k)] += factor * changes[k][axis]);
        }
    }
    slope
}

/// What an S-transformation does to covariances: `S = 1 - G (B^T G)^-1 B^T`, with the generators `G` and the constraints `B`.
pub(crate) struct STransformation {
    similarity: Similarity,
    /// Right sides `B`, one for each constraint.
    pub(crate) constraints: Vec<Step>,
    /// `(B^T G)^-1`.
    back: DMatrix<f64>,
}

impl STransformation {
    /// `None` if the datum does not fix the frame.
    pub(crate) fn to(network: &Network, datum: &Datum, state: &State, zero: &Step) -> Option<Self> {
        let similarity = Similarity::about(state.points.iter());
        let forms = constraints(network, datum, &similarity, &state.points);
        let back = slope(network, &forms, &similarity, state).try_inverse()?;
        let step = |form: &Vec<(usize, usize, f64)>| {
            let mut step = zero.clone();
            form.iter().for_each(|&(point, axis, factor)| step.points[point][axis] += factor);
            step
        };
        Some(Self { similarity, constraints: forms.iter().map(step).collect(), back })
    }

    /// `G (B^T G)^-1` at a point: 3 x 7, or 3 x 6 where distances give the scale.
    pub(crate) fn of_point(&self, state: &State, point: usize) -> DMatrix<f64> {
        let changes = self.similarity.of_point(&state.points[point]);
        DMatrix::from_fn(3, self.back.nrows(), |i, k| changes[k][i]) * &self.back
    }

    /// `G (B^T G)^-1` at a pose: 6 x 7, or 6 x 6.
    pub(crate) fn of_pose(&self, state: &State, image: usize) -> DMatrix<f64> {
        let changes = self.similarity.of_pose(&state.poses[image]);
        DMatrix::from_fn(6, self.back.nrows(), |i, k| changes[k][i]) * &self.back
    }
}
