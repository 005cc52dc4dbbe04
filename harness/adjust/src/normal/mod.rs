//! Normal equations by blocks: cameras, exterior orientations, object points, and what couples them.

mod blocks;
mod gram;
mod image_equations;
mod observed_unknowns;
mod projection;
mod robust;

#[cfg(test)]
mod tests;

pub(crate) use blocks::{Normals, Rows, Scratch, linearise, residuals};
pub(crate) use image_equations::Lost;
pub(crate) use robust::Loss;

/// A change of all unknowns.
#[derive(Clone, Debug, Default)]
pub(crate) struct Step {
    /// Unknown parameters of all cameras, one after the other.
    pub(crate) cameras: Vec<f64>,
    /// Of each image: small rotation about the camera's axes, shift along them (`N + d x N + s`).
    pub(crate) poses: Vec<[f64; 6]>,
    /// Of each triple: X, Y, Z of a point, or the coefficients of a surface.
    pub(crate) points: Vec<[f64; 3]>,
}

impl Step {
    pub(crate) fn zero(cameras: usize, images: usize, points: usize) -> Self {
        Self { cameras: vec![0.0; cameras], poses: vec![[0.0; 6]; images], points: vec![[0.0; 3]; points] }
    }

    pub(crate) fn is_finite(&self) -> bool {
        self.cameras.iter().all(|x| x.is_finite())
            && self.poses.iter().flatten().all(|x| x.is_finite())
            && self.points.iter().flatten().all(|x| x.is_finite())
    }
}
