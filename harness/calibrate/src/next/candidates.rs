//! Photographs that could be taken.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use calibench_model::camera::{Camera, CameraModel, Ray};
use calibench_model::{PixelPoint, Pose};
use nalgebra::{Matrix3, Point3, Rotation3, Vector3};

use super::Photograph;
use super::field::Field;

/// Places of the middle along either side of the frame.
const PLACES: usize = 9;
/// Share of the frame along its sides that is kept free: a window of an operator has to have room.
const MARGIN: f64 = 0.02;
/// Known points that a photograph shows at least.
const LEAST: usize = 8;
/// A plane that is seen flatter is not measured: cosine of the angle to its normal.
const FLATTEST: f64 = 0.2;

/// A photograph that could be taken.
pub(super) struct Candidate {
    pub(super) pose: Pose,
    middle: PixelPoint,
    depth: f64,
    tilt: f64,
    nearer: Option<f64>,
}

impl Candidate {
    pub(super) fn photograph(&self, field: &Field, points: Vec<PixelPoint>, uncertainty: f64) -> Photograph {
        let along = self.pose.rotation * field.axes[0];
        let Self { pose, middle, depth, tilt, nearer } = *self;
        Photograph { pose, middle, depth, tilt, nearer, along: along.y.atan2(along.x), points, uncertainty }
    }

    /// Those of some points that it shows, and where; `None` if they are too few, or one is missing of what must be in view as a whole.
    pub(super) fn shown(&self, camera: &Camera, field: &Field, points: &[Point3<f64>]) -> Option<(Vec<Point3<f64>>, Vec<PixelPoint>)> {
        let normal = self.pose.rotation * field.axes[2];
        let size = camera.size();
        let inside = |at: f64, side: u32| (MARGIN..1.0 - MARGIN).contains(&((at + 0.5) / f64::from(side)));
        let image = |point: &Point3<f64>| {
            let there = self.pose.camera_from_world(point);
            let is_flat = field.is_plane && normal.dot(&-there) < FLATTEST * there.norm();
            let image = camera.project(self.pose.ray(point)).ok().filter(|_| there.z < 0.0 && !is_flat)?;
            (inside(image.x, size.width) && inside(image.y, size.height)).then_some(image)
        };
        let both = |point: &Point3<f64>| Some((*point, image(point)?));
        if field.whole {
            // The first that is missing ends it.
            return Some(points.iter().map(both).collect::<Option<Vec<_>>>()?.into_iter().unzip());
        }
        let found: Vec<_> = points.iter().filter_map(both).collect();
        (found.len() >= LEAST.min(points.len())).then(|| found.into_iter().unzip())
    }
}

/// All photographs that keep to the limits of `field`.
pub(super) fn candidates(camera: &Camera, field: &Field) -> Vec<Candidate> {
    let size = camera.size();
    let along = |i: usize, length: u32| (i as f64 + 0.5) / PLACES as f64 * f64::from(length) - 0.5;
    let places = (0..PLACES * PLACES).map(|k| PixelPoint::new(along(k % PLACES, size.width), along(k / PLACES, size.height)));
    let mut depths = field.depths.to_vec();
    depths.dedup();
    let attitudes = attitudes(field.tilt);
    let seen = places.filter_map(|middle| Some((middle, camera.unproject(middle).ok().filter(|ray| ray.z < 0.0)?)));
    let at = seen.flat_map(|(middle, ray)| depths.iter().map(move |&depth| (middle, at_depth(ray, depth))));
    at.flat_map(|at| attitudes.iter().map(move |attitude| candidate(field, at, attitude))).collect()
}

/// The point of a ray at a distance along the camera's axis.
fn at_depth(ray: Ray, depth: f64) -> Vector3<f64> {
    Vector3::new(ray.x, ray.y, ray.z) * (depth / -ray.z)
}

/// How the control is turned.
struct Attitude {
    /// From its axes to the camera's.
    turn: Matrix3<f64>,
    tilt: f64,
    nearer: Option<f64>,
}

fn attitudes(most: f64) -> Vec<Attitude> {
    let tilts =
        [0.5, 1.0].into_iter().flat_map(|share| (0..8).map(move |k| (share * most, Some(f64::from(k) * FRAC_PI_4 - 3.0 * FRAC_PI_4))));
    let tilts: Vec<(f64, Option<f64>)> = std::iter::once((0.0, None)).chain(tilts).collect();
    let about_axis = [0.0, FRAC_PI_2];
    let of = |(&(tilt, nearer), about): (&(f64, Option<f64>), f64)| {
        let towards = nearer.unwrap_or(0.0);
        let normal = Vector3::new(-tilt.sin() * towards.cos(), -tilt.sin() * towards.sin(), tilt.cos());
        let tilted = Rotation3::rotation_between(&Vector3::z(), &normal).unwrap_or_default();
        let about = Rotation3::from_axis_angle(&Vector3::z_axis(), about);
        Attitude { turn: (tilted * about).into_inner(), tilt, nearer }
    };
    tilts.iter().flat_map(|tilt| about_axis.map(|about| (tilt, about))).map(of).collect()
}

/// The photograph with the middle of the control at a place of the frame and of the camera's axes.
fn candidate(field: &Field, (middle, at): (PixelPoint, Vector3<f64>), attitude: &Attitude) -> Candidate {
    let rotation = attitude.turn * Matrix3::from_rows(&field.axes.map(|axis| axis.transpose()));
    let pose = Pose { rotation, centre: field.middle - rotation.transpose() * at };
    Candidate { pose, middle, depth: -at.z, tilt: attitude.tilt, nearer: attitude.nearer }
}
