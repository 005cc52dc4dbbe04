//! A camera as the loops use it: many points at once where the model can.

use calibench_model::camera::opencv::{CameraFromWorld, Jacobian, Prepared};
use calibench_model::camera::{Camera, CameraModel, DerivativeBuffer, Ray};
use calibench_model::{PixelPoint, Pose};

use super::gram::{BLOCK, LANES};
use crate::state::{before, camera_from_world};

/// Columns of a pose: a small rotation about the camera's axes, a shift along them.
pub(crate) const POSE: usize = 6;

/// A camera at the values of one iteration.
pub(super) enum Optics {
    /// Its kernels picture many points at once.
    Batch(Box<Prepared>),
    /// One by one.
    Single(Camera),
}

/// Pixels and derivatives of a view's points, in blocks of [`LANES`]: for each column so many of x, then so many of y.
#[derive(Default)]
pub(super) struct Pictured {
    pub(super) pixels: Vec<PixelPoint>,
    jacobian: Jacobian,
    single: Vec<f64>,
    columns: usize,
    is_batch: bool,
    buffer: DerivativeBuffer,
}

impl Optics {
    /// Of points behind the camera there are none among those that are pictured if `all_before`.
    pub(super) fn of(camera: &Camera, all_before: bool) -> Self {
        match camera {
            Camera::OpenCv(camera) if all_before => Self::Batch(Box::new(camera.prepared())),
            _ => Self::Single(*camera),
        }
    }

    /// Pictures `points`, those of which `behind` says so by the line through the projection centre; a point without an image has pixels that are not numbers.
    pub(super) fn picture(&self, pose: &Pose, points: &[[f64; 3]], behind: &[bool], into: &mut Pictured) {
        into.pixels.resize(points.len(), PixelPoint::default());
        let frame = camera_from_world(pose);
        match self {
            Self::Batch(camera) => {
                camera.project_all_with_derivatives(&frame, points, &mut into.pixels, &mut into.jacobian);
                (into.is_batch, into.columns) = (true, into.jacobian.columns());
            }
            Self::Single(camera) => one_by_one(camera, &frame, (points, behind), into),
        }
    }
}

impl Pictured {
    /// Blocks of derivatives: columns of the pose, then of all parameters.
    pub(super) fn blocks(&self) -> impl Iterator<Item = &[f64]> {
        let values = if self.is_batch { None } else { Some(self.single.chunks_exact((self.columns * BLOCK).max(1))) };
        let batch = self.is_batch.then(|| self.jacobian.blocks());
        batch.into_iter().flatten().chain(values.into_iter().flatten())
    }
}

fn one_by_one(camera: &Camera, frame: &CameraFromWorld, (points, behind): (&[[f64; 3]], &[bool]), into: &mut Pictured) {
    into.is_batch = false;
    for (i, point) in points.iter().enumerate() {
        let n: [f64; 3] = std::array::from_fn(|k| {
            let [a, b, c] = frame.rotation[k];
            a * point[0] + b * point[1] + c * point[2] + frame.translation[k]
        });
        let buffer = &mut into.buffer;
        let is_behind = behind.get(i).is_some_and(|behind| *behind);
        if camera.derivatives_into(before(Ray { x: n[0], y: n[1], z: n[2] }, is_behind), buffer).is_err() {
            into.pixels[i] = PixelPoint::new(f64::NAN, f64::NAN);
            continue;
        }
        into.pixels[i] = buffer.point;
        if i == 0 || into.columns != POSE + buffer.by_parameters().len() {
            into.columns = POSE + buffer.by_parameters().len();
        }
        let size = points.len().div_ceil(LANES) * into.columns * BLOCK;
        if into.single.len() != size {
            into.single.clear();
            into.single.resize(size, 0.0);
        }
        let block = &mut into.single[i / LANES * into.columns * BLOCK..][..into.columns * BLOCK];
        let mut put = |column: usize, [x, y]: [f64; 2]| {
            block[column * BLOCK + i % LANES] = x;
            block[column * BLOCK + LANES + i % LANES] = y;
        };
        let sign = if is_behind { -1.0 } else { 1.0 };
        let by = |axis: usize| [sign * buffer.by_ray[0][axis], sign * buffer.by_ray[1][axis]];
        let (dx, dy, dz) = (by(0), by(1), by(2));
        // d N = d x N + s: the rotation's columns are N x gradient.
        let cross = |a: f64, p: [f64; 2], b: f64, q: [f64; 2]| [a * p[0] - b * q[0], a * p[1] - b * q[1]];
        put(0, cross(n[1], dz, n[2], dy));
        put(1, cross(n[2], dx, n[0], dz));
        put(2, cross(n[0], dy, n[1], dx));
        put(3, dx);
        put(4, dy);
        put(5, dz);
        buffer.by_parameters().iter().enumerate().for_each(|(k, by)| put(POSE + k, *by));
    }
}
