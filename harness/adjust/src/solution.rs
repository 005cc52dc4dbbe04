//! What an adjustment returns.

use calibench_model::Pose;
use calibench_model::camera::Camera;
use nalgebra::Point3;

use crate::AdjustError;
use crate::datum::{free, hold, transformed};
use crate::descent::EXACT;
use crate::network::{Counts, Datum, Layout, Network, NetworkError};
use crate::normal::{Loss, Scratch};
use crate::solve::{End, Engine, Solved};
use crate::state::State;
use crate::undetermined::{counted, directions};

/// A pivot below which the normal equations are looked at more closely.
const SUSPECT: f64 = 1e-8;

/// Where images have numbers of their own all their points would be coupled with each other.
const BEFORE_CONTROL: &str = "numbers of each image's own are adjusted before control that is fixed, on one board that bends at most: not beside points or distances that are adjusted";

/// How to adjust.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Bound of Huber's robust weights, in standard deviations of an image point (its white residual is a vector); `None` for least squares.
    pub huber: Option<f64>,
    /// Iterations at most.
    pub most_iterations: usize,
    /// Observations that are left out, by their index; [`Solution::residuals`] lists them as such.
    pub left_out: Vec<usize>,
    /// Share of the sum of squares that a step must promise for another to follow, as [`crate::EXACT`] or [`crate::ROUGH`].
    pub worth: f64,
}

impl Default for Options {
    fn default() -> Self {
        Self { huber: None, most_iterations: 100, left_out: Vec::new(), worth: EXACT }
    }
}

impl Options {
    pub(crate) fn check(&self, network: &Network) -> Result<(), NetworkError> {
        let count = network.observations.len();
        if let Some(&index) = self.left_out.iter().find(|&&index| index >= count) {
            return Err(NetworkError::NoSuch { of: "left_out".into(), what: "observation", index, count });
        }
        match self.huber {
            Some(bound) if !(bound > 0.0 && bound.is_finite()) => {
                Err(NetworkError::NotANumber { of: "Huber's bound".into(), what: "it is not a positive number" })
            }
            _ => Ok(()),
        }
    }
}

/// The result of an adjustment.
#[derive(Clone, Debug)]
pub struct Solution<'n> {
    pub(crate) engine: Engine<'n>,
    pub(crate) end: End,
    pub(crate) solved: Solved,
    /// What defines the frame of the result; `engine` holds the coordinates of some minimal datum.
    pub(crate) datum: Datum,
}

/// Adjusts `network` from its start values: by least squares, or with Huber's weights.
///
/// # Errors
/// A network that is none, start values that do not picture what was measured, unknowns that are not determined (by name), no convergence.
pub fn adjust<'n>(network: &'n Network, options: &Options) -> Result<Solution<'n>, AdjustError> {
    adjust_from(network, options, State::of(network))
}

/// [`adjust`] from other start values.
pub(crate) fn adjust_from<'n>(network: &'n Network, options: &Options, start: State) -> Result<Solution<'n>, AdjustError> {
    network.check()?;
    options.check(network)?;
    let held = hold(network, &network.datum)?;
    let layout = Layout::new(network, &held, &options.left_out)?;
    if !layout.allows_own(network) {
        return Err(AdjustError::NotAvailable(BEFORE_CONTROL));
    }
    if let Some(defect) = counted(network, &layout, &held) {
        return Err(AdjustError::Undetermined(Box::new(defect)));
    }
    let engine = Engine::new(network, layout, options.huber.map_or(Loss::Squares, Loss::Huber));
    let mut end = engine.descend(start, options.most_iterations, options.worth)?;
    end.converged |= options.worth > EXACT;
    let solved = determined(&engine, &mut end)?;
    end.normals.release();
    let solution = Solution { engine, end, solved, datum: network.datum.clone() };
    if matches!(network.datum, Datum::Inner | Datum::InnerOver(_)) { solution.in_datum(&network.datum) } else { Ok(solution) }
}

