//! Numbers of each image's own, and how well they are known.

use crate::AdjustError;
use crate::solution::Solution;
use crate::solve::{Coupling, Eliminated, Inverse};

use super::covariance::Variance;

/// A number of an image's own ([`crate::PerImage`]), adjusted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OwnNumber {
    /// Index of the image.
    pub image: usize,
    /// Which number: its index in [`crate::Network::per_image`].
    pub of: usize,
    /// Its value, in its unit; zero is expected.
    pub value: f64,
    /// Its standard deviation, in its unit.
    pub sigma: f64,
    /// How much of it the image points say, from 0 (what was expected stays) to 1: its redundancy number as an observation.
    pub share: f64,
}

impl Solution<'_> {
    /// Numbers of each image's own, image by image, in the order of [`crate::Network::per_image`]; none of images without image points in use.
    ///
    /// # Errors
    /// As [`Self::covariances`].
    pub fn own_numbers(&self, variance: Variance) -> Result<Vec<OwnNumber>, AdjustError> {
        let scale = self.variance_factor(variance)?;
        let inverse = self.engine.inverse(&self.solved);
        let found = self.own_cofactors(&inverse).into_iter().map(|(image, of, value, cofactor)| {
            let share = 1.0 - cofactor / self.network().per_image[of].sigma.powi(2);
            OwnNumber { image, of, value, sigma: (scale * cofactor.max(0.0)).sqrt(), share: share.clamp(0.0, 1.0) }
        });
        Ok(found.collect())
    }

    /// Image, number, value and cofactor of each.
    pub(super) fn own_cofactors(&self, inverse: &Inverse) -> Vec<(usize, usize, f64, f64)> {
        let (engine, own) = (&self.engine, &self.end.normals.own);
        let (ordered, mut coupling) = (engine.ordered(&self.end.state, &self.end.normals), Coupling::default());
        let mut found = Vec::new();
        for (image, own) in own.iter().enumerate().filter(|(image, own)| !own.is_none() && !engine.layout.of_image[*image].is_empty()) {
            let place = engine.plan.members.binary_search(&image).ok().filter(|_| engine.plan.eliminated == Eliminated::Poses);
            let member = place.map(|place| inverse.member::<6>(&self.solved, ordered, place, &mut coupling));
            let camera = engine.layout.camera_of[image];
            let numbers = engine.network.per_image.iter().enumerate().filter(|(_, of)| of.camera == camera);
            // Any sight of the image: what is asked of it is where its unknowns stand.
            let sight = engine.layout.of_image[image].start;
            for (k, (of, _)) in numbers.enumerate() {
                let row = own.row(k);
                let rest = self.adjusted(inverse, sight, &row, member.as_ref())[(0, 0)];
                found.push((image, of, self.end.state.own[image][k], own.cofactors[(k, k)] + rest));
            }
        }
        found
    }
}
