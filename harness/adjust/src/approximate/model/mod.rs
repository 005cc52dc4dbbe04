//! The model that two relatively oriented pictures make: object points in units of the base, with the covariance that the orientation's own adds.

use calibench_model::camera::{Camera, CameraModel};
use calibench_model::{PixelPoint, Pose};
use nalgebra::{Matrix3, Point3, SMatrix, SVector, Vector3};

use super::intersection::{Sight, intersect};
use super::{ApproximateError, RelativeOrientation};

/// A point of the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModelPoint {
    /// In the first camera's axes, base lengths.
    pub position: Point3<f64>,
    /// Its cofactors in the adjustment of the pair, orientation and points together, with the base as the unit: base lengths squared for 1 px.
    pub cofactor: Matrix3<f64>,
    /// The angle between its two rays, rad.
    pub angle: f64,
}

impl RelativeOrientation {
    /// The point whose pictures are nearest to `pixels`, one of the pairs that were oriented: that of least squares in both images.
    ///
    /// Orientation and points in one adjustment have the same minimum as the coplanarity of rays, because every point is free; so this is the point of
    /// that adjustment, and its cofactor that of the whole: `N_pp^-1 + N_pp^-1 N_po Q_oo N_op N_pp^-1`. `least_angle` in rad.
    ///
    /// # Errors
    /// [`ApproximateError::Parallel`] for a point at infinity, [`ApproximateError::Behind`], [`ApproximateError::NotInCamera`].
    ///
    /// Source: Mikhail, Bethel & McGlone 2001, chapter 5.
    pub fn model_point(&self, cameras: [&Camera; 2], pixels: [PixelPoint; 2], least_angle: f64) -> Result<ModelPoint, ApproximateError> {
        let poses = [Pose { rotation: Matrix3::identity(), centre: Point3::origin() }, self.pose];
        let sight = |i: usize| Sight { camera: cameras[i], pose: &poses[i], image: pixels[i] };
        let found = intersect(&[sight(0), sight(1)], least_angle, None)?;
        let by_ray = cameras[1].derivatives(self.pose.ray(&found.point)).map_err(|_| ApproximateError::Behind { index: 1 })?.by_ray;
        let coupling = by_ray.into_iter().map(|row| self.coupling(&found.point, Vector3::from(row))).sum::<SMatrix<f64, 3, 5>>();
        let carried = found.cofactor * coupling;
        let cofactor = found.cofactor + carried * self.cofactor * carried.transpose();
        Ok(ModelPoint { position: found.point, cofactor, angle: found.angle })
    }

    /// `N_po` of one image coordinate of the second picture, `gradient` its derivatives by the ray.
    fn coupling(&self, point: &Point3<f64>, gradient: Vector3<f64>) -> SMatrix<f64, 3, 5> {
        let ray = self.pose.rotation * (point - self.pose.centre);
        let by_point = self.pose.rotation.transpose() * gradient;
        let (turn, [a, b]) = (ray.cross(&gradient), self.base_axes.map(|axis| -axis.dot(&by_point)));
        by_point * SVector::from([turn.x, turn.y, turn.z, a, b]).transpose()
    }

    /// Cofactors of the second camera's pose: X0, Y0, Z0 in base lengths (of rank two: the base has length one), then a small rotation about the second
    /// camera's axes, rad; for 1 px.
    pub fn pose_cofactor(&self) -> SMatrix<f64, 6, 6> {
        let mut by = SMatrix::<f64, 6, 5>::zeros();
        (0..3).for_each(|i| by[(3 + i, i)] = 1.0);
        for (k, axis) in self.base_axes.iter().enumerate() {
            by.fixed_view_mut::<3, 1>(0, 3 + k).copy_from(axis);
        }
        by * self.cofactor * by.transpose()
    }
}

#[cfg(test)]
mod tests;