/// The normal equations at the end, solved.
fn determined(engine: &Engine, end: &mut End) -> Result<Solved, AdjustError> {
    let solved = end.solved.take().or_else(|| engine.decompose((&end.state, &end.normals), 0.0));
    let redundancy = engine.layout.counts.redundancy().max(1);
    let sigma0 = (end.normals.cost / redundancy as f64).sqrt();
    // The pivots depend on the order of the unknowns; the standard deviations do not.
    let suspect = |solved: &Solved| solved.factor.smallest_pivot < SUSPECT || engine.has_senseless_distance(solved, &end.state, sigma0);
    let is_doubtful = solved.as_ref().is_none_or(suspect) || !end.converged;
    if let Some(defect) = is_doubtful.then(|| directions(engine, &end.state, &end.normals, sigma0)).flatten() {
        return Err(AdjustError::Undetermined(Box::new(defect)));
    }
    let not_converged = || {
        let (iterations, gain, cost) = (end.iterations, end.gain, end.normals.cost);
        AdjustError::NotConverged { iterations, gain, cost }
    };
    solved.filter(|_| end.converged).ok_or_else(not_converged)
}

impl<'n> Solution<'n> {
    /// What was adjusted.
    pub fn network(&self) -> &'n Network {
        self.engine.network
    }

    /// Interior orientations.
    pub fn cameras(&self) -> &[Camera] {
        &self.end.state.cameras
    }

    /// Exterior orientations.
    pub fn poses(&self) -> &[Pose] {
        &self.end.state.poses
    }

    /// Object points, object units, in the order of the network's.
    pub fn points(&self) -> &[Point3<f64>] {
        &self.end.state.points[..self.network().points.len()]
    }

    /// Coefficients of each surface, object units, in the order of the network's.
    pub fn surfaces(&self) -> impl ExactSizeIterator<Item = [f64; 3]> + '_ {
        self.end.state.points[self.network().points.len()..].iter().map(|coefficients| coefficients.coords.into())
    }

    /// What defines the frame of the object.
    pub fn datum(&self) -> &Datum {
        &self.datum
    }

    /// Observations and unknowns.
    pub fn counts(&self) -> Counts {
        self.engine.layout.counts
    }

    /// Iterations done.
    pub fn iterations(&self) -> usize {
        self.end.iterations
    }

    /// Weighted sum of squared residuals, `v^T P v` with an a-priori variance factor of 1, of all observations in use, a number; under Huber's loss,
    /// its value.
    pub fn cost(&self) -> f64 {
        self.end.normals.cost
    }

    /// The estimated standard deviation of unit weight, `sqrt(v^T P v / redundancy)`, a number: 1 if those given are right; `None` without
    /// redundancy.
    pub fn sigma0(&self) -> Option<f64> {
        let redundancy = self.counts().redundancy();
        (redundancy > 0).then(|| (self.cost() / redundancy as f64).sqrt())
    }

    /// The same result in another datum: an S-transformation. Interior orientation, distances' ratios and residuals stay; coordinates, poses and their
    /// covariances change.
    ///
    /// # Errors
    /// [`NetworkError::Datum`] if more than a minimal datum fixes the frame, or the new one does not suffice.
    ///
    /// Source: Baarda 1973; van Mierlo 1980.
    pub fn in_datum(&self, datum: &Datum) -> Result<Self, AdjustError> {
        let refuse = |why: &str| AdjustError::from(NetworkError::Datum(why.into()));
        let is_minimal = self.counts().constraints == free(self.engine.network);
        if !is_minimal || *datum == Datum::Control {
            return Err(refuse("only a minimal datum can be exchanged, for another minimal one"));
        }
        let network = self.engine.network;
        let state = transformed(network, datum, &self.end.state).ok_or_else(|| refuse("the new datum does not fix the frame"))?;
        let mut end = End { state, ..self.end.clone() };
        let lost = |_| refuse("the transformed network does not picture its points");
        self.engine.linearise(&end.state, &mut Scratch::default(), &mut end.normals).map_err(lost)?;
        let solved = self.engine.decompose((&end.state, &end.normals), 0.0).ok_or_else(|| refuse("the coordinates held do not suffice"))?;
        end.normals.release();
        Ok(Self { engine: self.engine.clone(), end, solved, datum: datum.clone() })
    }
}
