//! The pose from rays: of a camera of which nothing is known but where its pixels look.

use calibench_model::Pose;
use calibench_model::camera::Ray;
use nalgebra::{Matrix3, Point3, Vector3};

use super::ApproximateError;
use super::error::at_least;
use super::least_squares::{Normal, minimise};
use super::p3p::p3p;
use super::pose_fit::{FittedPose, moved_pose, pose_row};

/// Points that a resection needs at least: three leave several poses.
const NEEDED: usize = 4;
/// Triples of points from which poses are tried.
const TRIPLES: usize = 12;

/// An object point and the ray on which it was seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayControl {
    /// Object units.
    pub object: Point3<f64>,
    /// Where the pixel looks, of length 1.
    direction: Vector3<f64>,
    /// d(image coordinate, px) / d(direction), across the direction: of x and of y.
    by_direction: [Vector3<f64>; 2],
}

impl RayControl {
    /// Of an object point that was seen where the camera looks along `at`; `right` and `down` are the rays of the places one pixel from there along the row and
    /// down. `None` where these lie on one line.
    pub fn new(object: Point3<f64>, at: Ray, [right, down]: [Ray; 2]) -> Option<Self> {
        let unit = |ray: Ray| Vector3::new(ray.x, ray.y, ray.z).try_normalize(0.0);
        let (direction, right, down) = (unit(at)?, unit(right)?, unit(down)?);
        let across = |other: Vector3<f64>| {
            let change = other - direction;
            change - direction * direction.dot(&change)
        };
        // Rows dual to the columns of [d/dx, d/dy, direction].
        let dual = Matrix3::from_columns(&[across(right), across(down), direction]).try_inverse()?;
        let by_direction = [0, 1].map(|row| dual.row(row).transpose());
        by_direction.iter().all(|row| row.iter().all(|value| value.is_finite())).then_some(Self { object, direction, by_direction })
    }

    /// Computed minus measured, px, as far as the rays of neighbouring pixels carry on; `None` where the pose has the point in the projection centre or behind
    /// the direction.
    pub fn residual(&self, pose: &Pose) -> Option<[f64; 2]> {
        let direction = pose.camera_from_world(&self.object).try_normalize(0.0)?;
        (direction.dot(&self.direction) > 0.0).then(|| self.by_direction.map(|row| row.dot(&(direction - self.direction))))
    }
}

/// The pose that minimises the residuals of all `control` in the image, from an approximate one, as [`super::fit_pose()`] does.
///
/// # Errors
/// [`ApproximateError::NoSolution`] when the start has a point behind its ray.
pub fn fit_pose_to_rays(start: &Pose, control: &[RayControl]) -> Result<FittedPose, ApproximateError> {
    let (pose, normal) = minimise(*start, |pose| normal(pose, control), moved_pose).ok_or(ApproximateError::NoSolution)?;
    Ok(FittedPose { pose, squares: normal.squares, redundancy: normal.redundancy(), cofactor: normal.cofactor() })
}

/// The pose from four rays or more, of which all count: the best of the poses of point triples, then least squares in the image.
///
/// # Errors
/// [`ApproximateError::TooFew`] below four, [`ApproximateError::NoSolution`] where no triple has a pose that suits the rest.
pub fn resect_by_rays(control: &[RayControl]) -> Result<FittedPose, ApproximateError> {
    at_least(NEEDED, control.len(), "points", "a resection")?;
    let first = (0..control.len()).step_by(control.len().div_ceil(TRIPLES));
    let triples = first.filter_map(|first| widest(&control[first], control));
    let poses = triples.flat_map(|triple| p3p(&triple.map(|point| point.direction), &triple.map(|point| point.object)));
    let fits = poses.filter_map(|pose| fit_pose_to_rays(&pose, control).ok());
    fits.min_by(|a, b| a.squares.total_cmp(&b.squares)).ok_or(ApproximateError::NoSolution)
}

/// `first`, the point farthest from it, and the one that spans the largest triangle with both: points of a grid in their order often lie on one line.
fn widest(first: &RayControl, control: &[RayControl]) -> Option<[RayControl; 3]> {
    let away = |point: &RayControl| point.object - first.object;
    let farthest = control.iter().max_by(|a, b| away(a).norm().total_cmp(&away(b).norm()))?;
    let area = |point: &RayControl| away(farthest).cross(&away(point)).norm();
    let third = control.iter().max_by(|a, b| area(a).total_cmp(&area(b)))?;
    Some([*first, *farthest, *third])
}

fn normal(pose: &Pose, control: &[RayControl]) -> Option<Normal<6>> {
    let mut normal = Normal::new();
    for point in control {
        let misclosure = point.residual(pose)?;
        let n = pose.camera_from_world(&point.object);
        let (length, direction) = (n.norm(), n.normalize());
        for (row, misclosure) in point.by_direction.into_iter().zip(misclosure) {
            let by_ray = (row - direction * direction.dot(&row)) / length;
            normal.add(&pose_row(pose, &n, by_ray.into()), misclosure);
        }
    }
    Some(normal)
}

#[cfg(test)]
mod tests {
    use calibench_model::PixelPoint;
    use calibench_model::camera::{Camera, CameraModel, ImageSize, OpenCvFisheye};
    use nalgebra::SVector;

