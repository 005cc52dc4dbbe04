//! Many control points before one camera: side by side where its kernels can.

use std::cell::RefCell;

use calibench_model::camera::opencv::{Jacobian, Prepared};
use calibench_model::camera::{Camera, CameraModel, Ray};
use calibench_model::{PixelPoint, Pose};
use nalgebra::SMatrix;

use super::{Control, Normal, pose_row, square};
use crate::normal::{BLOCK, LANES, Tile, gram};
use crate::state::camera_from_world;

/// Points at a time.
const CHUNK: usize = 256;
/// Columns whose products are summed: six of the pose, the misclosure, and none, so that they are even.
const COLUMNS: usize = 8;
/// Fewer points are pictured one by one: blocks would be half empty.
const FEW: usize = 32;

/// A camera that pictures many points, and its memory.
pub(in crate::approximate) struct Pictures<'c> {
    camera: &'c Camera,
    batch: Option<(Box<Prepared>, RefCell<Buffers>)>,
}

#[derive(Default)]
struct Buffers {
    objects: Vec<[f64; 3]>,
    pixels: Vec<PixelPoint>,
    jacobian: Jacobian,
    rows: Vec<f64>,
    tiles: Vec<Tile>,
}

impl<'c> Pictures<'c> {
    pub(in crate::approximate) fn of(camera: &'c Camera) -> Self {
        let batch = match camera {
            Camera::OpenCv(opencv) => Some((Box::new(opencv.prepared()), RefCell::default())),
            _ => None,
        };
        Self { camera, batch }
    }

    /// The rows of `control` for rotation and projection centre; `None` if a point is not pictured.
    pub(super) fn normal(&self, pose: &Pose, control: &[Control]) -> Option<Normal<6>> {
        match &self.batch {
            Some((camera, buffers)) if control.len() >= FEW => by_lanes(camera, &mut buffers.borrow_mut(), pose, control),
            _ => one_by_one(self.camera, pose, control),
        }
    }

    /// Adds the squared residuals of `control`, px^2, infinite for what is not pictured, to `squares`.
    pub(in crate::approximate) fn squares(&self, pose: &Pose, control: &[Control], squares: &mut Vec<f64>) {
        let Some((camera, buffers)) = self.batch.as_ref().filter(|_| control.len() >= LANES) else {
            return squares.extend(control.iter().map(|point| square(self.camera, pose, point)));
        };
        let (buffers, frame) = (&mut *buffers.borrow_mut(), camera_from_world(pose));
        for control in control.chunks(CHUNK) {
            buffers.fill(control);
            camera.project_all(&frame, &buffers.objects, &mut buffers.pixels);
            squares.extend(control.iter().zip(&buffers.pixels).map(|(point, pixel)| {
                let square = (pixel.x - point.image.x).powi(2) + (pixel.y - point.image.y).powi(2);
                if square.is_finite() { square } else { f64::INFINITY }
            }));
        }
    }
}

impl Buffers {
    fn fill(&mut self, control: &[Control]) {
        self.objects.clear();
        self.objects.extend(control.iter().map(|point| [point.object.x, point.object.y, point.object.z]));
        self.pixels.resize(control.len(), PixelPoint::default());
    }
}

