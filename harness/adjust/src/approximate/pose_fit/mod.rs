//! The pose of least squares in the image.

use calibench_model::camera::{Camera, CameraModel};
use calibench_model::{PixelPoint, Pose};
use nalgebra::{Matrix6, Point3, Rotation3, SVector, Vector3};

use super::ApproximateError;
use super::least_squares::{Normal, minimise};

mod pictures;

pub(super) use pictures::Pictures;

/// An object point of known coordinates and its picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Control {
    /// Object units.
    pub object: Point3<f64>,
    /// Its measured image coordinates.
    pub image: PixelPoint,
}

/// A pose of least squares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FittedPose {
    /// The pose, in the object's frame and units.
    pub pose: Pose,
    /// The sum of the squared residuals, px^2.
    pub squares: f64,
    /// Observations minus unknowns.
    pub redundancy: usize,
    /// Cofactors of a small rotation about the camera's own x, y and z axes (rad) and of the projection centre (object units), for 1 px. `None` where
    /// the points do not determine the pose.
    pub cofactor: Option<Matrix6<f64>>,
}

impl FittedPose {
    /// The standard deviation of an image coordinate from the residuals, px; `None` without redundancy.
    pub fn sigma0(&self) -> Option<f64> {
        (self.redundancy > 0).then(|| (self.squares / self.redundancy as f64).sqrt())
    }
}

/// The pose that minimises the residuals of all `control` in the image, from an approximate one: Gauss-Newton with damping, interior orientation fixed.
///
/// # Errors
/// [`ApproximateError::NoSolution`] when the start does not picture every point.
///
/// Source: Mikhail, Bethel & McGlone 2001, section 5.3 (collinearity).
pub fn fit_pose(camera: &Camera, start: &Pose, control: &[Control]) -> Result<FittedPose, ApproximateError> {
    fit_pictures(&Pictures::of(camera), start, control)
}

/// [`fit_pose`] with a camera that is ready.
pub(super) fn fit_pictures(camera: &Pictures<'_>, start: &Pose, control: &[Control]) -> Result<FittedPose, ApproximateError> {
    let (pose, normal) = minimise(*start, |pose| camera.normal(pose, control), moved_pose).ok_or(ApproximateError::NoSolution)?;
    Ok(FittedPose { pose, squares: normal.squares, redundancy: normal.redundancy(), cofactor: normal.cofactor() })
}

/// d(image coordinate) / d(rotation about the camera's axes, X0), from d / d(ray) at `n = M (X - X0)`.
pub(super) fn pose_row(pose: &Pose, n: &Vector3<f64>, by_ray: [f64; 3]) -> SVector<f64, 6> {
    let g = Vector3::from(by_ray);
    // dn = omega x n - M dX0.
    let (turn, shift) = (n.cross(&g), -(pose.rotation.transpose() * g));
    SVector::from([turn.x, turn.y, turn.z, shift.x, shift.y, shift.z])
}

/// The pose after a small rotation about the camera's axes and a shift of the projection centre.
pub(super) fn moved_pose(pose: &Pose, step: &SVector<f64, 6>) -> Pose {
    let turn = Rotation3::new(Vector3::new(step[0], step[1], step[2]));
    Pose { rotation: turn * pose.rotation, centre: pose.centre + Vector3::new(step[3], step[4], step[5]) }
}

/// Computed minus measured, px; `None` where the camera does not picture the point.
pub(super) fn residual(camera: &Camera, pose: &Pose, point: &Control) -> Option<[f64; 2]> {
    let found = camera.project(pose.ray(&point.object)).ok()?;
    let v = [found.x - point.image.x, found.y - point.image.y];
    v.iter().all(|v| v.is_finite()).then_some(v)
}

/// The squared length of a residual, px^2, infinite for what is not pictured.
pub(super) fn square(camera: &Camera, pose: &Pose, point: &Control) -> f64 {
    residual(camera, pose, point).map_or(f64::INFINITY, |[x, y]| x * x + y * y)
}

/// The rays of all points, tangents right and up.
pub(super) fn rays(camera: &Camera, points: impl Iterator<Item = PixelPoint>) -> Result<Vec<Vector3<f64>>, ApproximateError> {
    let ray = |(index, point): (usize, PixelPoint)| {
        let ray = camera.unproject(point).map_err(|_| ApproximateError::NotInCamera { index })?;
        let (x, y) = ray.tangent().ok_or(ApproximateError::NotInCamera { index })?;
        Ok(Vector3::new(x, y, -1.0))
    };
    points.enumerate().map(ray).collect()
}

/// The first point with a coordinate that is not a number is an error.
pub(super) fn all_finite(control: &[Control]) -> Result<(), ApproximateError> {
    let finite = |point: &Control| point.image.is_finite() && point.object.iter().all(|value| value.is_finite());
    control.iter().position(|point| !finite(point)).map_or(Ok(()), |index| Err(ApproximateError::NotFinite { index }))
}

#[cfg(test)]
mod tests;
