//! Splines before control that is known.
//!
//! An image point depends on its image's pose, on the core (fx, fy, cx, cy) and on the 9 or 16 control points about it. Its few derivatives are added to the normal equations of all
//! control points at once; poses are eliminated one by one, each over the columns that its image touches, and a dense matrix of core, control points and the board's bend stays.
//!
//! The frame of the camera, its core and its control points say the same thing twice: a B-spline reproduces linear functions, so that fx, fy, cx and cy are combinations of control points.
//! The prior alone tells them apart: the core is held, as a rule.

mod equations;
mod lengths;
mod place;
mod prior;
mod quality;
mod reduced;
mod solution;

#[cfg(test)]
mod tests;

use calibench_model::camera::Splined;

pub use prior::KnotPrior;
pub use quality::{SplinedFit, SplinedPlace, SplinedQuality};
pub use solution::{SplinedSolution, adjust_splined};

use crate::AdjustError;
use crate::network::{Attitude, Centre, Datum, ImageObservation, Network, NetworkError, Status};
use crate::state::before;

/// Parameters of the core: fx, fy, cx, cy.
pub(crate) const CORE: usize = 4;

/// Images of one camera of splines before control that is known.
#[derive(Clone, Debug)]
pub struct SplinedNetwork {
    /// Images, control points, image coordinates and the surface that the control lies on. Its camera stands for the images' and is not used.
    pub network: Network,
    /// The splines, start values.
    pub camera: Splined,
    /// Whether fx, fy, cx and cy are unknowns.
    pub core: [bool; CORE],
    /// What is known of the control points beforehand.
    pub prior: KnotPrior,
}

impl SplinedNetwork {
    fn check(&self) -> Result<(), AdjustError> {
        let network = &self.network;
        network.check()?;
        let not_a_number = |what| Err(NetworkError::NotANumber { of: "the splines".into(), what }.into());
        if self.camera.check().is_err()
            || !self.camera.core.iter().chain(self.camera.control.iter().flatten()).all(|value| value.is_finite())
        {
            return not_a_number("their grid, or a number of it, is none");
        }
        if !self.prior.is_positive() {
            return not_a_number("the prior of the control points is not a positive number");
        }
        let known = network.points.iter().all(|point| point.coordinates == [Status::Fixed; 3]);
        let free = network.images.iter().all(|image| image.centre == Centre::Free && image.attitude == Attitude::Free);
        let observed = |status: &Status| matches!(status, Status::Observed { .. });
        let weighted = network.surfaces.iter().any(|surface| surface.statuses.iter().any(observed));
        if !known || !free || weighted || network.cameras.len() != 1 || network.datum != Datum::Control || !network.distances.is_empty() {
            return Err(AdjustError::NotAvailable(
                "splines are adjusted of one camera, before control points that are fixed, with poses that are free",
            ));
        }
        if network.observations.iter().any(|o| o.behind) {
            return Err(AdjustError::NotAvailable("splines picture no points behind the camera"));
        }
        Ok(())
    }

    /// Image points whose rays, at the start values, lie beyond the grid of the splines, by their index, with the horizontal field of view that would reach them, degrees.
    pub fn outside(&self) -> Vec<(usize, f64)> {
        let ray = |o: &ImageObservation| before(self.network.images[o.image].pose.ray(&self.network.points[o.point].position), o.behind);
        let all = self.network.observations.iter().map(ray).enumerate();
        all.filter(|(_, ray)| self.camera.cell(*ray).is_none()).map(|(index, ray)| (index, self.camera.fov_for(ray))).collect()
    }

    /// What an observation is of, in words: its target and its image.
    ///
    /// # Panics
    /// There is no such observation.
    pub fn name_of(&self, observation: usize) -> String {
        let o = &self.network.observations[observation];
        format!("{} in {}", self.network.points[o.point].name, self.network.images[o.image].name)
    }

    /// Numbers of the splines: the core, then x and y of each control point.
    pub(crate) fn numbers(&self) -> usize {
        CORE + 2 * self.camera.control.len()
    }
}