fn by_lanes(camera: &Prepared, buffers: &mut Buffers, pose: &Pose, control: &[Control]) -> Option<Normal<6>> {
    let (frame, mut normal, mut products) = (camera_from_world(pose), Normal::new(), [0.0; COLUMNS * COLUMNS]);
    for control in control.chunks(CHUNK) {
        buffers.fill(control);
        camera.project_all_with_derivatives(&frame, &buffers.objects, &mut buffers.pixels, &mut buffers.jacobian);
        buffers.rows.clear();
        buffers.rows.resize(control.len().div_ceil(LANES) * COLUMNS * BLOCK, 0.0);
        let rows = buffers.rows.chunks_exact_mut(COLUMNS * BLOCK);
        let points = control.chunks(LANES).zip(buffers.pixels.chunks(LANES));
        for ((row, block), (control, pixels)) in rows.zip(buffers.jacobian.blocks()).zip(points) {
            row[..6 * BLOCK].copy_from_slice(&block[..6 * BLOCK]);
            for (lane, (point, pixel)) in control.iter().zip(pixels).enumerate() {
                row[6 * BLOCK + lane] = pixel.x - point.image.x;
                row[6 * BLOCK + LANES + lane] = pixel.y - point.image.y;
            }
            // The last block is filled up with its last point, which counts once.
            for column in row.chunks_exact_mut(LANES) {
                column[control.len()..].fill(0.0);
            }
        }
        gram(&buffers.rows, COLUMNS, &mut buffers.tiles, &mut products);
        normal.add_products(&products, COLUMNS, 2 * control.len());
    }
    // Kernels shift the points along the camera's axes: dN = -M dX0.
    let mut by = SMatrix::<f64, 6, 6>::identity();
    by.fixed_view_mut::<3, 3>(3, 3).copy_from(&-pose.rotation);
    // What is not pictured is no number, and so are then all sums.
    normal.squares.is_finite().then(|| normal.of_others(&by))
}

fn one_by_one(camera: &Camera, pose: &Pose, control: &[Control]) -> Option<Normal<6>> {
    let mut normal = Normal::new();
    for point in control {
        let n = pose.camera_from_world(&point.object);
        let found = camera.slopes(Ray { x: n.x, y: n.y, z: n.z }).ok()?;
        let misclosure = [found.point.x - point.image.x, found.point.y - point.image.y];
        for (by_ray, misclosure) in found.by_ray.into_iter().zip(misclosure) {
            normal.add(&pose_row(pose, &n, by_ray), misclosure);
        }
    }
    Some(normal)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::approximate::tests::{Chance, pinhole};

    fn distorting() -> Camera {
        let Camera::OpenCv(mut camera) = pinhole() else { panic!("OpenCV's camera has kernels") };
        camera.distortion[..5].copy_from_slice(&[-0.1, 0.03, 2e-4, -3e-4, -0.002]);
        camera.into()
    }

    /// Sums side by side are those one by one, whatever is left in the last block; so are the squares.
    #[test]
    fn side_by_side_as_one_by_one() {
        let mut chance = Chance::new(11);
        for camera in [distorting(), pinhole()] {
            for count in [FEW, FEW + 1, FEW + 7, CHUNK, CHUNK + 3, 3 * CHUNK - 1] {
                let (pose, points) = (chance.pose(), chance.points(count));
                let control = chance.control(&camera, &pose, &points, 2.0);
                let pictures = Pictures::of(&camera);
                let (found, expected) = (pictures.normal(&pose, &control).unwrap(), one_by_one(&camera, &pose, &control).unwrap());
                assert!(found.differs(&expected) < 1e-12, "{count}: {}", found.differs(&expected));
                let mut squares = Vec::new();
                pictures.squares(&pose, &control, &mut squares);
                for (found, point) in squares.iter().zip(&control) {
                    let expected = square(&camera, &pose, point);
                    assert!((found - expected).abs() <= 1e-9 * (1.0 + expected), "{found} {expected}");
                }
                assert_eq!(squares.len(), count);
            }
        }
    }

    #[test]
    fn what_is_behind_has_no_sums_and_an_infinite_square() {
        let mut chance = Chance::new(12);
        let (camera, pose, points) = (distorting(), chance.pose(), chance.points(FEW + 4));
        let mut control = chance.control(&camera, &pose, &points, 0.1);
        control[FEW + 2].object = pose.centre - (control[FEW + 2].object - pose.centre);
        let pictures = Pictures::of(&camera);
        assert!(pictures.normal(&pose, &control).is_none());
        let mut squares = Vec::new();
        pictures.squares(&pose, &control, &mut squares);
        assert!(squares.iter().enumerate().all(|(index, square)| square.is_finite() == (index != FEW + 2)), "{squares:?}");
    }
}
