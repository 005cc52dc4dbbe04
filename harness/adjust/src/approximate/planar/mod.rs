//! Poses before a plane: its picture fits two.

use calibench_model::Pose;
use calibench_model::camera::Camera;
use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};

use super::ApproximateError;
use super::error::at_least;
use super::homography::normalised;
use super::pose_fit::{Control, FittedPose, all_finite, fit_pose, rays};
use super::shape::Shape;

/// Height above the plane, as a share of the extent, of what counts as in the plane.
const IN_PLANE: f64 = 1e-4;
/// Rotations that differ by less are one, as the norm of the difference.
const SAME: f64 = 1e-6;

/// The poses of a camera before coplanar control points, best first: one or two, each a minimum of the residuals in the image.
///
/// The picture of a plane that is small or far away fits two poses, mirrored about the line of sight, almost equally well; compare their `squares`.
///
/// # Errors
/// As [`super::homography`]; [`ApproximateError::NotCoplanar`], [`ApproximateError::NotInCamera`], [`ApproximateError::NoSolution`].
///
/// Source: Collins & Bartoli 2014, Infinitesimal plane-based pose estimation, from the homography at the points' centroid; then [`fit_pose`].
pub fn planar_poses(camera: &Camera, control: &[Control]) -> Result<Vec<FittedPose>, ApproximateError> {
    let starts = planar_starts(camera, control)?;
    let mut fitted: Vec<_> = starts.iter().filter_map(|start| fit_pose(camera, start, control).ok()).collect();
    fitted.sort_by(|a, b| a.squares.total_cmp(&b.squares));
    fitted.dedup_by(|b, a| (a.pose.rotation - b.pose.rotation).norm() < SAME);
    if fitted.is_empty() { Err(ApproximateError::NoSolution) } else { Ok(fitted) }
}

/// As [`planar_poses`], in closed form and not refined: both poses, the better (by the tangents of its rays) first; they are one where the plane is
/// seen straight on.
///
/// # Errors
/// As [`planar_poses`].
pub fn planar_starts(camera: &Camera, control: &[Control]) -> Result<[Pose; 2], ApproximateError> {
    at_least(4, control.len(), "points", "a pose before a plane")?;
    all_finite(control)?;
    let shape = Shape::of(control.iter().map(|point| point.object));
    if shape.is_line() {
        return Err(ApproximateError::Collinear);
    }
    if shape.extents[2] > IN_PLANE * shape.extents[0] {
        return Err(ApproximateError::NotCoplanar);
    }
    flattened_starts(camera, control, &shape)
}

/// The two poses before the plane of the longest axes of points that are nearly coplanar, the better first.
pub(super) fn flattened_starts(camera: &Camera, control: &[Control], shape: &Shape) -> Result<[Pose; 2], ApproximateError> {
    let rays = rays(camera, control.iter().map(|point| point.image))?;
    // Tangents right and down, the plane's own coordinates: the camera of computer vision, that looks along +z.
    let pairs: Vec<_> = control.iter().zip(&rays).map(|(point, ray)| (shape.in_plane(&point.object), [ray.x, -ray.y])).collect();
    let (matrix, from, to) = normalised(&pairs)?;
    let homography = to.inverse() * matrix * from.matrix();
    let starts = infinitesimal(&(homography / homography[(2, 2)])).ok_or(ApproximateError::NoSolution)?;
    let origin = homography.column(2) / homography[(2, 2)];
    let squares = |(rotation, depth): &(Matrix3<f64>, f64)| {
        let square = |&([x, y], [u, v]): &([f64; 2], [f64; 2])| {
            let p = rotation.column(0) * x + rotation.column(1) * y + origin * *depth;
            if p.z > 0.0 { (p.x / p.z - u).powi(2) + (p.y / p.z - v).powi(2) } else { f64::INFINITY }
        };
        pairs.iter().map(square).sum::<f64>()
    };
    let [first, second] = if squares(&starts[0]) <= squares(&starts[1]) { starts } else { [starts[1], starts[0]] };
    Ok([first, second].map(|(rotation, depth)| in_object(shape, &(origin * depth), &rotation)))
}

/// The rotations and the depth of the plane's origin, from a homography whose last element is one.
///
/// Source: Collins & Bartoli 2014, section 3.2.
fn infinitesimal(h: &Matrix3<f64>) -> Option<[(Matrix3<f64>, f64); 2]> {
    let at = Vector2::new(h[(0, 2)], h[(1, 2)]);
    let jacobian = Matrix2::from_fn(|i, j| h[(i, j)] - h[(2, j)] * at[i]);
    let sight = towards(&at);
    let project = Matrix2::from_fn(|i, j| sight[(i, j)] - at[i] * sight[(2, j)]);
    let a = project.try_inverse()? * jacobian;
    let scale = a.singular_values().max();
    if scale.is_nan() || scale <= 0.0 {
        return None;
    }
    let r = a / scale;
    let rest = |j: usize| (1.0 - r.column(j).norm_squared()).max(0.0).sqrt();
    let product = -r.column(0).dot(&r.column(1));
    let third = [rest(0), rest(1) * if product < 0.0 { -1.0 } else { 1.0 }];
    let rotation = |sign: f64| {
        let column = |j: usize| Vector3::new(r[(0, j)], r[(1, j)], sign * third[j]);
        let (x, y) = (column(0), column(1));
        sight * orthogonal(&Matrix3::from_columns(&[x, y, x.cross(&y)]))
    };
    Some([(rotation(1.0), 1.0 / scale), (rotation(-1.0), 1.0 / scale)])
}

/// The rotation that turns the z axis to (x, y, 1).
fn towards(at: &Vector2<f64>) -> Matrix3<f64> {
    let z = Vector3::new(at.x, at.y, 1.0).normalize();
    // About the axis across both; 1 + z.z is above one, as the plane's origin lies before the camera.
    let (x, y, n) = (z.x, z.y, 1.0 / (1.0 + z.z));
    Matrix3::new(1.0 - x * x * n, -x * y * n, x, -x * y * n, 1.0 - y * y * n, y, -x, -y, z.z)
}

/// The nearest rotation.
pub(super) fn orthogonal(m: &Matrix3<f64>) -> Matrix3<f64> {
    let svd = m.svd(true, true);
    let (Some(u), Some(v)) = (svd.u, svd.v_t) else { return Matrix3::identity() };
    u * Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, (u * v).determinant().signum())) * v
}

/// The pose from a rotation of the plane's axes into those of computer vision (y down, z forward), and the place of the plane's origin in these.
fn in_object(shape: &Shape, origin: &Vector3<f64>, rotation: &Matrix3<f64>) -> Pose {
    let turn = Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, -1.0));
    let rotation = turn * rotation * shape.axes.transpose();
    Pose { rotation, centre: shape.centroid - rotation.transpose() * (turn * origin) }
}

#[cfg(test)]
mod tests;
