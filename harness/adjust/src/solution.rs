//! What an adjustment returns.

use calibench_model::Pose;
use calibench_model::camera::Camera;
use nalgebra::Point3;

use crate::counts::Counts;
use crate::network::{Layout, Network};
use crate::normal::Loss;
use crate::solve::{End, Engine};
use crate::state::State;
use crate::AdjustError;

/// How to adjust.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Bound of Huber's robust weights, in standard deviations of an image point; `None` for least squares.
    pub huber: Option<f64>,
    /// Iterations at most.
    pub most_iterations: usize,
    /// Observations that are left out, by their index; they are counted and listed as such.
    pub left_out: Vec<usize>,
}

impl Default for Options {
    fn default() -> Self {
        Self { huber: None, most_iterations: 100, left_out: Vec::new() }
    }
}

/// The result of an adjustment.
#[derive(Clone, Debug)]
pub struct Solution<'n> {
    engine: Engine<'n>,
    end: End,
}

/// Adjusts `network` by least squares.
///
/// # Errors
/// A network that is none, start values that do not picture what was measured, unknowns that are not determined, no convergence.
pub fn adjust<'n>(network: &'n Network, options: &Options) -> Result<Solution<'n>, AdjustError> {
    network.check()?;
    let layout = Layout::new(network, &[])?;
    let engine = Engine::new(network, layout, options.huber.map_or(Loss::Squares, Loss::Huber));
    let end = engine.descend(State::of(network), options.most_iterations)?;
    if !end.converged {
        let (iterations, gain, cost) = (end.iterations, end.gain, end.normals.cost);
        return Err(AdjustError::NotConverged { iterations, gain, cost });
    }
    Ok(Solution { engine, end })
}

impl Solution<'_> {
    /// Interior orientations.
    pub fn cameras(&self) -> &[Camera] {
        &self.end.state.cameras
    }

    /// Exterior orientations.
    pub fn poses(&self) -> &[Pose] {
        &self.end.state.poses
    }

    /// Object points.
    pub fn points(&self) -> &[Point3<f64>] {
        &self.end.state.points
    }

    /// Observations and unknowns.
    pub fn counts(&self) -> Counts {
        self.engine.layout.counts
    }

    /// Iterations done.
    pub fn iterations(&self) -> usize {
        self.end.iterations
    }

    /// Weighted sum of squared residuals, `v^T P v` with an a-priori variance factor of 1; under Huber's loss, its value.
    pub fn cost(&self) -> f64 {
        self.end.normals.cost
    }

    /// The estimated standard deviation of unit weight, `sqrt(v^T P v / redundancy)`; `None` without redundancy.
    pub fn sigma0(&self) -> Option<f64> {
        let redundancy = self.counts().redundancy();
        (redundancy > 0).then(|| (self.cost() / redundancy as f64).sqrt())
    }
}
