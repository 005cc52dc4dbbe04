//! What the adjustment of splines returns.

use std::sync::OnceLock;

use calibench_model::Pose;
use calibench_model::camera::{CameraModel, Ray, Splined};

use super::SplinedNetwork;
use super::equations::{Frame, SplinedNormals, SplinedState};
use super::lengths::lengths;
use super::place::{End, minimum};
use super::prior::prior_trace;
use super::quality::{SplinedFit, SplinedQuality};
use super::reduced::{Inverse, Loose};
use crate::AdjustError;
use crate::defect::{Defect, Direction};
use crate::network::{Counts, ImageObservation, Layout};
use crate::normal::Loss;
use crate::quality::{Residual, Variance, each};
use crate::solution::Options;

/// The result of the adjustment of splines.
#[derive(Clone, Debug)]
pub struct SplinedSolution<'n> {
    frame: Frame<'n>,
    state: SplinedState,
    normals: SplinedNormals,
    iterations: usize,
    options: Options,
    inverse: OnceLock<Inverse>,
}

/// Adjusts splines from their start values: by least squares, or with Huber's weights.
///
/// # Errors
/// A network that is none, of several cameras, without fixed control, or with images that observe their pose; start values that do not picture what was measured; an image whose points do not
/// determine its pose, by name; no convergence.
pub fn adjust_splined<'n>(network: &'n SplinedNetwork, options: &Options) -> Result<SplinedSolution<'n>, AdjustError> {
    adjust_from(network, options, None)
}

fn adjust_from<'n>(
    network: &'n SplinedNetwork,
    options: &Options,
    start: Option<SplinedState>,
) -> Result<SplinedSolution<'n>, AdjustError> {
    network.check()?;
    options.check(&network.network)?;
    let layout = Layout::new(&network.network, &[], &options.left_out)?;
    let few = |(image, range): (usize, &std::ops::Range<usize>)| (network.network.images[image].name.clone(), range.len());
    let images: Vec<(String, usize)> = layout.of_image.iter().enumerate().map(few).filter(|(_, points)| *points < 3).collect();
    if !images.is_empty() {
        return Err(AdjustError::Undetermined(Box::new(Defect::Images { images })));
    }
    let frame = Frame::new(network, layout, options.huber.map_or(Loss::Squares, Loss::Huber));
    let End { state, normals, descended } = minimum(&frame, start.unwrap_or_else(|| frame.start()), options.most_iterations)?;
    let loose = |image: usize| {
        let unknowns = vec![format!("the pose of image {}", network.network.images[image].name)];
        let directions = vec![Direction { unknowns, eigenvalue: 0.0 }];
        AdjustError::Undetermined(Box::new(Defect::Directions { directions, reasons: Vec::new() }))
    };
    if !descended.converged {
        normals.eliminate(0.0).map_err(|Loose(image)| loose(image))?;
        return Err(AdjustError::NotConverged { iterations: descended.iterations, gain: descended.gain, cost: normals.cost });
    }
    Ok(SplinedSolution { frame, state, normals, iterations: descended.iterations, options: options.clone(), inverse: OnceLock::new() })
}