    use super::*;
    use crate::approximate::pose_fit::{Control, fit_pose};
    use crate::approximate::tests::{Chance, apart, lens, see};

    fn seen(camera: &Camera, control: &Control) -> RayControl {
        let ray = |dx: f64, dy: f64| camera.unproject(PixelPoint::new(control.image.x + dx, control.image.y + dy)).unwrap();
        RayControl::new(control.object, ray(0.0, 0.0), [ray(1.0, 0.0), ray(0.0, 1.0)]).unwrap()
    }

    #[test]
    fn rows_are_differences() {
        let mut chance = Chance::new(5);
        let (camera, pose, points) = (lens(), chance.pose(), chance.points(4));
        let control: Vec<RayControl> = chance.control(&camera, &pose, &points, 3.0).iter().map(|point| seen(&camera, point)).collect();
        for point in &control {
            let n = pose.camera_from_world(&point.object);
            let direction = n.normalize();
            let rows = point.by_direction.map(|row| pose_row(&pose, &n, ((row - direction * direction.dot(&row)) / n.norm()).into()));
            for k in 0..6 {
                let at = |h: f64| point.residual(&moved_pose(&pose, &SVector::<f64, 6>::ith(k, h))).unwrap();
                let (high, low) = (at(1e-5), at(-1e-5));
                for (axis, row) in rows.iter().enumerate() {
                    let difference = (high[axis] - low[axis]) / 2e-5;
                    assert!((row[k] - difference).abs() < 1e-5 * row.amax().max(1.0), "{k}: {} {difference}", row[k]);
                }
            }
        }
    }

    /// A residual is that of the image: to the second order in a pixel.
    #[test]
    fn residuals_are_those_of_the_image() {
        let mut chance = Chance::new(6);
        for _ in 0..50 {
            let (camera, pose, points) = (lens(), chance.pose(), chance.points(6));
            for point in chance.control(&camera, &pose, &points, 0.5) {
                let (found, true_one) = (seen(&camera, &point).residual(&pose).unwrap(), see(&camera, &pose, &point.object));
                let expected = [true_one.x - point.image.x, true_one.y - point.image.y];
                assert!((0..2).all(|axis| (found[axis] - expected[axis]).abs() < 0.01), "{found:?} {expected:?}");
            }
        }
    }

    #[test]
    fn from_nothing_it_finds_the_pose_that_the_camera_finds() {
        let mut chance = Chance::new(7);
        for _ in 0..100 {
            let (camera, pose, points) = (lens(), chance.pose(), chance.points(20));
            let exact: Vec<RayControl> = chance.control(&camera, &pose, &points, 0.0).iter().map(|point| seen(&camera, point)).collect();
            assert!(apart(&resect_by_rays(&exact).unwrap().pose, &pose) < 1e-9);
            let noisy = chance.control(&camera, &pose, &points, 0.1);
            let by_camera = fit_pose(&camera, &pose, &noisy).unwrap();
            let by_rays = resect_by_rays(&noisy.iter().map(|point| seen(&camera, point)).collect::<Vec<_>>()).unwrap();
            assert_eq!(by_rays.redundancy, by_camera.redundancy);
            assert!((by_rays.sigma0().unwrap() / by_camera.sigma0().unwrap() - 1.0).abs() < 0.01);
        }
    }

    /// A plane before a lens that looks behind itself: no tangents are asked for.
    #[test]
    fn a_board_around_a_fisheye_is_found() {
        let size = ImageSize { width: 1000, height: 1000 };
        let camera: Camera = OpenCvFisheye { size, fx: 280.0, fy: 280.0, cx: 500.0, cy: 500.0, k: [0.0; 4], skew: 0.0 }.into();
        let pose = Pose::looking_at(Point3::new(60.0, -40.0, 25.0), Point3::new(500.0, -40.0, 60.0), Vector3::z(), 0.3).unwrap();
        let control: Vec<RayControl> = (0..54)
            .map(|i| Point3::new(f64::from(i % 9) * 25.0, f64::from(i / 9) * -25.0, 0.0))
            .filter_map(|object| Some(Control { object, image: camera.project(pose.ray(&object)).ok()? }))
            .map(|point| seen(&camera, &point))
            .collect();
        assert!(control.len() >= 20 && control.iter().any(|point| point.direction.z > 0.1), "{}", control.len());
        assert!(apart(&resect_by_rays(&control).unwrap().pose, &pose) < 1e-8);
    }

    #[test]
    fn what_cannot_be_is_named() {
        let mut chance = Chance::new(8);
        let (camera, pose, points) = (lens(), chance.pose(), chance.points(5));
        let control: Vec<RayControl> = chance.control(&camera, &pose, &points, 0.0).iter().map(|point| seen(&camera, point)).collect();
        assert!(matches!(resect_by_rays(&control[..3]), Err(ApproximateError::TooFew { needed: 4, found: 3, .. })));
        let ray = Ray { x: 0.1, y: 0.2, z: -1.0 };
        assert_eq!(RayControl::new(Point3::origin(), ray, [ray, ray]), None);
        let away = Pose { rotation: -pose.rotation, ..pose };
        assert_eq!(control[0].residual(&away), None);
    }
}
