//! Image points of a deep wall, computed from a camera, with noise.

use calibench_model::camera::{Camera, CameraModel};
use calibench_model::{PixelPoint, Pose};
use nalgebra::{Point3, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

/// Standard deviation of an image coordinate, px.
pub const SIGMA: f64 = 0.05;
/// Share of gross errors where there are some, and their size at most, px.
const GROSS: f64 = 0.05;
const SIZE: f64 = 40.0;

/// The point file and the control file of eight convergent images from `distance`, rolled by turns. Every stream starts from `seed`.
pub fn files(camera: &Camera, distance: f64, seed: u64, with_gross: bool) -> [String; 2] {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let (mut points, mut control) = (String::from("image,target,x,y\n"), String::from("target,X,Y,Z\n"));
    let wall = wall();
    for (i, point) in wall.iter().enumerate() {
        control.push_str(&format!("W{i},{},{},{}\n", point.x, point.y, point.z));
    }
    for image in 0..8 {
        let pose = station(image, distance);
        for (i, point) in wall.iter().enumerate() {
            let Some(PixelPoint { x, y }) = seen(camera, &pose, point) else { continue };
            let mut shifted = [x, y].map(|value| value + SIGMA * random.sample::<f64, _>(StandardNormal));
            if with_gross && random.random::<f64>() < GROSS {
                shifted = shifted.map(|value| value + SIZE * (2.0 * random.random::<f64>() - 1.0));
            }
            points.push_str(&format!("I{image},W{i},{},{}\n", shifted[0], shifted[1]));
        }
    }
    [points, control]
}

/// 13 x 9 points over 4.8 x 3.2, up to 1.2 before and behind the plane.
fn wall() -> Vec<Point3<f64>> {
    let depth = |i: usize| 1.2 * ((i as f64 * 0.618_034).fract() * 2.0 - 1.0);
    (0..13 * 9).map(|i| Point3::new((i % 13) as f64 * 0.4 - 2.4, (i / 13) as f64 * 0.4 - 1.6, depth(i))).collect()
}

fn station(image: u32, distance: f64) -> Pose {
    let (around, roll) = (f64::from(image) * 2.399_963, f64::from(image % 4) * std::f64::consts::FRAC_PI_2);
    let tilt = 0.15 + 0.45 * (f64::from(image) * 0.618_034).fract();
    let direction = Vector3::new(tilt.sin() * around.cos(), tilt.sin() * around.sin(), tilt.cos());
    Pose::looking_at(Point3::from(direction * distance), Point3::origin(), Vector3::y(), roll).unwrap()
}

fn seen(camera: &Camera, pose: &Pose, point: &Point3<f64>) -> Option<PixelPoint> {
    let (pixel, size) = (camera.project(pose.ray(point)).ok()?, camera.size());
    let inside = pixel.x >= 0.0 && pixel.y >= 0.0 && pixel.x <= f64::from(size.width - 1) && pixel.y <= f64::from(size.height - 1);
    inside.then_some(pixel)
}
