//! Photographs that could be taken.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use calibench_model::camera::{Camera, CameraModel};
use calibench_model::{PixelPoint, Pose};
use nalgebra::{Matrix3, Point3, Rotation3, Vector3};
use rayon::prelude::*;

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

/// A photograph that could be taken, with what it would show.
pub(super) struct Candidate {
    pub(super) pose: Pose,
    /// Points of the control in view, object units.
    pub(super) seen: Vec<Point3<f64>>,
    points: Vec<PixelPoint>,
    middle: PixelPoint,
    depth: f64,
    tilt: f64,
    nearer: Option<f64>,
}

impl Candidate {
    pub(super) fn photograph(&self, field: &Field, uncertainty: f64) -> Photograph {
        let along = self.pose.rotation * field.axes[0];
        let Self { pose, middle, depth, tilt, nearer, .. } = *self;
        Photograph { pose, middle, depth, tilt, nearer, along: along.y.atan2(along.x), points: self.points.clone(), uncertainty }
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
    let all: Vec<_> = places.flat_map(|middle| depths.iter().map(move |&depth| (middle, depth))).collect();
    let of_place = |&(middle, depth): &(PixelPoint, f64)| {
        attitudes.iter().filter_map(|attitude| candidate(camera, field, (middle, depth), attitude)).collect::<Vec<_>>()
    };
    all.par_iter().flat_map_iter(of_place).collect()
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

fn candidate(camera: &Camera, field: &Field, (middle, depth): (PixelPoint, f64), attitude: &Attitude) -> Option<Candidate> {
    let ray = camera.unproject(middle).ok().filter(|ray| ray.z < 0.0)?;
    let rotation = attitude.turn * Matrix3::from_rows(&field.axes.map(|axis| axis.transpose()));
    let at = Vector3::new(ray.x, ray.y, ray.z) * (depth / -ray.z);
    let pose = Pose { rotation, centre: field.middle - rotation.transpose() * at };
    let normal = rotation * field.axes[2];
    let size = camera.size();
    let [right, below] = [size.width, size.height].map(|side| f64::from(side) * (1.0 - MARGIN) - 0.5);
    let margin = [size.width, size.height].map(|side| f64::from(side) * MARGIN - 0.5);
    let (mut seen, mut points) = (Vec::new(), Vec::new());
    for point in &field.points {
        let there = pose.camera_from_world(point);
        let is_flat = field.is_plane && normal.dot(&-there) < FLATTEST * there.norm();
        let image = camera.project(pose.ray(point)).ok().filter(|_| there.z < 0.0 && !is_flat);
        match image.filter(|p| (margin[0]..right).contains(&p.x) && (margin[1]..below).contains(&p.y)) {
            Some(image) => {
                seen.push(*point);
                points.push(image);
            }
            None if field.whole => return None,
            None => {}
        }
    }
    let Attitude { tilt, nearer, .. } = *attitude;
    (seen.len() >= LEAST.min(field.points.len())).then_some(Candidate { pose, seen, points, middle, depth, tilt, nearer })
}
