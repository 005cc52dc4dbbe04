//! What the uncertainty of a calibration means in the image, its poses being held by what was measured.

use calibench_model::Covariance;
use calibench_model::PixelPoint;
use calibench_model::camera::{CameraModel, DerivativeBuffer, Ray};
use nalgebra::{DMatrix, Matrix2xX, Matrix6};

use super::covariance::Variance;
use super::frame_uncertainty::{Distance, Uncertainty, at_depth, by_turn};
use crate::AdjustError;
use crate::datum::STransformation;
use crate::solution::Solution;
use crate::state::Step;

/// How the errors of all poses of a camera make one of its frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Held {
    /// By every image point that was measured: the motion of the camera that best keeps them where they are, weighted as they are.
    ///
    /// Source: mrcal's method `cross-reprojection-rrp-Jfp` (Kogan 2024), to first order.
    #[default]
    ByPoints,
    /// By every image alike: the mean. An image with few points counts as much as any other.
    ///
    /// Source: mrcal's method `mean-pcam` (Kogan 2022).
    ByImages,
}

impl Solution<'_> {
    /// The uncertainty of projected points of `camera` at some places of its frame; places without a ray are left out.
    ///
    /// An object point stays where it is while camera and poses err together, as their joint covariance says. Where no image point was measured nothing holds the camera, and it shows: no pose makes up for it there. (`frame_uncertainty`
    /// lets a pose make up for the camera evenly over the frame, for a camera without its network.)
    ///
    /// # Errors
    /// [`AdjustError::NotAvailable`] if the variance is to be estimated without redundancy, for a distance that is not positive, or a camera without
    /// images.
    pub fn projection_uncertainty(
        &self,
        camera: usize,
        variance: Variance,
        places: &[PixelPoint],
        (distance, held): (Distance, Held),
    ) -> Result<Vec<Uncertainty>, AdjustError> {
        let depth = match distance {
            Distance::Far => None,
            Distance::Near(depth) if depth > 0.0 && depth.is_finite() => Some(depth),
            Distance::Near(_) => return Err(AdjustError::NotAvailable("a distance must be positive")),
        };
        let covariance = self.with_pose(camera, held)? * self.variance_factor(variance)?;
        let (model, free) = (&self.cameras()[camera], &self.engine.layout.cameras[camera].free);
        let mut buffer = DerivativeBuffer::default();
        let of = |at: &PixelPoint| {
            let ray = at_depth(model.unproject(*at).ok()?, depth);
            model.derivatives_into(ray, &mut buffer).ok()?;
            let slope = slope(&buffer, ray, free, depth.is_some());
            let q = &slope * &covariance * slope.transpose();
            Some(Uncertainty { at: *at, covariance: Covariance { sxx: q[(0, 0)], sxy: q[(0, 1)], syy: q[(1, 1)] } })
        };
        Ok(places.iter().filter_map(of).collect())
    }

    /// Cofactors of a camera's unknown parameters, then of a small rotation about its axes and a shift along them that stand for those of all its
    /// images.
    fn with_pose(&self, camera: usize, held: Held) -> Result<DMatrix<f64>, AdjustError> {
        let (engine, state) = (&self.engine, &self.end.state);
        let (layout, place) = (&engine.layout, &engine.layout.cameras[camera]);
        let images: Vec<usize> =
            (0..layout.of_image.len()).filter(|&image| layout.camera_of[image] == camera && !layout.of_image[image].is_empty()).collect();
        if images.is_empty() {
            return Err(AdjustError::NotAvailable("a camera without images"));
        }
        let zero = engine.zero_step();
        let parameter = |i: usize| {
            let mut right = zero.clone();
            right.cameras[place.offset + i] = 1.0;
            right
        };
        let shares = self.shares(&images, held)?;
        let motion = |k: usize| {
            let mut right = zero.clone();
            images.iter().zip(&shares).for_each(|(&image, share)| right.poses[image] = share.row(k).transpose().into());
            engine.mask(&mut right);
            right
        };
        let mut rights: Vec<Step> = (0..place.free.len()).map(parameter).chain((0..6).map(motion)).collect();
        if self.is_transformed() {
            let refused = AdjustError::NotAvailable("the datum does not fix the frame");
            let s = STransformation::to(engine.network, &self.datum, state, &zero).ok_or(refused)?;
            let parts = images.iter().zip(&shares).map(|(&image, share)| share * s.of_pose(state, image));
            let back = parts.fold(nalgebra::Matrix6xX::zeros(s.constraints.len()), |sum, part| sum + part);
            for (k, right) in rights[place.free.len()..].iter_mut().enumerate() {
                for (j, constraint) in s.constraints.iter().enumerate() {
                    let values = right.points.iter_mut().flatten().zip(constraint.points.iter().flatten());
                    values.for_each(|(value, part)| *value -= back[(k, j)] * part);
                }
                engine.mask(right);
            }
        }
        let answers: Vec<Step> = rights.iter().map(|right| engine.answer(&self.solved, &self.end, right)).collect();
        Ok(DMatrix::from_fn(rights.len(), rights.len(), |i, j| dot(&rights[i], &answers[j])))
    }

    /// What part of the error of each image's pose the whole takes: they sum to one.
    fn shares(&self, images: &[usize], held: Held) -> Result<Vec<Matrix6<f64>>, AdjustError> {
        let weight = |&image: &usize| match held {
            Held::ByPoints => Matrix6::from_row_slice(&self.end.normals.pose[image]),
            Held::ByImages => Matrix6::identity(),
        };
        let all: Matrix6<f64> = images.iter().map(weight).sum();
        let root = Matrix6::from_diagonal(&all.diagonal().map(|value| 1.0 / value.sqrt()));
        let inverse = (root * all * root).cholesky().ok_or(AdjustError::NotAvailable("its image points do not hold its pose"))?.inverse();
        Ok(images.iter().map(|image| root * inverse * root * weight(image)).collect())
    }
}

fn dot(a: &Step, b: &Step) -> f64 {
    let sum = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    sum(&a.cameras, &b.cameras)
        + sum(a.poses.as_flattened(), b.poses.as_flattened())
        + sum(a.points.as_flattened(), b.points.as_flattened())
}

/// Derivatives of a pixel by the unknown parameters, by a rotation of the camera and by a shift, which at infinity does nothing.
fn slope(buffer: &DerivativeBuffer, ray: Ray, free: &[usize], near: bool) -> Matrix2xX<f64> {
    let by = |axis: usize, column: usize| {
        if let Some(&parameter) = free.get(column) {
            return buffer.by_parameters()[parameter][axis];
        }
        let shift = if near { buffer.by_ray[axis] } else { [0.0; 3] };
        by_turn(buffer.by_ray[axis], ray).into_iter().chain(shift).nth(column - free.len()).unwrap_or(0.0)
    };
    Matrix2xX::from_fn(free.len() + 6, by)
}
