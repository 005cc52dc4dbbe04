//! What the adjustment of a rig returns.

use calibench_model::Pose;
use calibench_model::camera::Camera;

use super::Rig;
use super::cofactors::Cofactors;
use super::equations::{Frame, RigState};
use super::place::{End, minimum};
use super::undetermined::{singular, unconnected};
use crate::AdjustError;
use crate::network::{Counts, ImageObservation, Layout};
use crate::normal::{Loss, Normals};
use crate::quality::{Residual, each, scale_of};
use crate::solution::Options;

/// The result of the adjustment of a rig.
#[derive(Clone, Debug)]
pub struct RigSolution<'r> {
    pub(super) frame: Frame<'r>,
    pub(super) state: RigState,
    pub(super) normals: Normals,
    pub(super) cofactors: Cofactors,
    iterations: usize,
}

/// Adjusts a rig from its start values: by least squares, or with Huber's weights.
///
/// # Errors
/// A rig that is none (points that are not fixed, two images of a camera at one station), start values that do not picture what was measured, cameras that share
/// no station, unknowns that are not determined (by name), no convergence.
pub fn adjust_rig<'r>(rig: &'r Rig, options: &Options) -> Result<RigSolution<'r>, AdjustError> {
    adjust_rig_from(rig, options, None)
}

/// [`adjust_rig`] from other start values.
pub(super) fn adjust_rig_from<'r>(rig: &'r Rig, options: &Options, start: Option<RigState>) -> Result<RigSolution<'r>, AdjustError> {
    rig.check()?;
    options.check(&rig.network)?;
    let layout = Layout::new(&rig.network, &[], &options.left_out)?;
    let frame = Frame::new(rig, layout, options.huber.map_or(Loss::Squares, Loss::Huber));
    if let Some(defect) = unconnected(&frame) {
        return Err(AdjustError::Undetermined(Box::new(defect)));
    }
    let start = start.unwrap_or_else(|| frame.start());
    let End { state, normals, descended } = minimum(&frame, start, options.most_iterations)?;
    if let Some(defect) = singular(&frame, &state, &normals) {
        return Err(AdjustError::Undetermined(Box::new(defect)));
    }
    let cofactors = Cofactors::of(&normals).filter(|_| descended.converged).ok_or_else(|| AdjustError::NotConverged {
        iterations: descended.iterations,
        gain: descended.gain,
        cost: normals.cost(),
    })?;
    Ok(RigSolution { frame, state, normals: normals.images, cofactors, iterations: descended.iterations })
}

impl<'r> RigSolution<'r> {
    /// What was adjusted.
    pub const fn rig(&self) -> &'r Rig {
        self.frame.rig
    }

    /// Interior orientations.
    pub fn cameras(&self) -> &[Camera] {
        &self.state.cameras
    }

    /// Of each camera: where it sits on the rig ("camera from rig").
    pub fn mounts(&self) -> &[Pose] {
        &self.state.mounts
    }

    /// Where the rig stood ("rig from object"). A station without image points in use keeps its start value.
    pub fn stations(&self) -> &[Pose] {
        &self.state.stations
    }

    /// Exterior orientations of the images.
    pub fn poses(&self) -> Vec<Pose> {
        self.frame.whole(&self.state).poses
    }

    /// Observations and unknowns.
    pub const fn counts(&self) -> Counts {
        self.frame.counts
    }

    /// Iterations done.
    pub const fn iterations(&self) -> usize {
        self.iterations
    }

    /// Weighted sum of squared residuals, a number; under Huber's loss, its value.
    pub const fn cost(&self) -> f64 {
        self.normals.cost
    }

    /// The estimated standard deviation of unit weight, a number; `None` without redundancy.
    pub fn sigma0(&self) -> Option<f64> {
        let redundancy = self.counts().redundancy();
        (redundancy > 0).then(|| (self.cost() / redundancy as f64).sqrt())
    }

    /// The standard deviation of an image coordinate against the a-priori one from the median residual, a number; `None` without residuals.
    pub fn scale(&self) -> Option<f64> {
        let given = &self.rig().network.observations;
        let sights = self.frame.layout.sights.iter().zip(&self.normals.residuals);
        scale_of(sights.map(|(sight, residual)| sight.observed(given).precision.whitened(residual.px)))
    }

    /// The residuals of all observations, those that were left out as well, in the order given.
    pub fn residuals(&self) -> Vec<Residual> {
        let (network, state) = (&self.rig().network, self.frame.whole(&self.state));
        let off = |o: &ImageObservation| {
            let pixel = state.pixel(network, o)?;
            Some([pixel.x - o.position.x, pixel.y - o.position.y])
        };
        each(&network.observations, (&self.frame.layout.sights, &self.normals.residuals), off).collect()
    }

    /// The same rig with the end of the adjustment as its start.
    pub fn ended(&self) -> Rig {
        let mut rig = self.rig().clone();
        rig.network.cameras.iter_mut().zip(&self.state.cameras).for_each(|(interior, camera)| interior.camera = *camera);
        rig.mounts.clone_from(&self.state.mounts);
        rig.stations.iter_mut().zip(&self.state.stations).for_each(|(station, pose)| station.pose = *pose);
        rig.network.images.iter_mut().zip(self.poses()).for_each(|(image, pose)| image.pose = pose);
        rig
    }
}