impl<'n> SplinedSolution<'n> {
    /// What was adjusted.
    pub const fn network(&self) -> &'n SplinedNetwork {
        self.frame.of
    }

    /// The splines.
    pub const fn camera(&self) -> &Splined {
        &self.state.camera
    }

    /// Exterior orientations.
    pub fn poses(&self) -> &[Pose] {
        &self.state.poses
    }

    /// Coefficients of each surface, object units.
    pub fn surfaces(&self) -> &[[f64; 3]] {
        &self.state.surfaces
    }

    /// Observations and unknowns. The prior counts as two observations of each control point, and each control point has two unknowns.
    pub const fn counts(&self) -> Counts {
        self.frame.counts
    }

    /// Iterations done.
    pub const fn iterations(&self) -> usize {
        self.iterations
    }

    /// Weighted sum of squared residuals, prior included, a number; under Huber's loss, its value.
    pub const fn cost(&self) -> f64 {
        self.normals.cost
    }

    /// The prior's part of [`Self::cost`], a number.
    pub const fn prior_cost(&self) -> f64 {
        self.normals.prior
    }

    /// The residuals of all observations, those that were left out as well, in the order given.
    pub fn residuals(&self) -> Vec<Residual> {
        let network = &self.frame.of.network;
        let off = |o: &ImageObservation| {
            let pixel = self.state.camera.project(self.ray_of(o)).ok()?;
            Some([pixel.x - o.position.x, pixel.y - o.position.y])
        };
        each(&network.observations, (&self.frame.layout.sights, &self.normals.residuals), off).collect()
    }

    /// The ray of an observation, by its index.
    ///
    /// # Panics
    /// There is no such observation.
    pub fn ray(&self, observation: usize) -> Ray {
        self.ray_of(&self.frame.of.network.observations[observation])
    }

    fn ray_of(&self, o: &ImageObservation) -> Ray {
        self.state.poses[o.image].ray(&self.frame.point(&self.state, o.point))
    }

    /// How well the splines are known.
    ///
    /// # Errors
    /// Without redundancy there is no estimated variance; equations that are singular.
    pub fn quality(&self, variance: Variance) -> Result<SplinedQuality, AdjustError> {
        const NONE: AdjustError = AdjustError::NotAvailable("without redundancy there is no estimated variance");
        let Inverse { cofactors, .. } = self.inverse()?;
        let counts = self.counts();
        // What the prior determines of the unknowns image points need not: the trace of its weights times the cofactors.
        let of_prior = prior_trace(self.frame.of, cofactors);
        let redundancy = counts.image_coordinates as f64 + of_prior - counts.unknowns as f64;
        let variance_factor = (redundancy > 0.0).then(|| (self.cost() - self.prior_cost()) / redundancy);
        let factor = match variance {
            Variance::Apriori => 1.0,
            Variance::Estimated => variance_factor.ok_or(NONE)?,
        };
        let rays = self.frame.layout.sights.iter().map(|sight| self.ray(sight.given as usize));
        let fit = SplinedFit { redundancy, sigma0: variance_factor.map(f64::sqrt) };
        Ok(SplinedQuality::new(&self.state.camera, (cofactors, factor), fit, rays))
    }

    /// The equations at the end, solved and inverted once for all who ask.
    fn inverse(&self) -> Result<&Inverse, AdjustError> {
        const SINGULAR: AdjustError = AdjustError::NotAvailable("the equations of the splines are singular");
        if let Some(inverse) = self.inverse.get() {
            return Ok(inverse);
        }
        let solved = self.normals.eliminate(0.0).ok().and_then(|left| left.factor(&self.normals)).ok_or(SINGULAR)?;
        let cofactors = solved.cofactors(&self.frame);
        Ok(self.inverse.get_or_init(|| Inverse { solved, cofactors }))
    }

    /// The lengths of the residuals in use by their own covariances, in a-priori standard deviations of two normal numbers, with the index of the observation; `None` where nothing checks it.
    ///
    /// # Errors
    /// Equations that are singular.
    pub fn lengths(&self) -> Result<Vec<(usize, Option<f64>)>, AdjustError> {
        let lengths = lengths(&self.frame, &self.state, self.inverse()?, &self.normals);
        Ok(self.frame.layout.sights.iter().map(|sight| sight.given as usize).zip(lengths).collect())
    }

    /// Adjusts again from here, without the observations `left_out`, by their index.
    ///
    /// # Errors
    /// As [`adjust_splined`].
    pub fn without(&self, left_out: &[usize]) -> Result<Self, AdjustError> {
        let options = Options { left_out: left_out.to_vec(), ..self.options.clone() };
        adjust_from(self.frame.of, &options, Some(self.state.clone()))
    }

    /// The same network with the end of the adjustment as its start.
    pub fn ended(&self) -> SplinedNetwork {
        let mut of = self.frame.of.clone();
        of.camera = self.state.camera.clone();
        of.network.images.iter_mut().zip(&self.state.poses).for_each(|(image, pose)| image.pose = *pose);
        of.network.surfaces.iter_mut().zip(&self.state.surfaces).for_each(|(surface, now)| surface.coefficients = *now);
        of
    }
}
