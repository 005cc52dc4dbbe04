//! Random configurations for tests: what is true, and what is seen of it.

use calibench_model::camera::{Camera, CameraModel, ImageSize, OpenCv, Photogrammetric};
use calibench_model::{PixelPoint, Pose};
use nalgebra::{Point3, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::pose_fit::Control;

pub(super) const SIZE: ImageSize = ImageSize { width: 4272, height: 2848 };

/// A camera with a distorting lens.
pub(super) fn lens() -> Camera {
    let (k, p) = ([-2.6e-4, 6e-7, 0.0], [4e-5, -2e-5]);
    Photogrammetric { size: SIZE, pitch_um: 5.15, c: 19.2, x0: 0.04, y0: -0.13, k, p, b: [1e-4, -2e-4] }.into()
}

/// A camera without distortion.
pub(super) fn pinhole() -> Camera {
    OpenCv { size: SIZE, fx: 3710.0, fy: 3725.0, cx: 2160.0, cy: 1410.0, distortion: [0.0; 14], coefficients: 5 }.into()
}

/// Random numbers.
pub(super) struct Chance(ChaCha8Rng);

impl Chance {
    pub(super) fn new(seed: u64) -> Self {
        Self(ChaCha8Rng::seed_from_u64(seed))
    }

    /// Even in [low, high).
    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.random::<f64>()
    }

    /// Normal, of standard deviation one: Box and Muller.
    pub(super) fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.0.random::<f64>()).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.0.random::<f64>()).cos()
    }

    pub(super) fn vector(&mut self) -> Vector3<f64> {
        Vector3::new(self.normal(), self.normal(), self.normal())
    }

    /// A camera at a distance of 6 to 12 from the origin, that sees it near the middle of its frame; any roll.
    pub(super) fn pose(&mut self) -> Pose {
        self.pose_from(&Vector3::z(), 0.0)
    }

    /// As [`Self::pose`], from directions that lie towards `side` by more than `least` of the distance.
    pub(super) fn pose_from(&mut self, side: &Vector3<f64>, least: f64) -> Pose {
        loop {
            let direction = self.vector().normalize();
            let centre = Point3::from(direction * self.between(6.0, 12.0));
            let aim = Point3::from(self.vector() * 0.1);
            let roll = self.between(-3.0, 3.0);
            if let Some(pose) = Pose::looking_at(centre, aim, Vector3::y(), roll).filter(|_| direction.dot(side) > least) {
                return pose;
            }
        }
    }

    /// A point in a cube of side 2 around the origin.
    pub(super) fn point(&mut self) -> Point3<f64> {
        Point3::new(self.between(-1.0, 1.0), self.between(-1.0, 1.0), self.between(-1.0, 1.0))
    }

    pub(super) fn points(&mut self, count: usize) -> Vec<Point3<f64>> {
        (0..count).map(|_| self.point()).collect()
    }

    /// A picture with errors of `sigma` px.
    pub(super) fn noisy(&mut self, point: PixelPoint, sigma: f64) -> PixelPoint {
        PixelPoint::new(point.x + sigma * self.normal(), point.y + sigma * self.normal())
    }

    /// Control as `camera` sees it, with errors of `sigma` px.
    pub(super) fn control(&mut self, camera: &Camera, pose: &Pose, points: &[Point3<f64>], sigma: f64) -> Vec<Control> {
        let control = |object: &Point3<f64>| Control { object: *object, image: self.noisy(see(camera, pose, object), sigma) };
        points.iter().map(control).collect()
    }
}

/// The picture of a point.
pub(super) fn see(camera: &Camera, pose: &Pose, point: &Point3<f64>) -> PixelPoint {
    camera.project(pose.ray(point)).unwrap()
}

/// A board of 9 x 6 corners, in its own plane z = 0, around the origin.
pub(super) fn board() -> Vec<Point3<f64>> {
    (0..54).map(|i| Point3::new(0.25 * (f64::from(i % 9) - 4.0), 0.25 * (f64::from(i / 9) - 2.5), 0.0)).collect()
}

/// The norm of the difference of rotations and of projection centres, by their distance from the origin.
pub(super) fn apart(a: &Pose, b: &Pose) -> f64 {
    (a.rotation - b.rotation).norm() + (a.centre - b.centre).norm() / b.centre.coords.norm()
}
