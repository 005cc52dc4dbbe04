//! Blocks before a bent stand, for tests and benchmarks.

#![allow(dead_code)]

use calibench_adjust::{Datum, Exterior, ImageObservation, Interior, Network, ObjectPoint};
use calibench_model::Pose;
use calibench_model::camera::{Camera, CameraModel, Ebner, ImageSize, Photogrammetric};
use nalgebra::{Matrix3, Point3, Vector3};
use rand::RngExt;

use crate::networks::{normal, random};

/// Distance of the camera, mm.
pub const DISTANCE: f64 = 4440.0;
pub const NAMES: [&str; 12] = ["e1", "e2", "e3", "e4", "e5", "e6", "e7", "e8", "e9", "e10", "e11", "e12"];

/// How the images are grouped.
#[derive(Clone, Copy, PartialEq)]
pub enum Sets {
    None,
    One,
    Eight,
}

pub fn camera() -> Camera {
    let size = ImageSize { width: 240, height: 240 };
    let base = Photogrammetric { size, pitch_um: 27.0, c: 57.5, x0: 0.0, y0: 0.0, k: [0.0; 3], p: [0.0; 2], b: [0.0; 2] };
    Ebner { base, b_mm: 2.4, parameters: [0.0; 12] }.into()
}

/// 32 places over the central 500 mm of the field: two in each of 16 squares, mm.
pub fn places() -> Vec<[f64; 2]> {
    let mut random = random(88);
    let middle = |i: i32| f64::from(i) * 125.0 - 187.5;
    let place = |i: i32| [middle(i / 2 % 4), middle(i / 8)].map(|at| at + 90.0 * (random.random::<f64>() - 0.5));
    (0..32).map(place).collect()
}

/// 32 images of the field; the stand bends by `bend` mm over 250 mm to either side. Start values: a flat field, the poses off by a little.
pub fn block(bend: f64, sets: Sets) -> Network {
    let (camera, mut random) = (camera(), random(3));
    let mut network = Network { datum: Datum::Minimal { horizontal: [0, 31], vertical: [0, 7, 28] }, ..Network::default() };
    let places = places();
    network.points = places.iter().enumerate().map(|(i, [u, v])| ObjectPoint::free(format!("{i}"), Point3::new(*u, *v, 0.0))).collect();
    let count = [(Sets::None, 1), (Sets::One, 1), (Sets::Eight, 8)].iter().find(|(kind, _)| *kind == sets).map_or(1, |(_, count)| *count);
    for group in 0..count {
        let interior = Interior::fixed(format!("group {group}"), camera);
        network.cameras.push(if sets == Sets::None { interior } else { interior.free(&NAMES).expect("Ebner's parameters") });
    }
    for (image, (phi, turn, roll)) in [30.0_f64, 45.0].into_iter().flat_map(turns).enumerate() {
        let stand = Matrix3::new(turn.cos(), -turn.sin(), 0.0, turn.sin(), turn.cos(), 0.0, 0.0, 0.0, 1.0);
        let centre = stand.transpose() * Vector3::new(phi.sin(), 0.0, phi.cos()) * DISTANCE;
        let pose = Pose::looking_at(centre.into(), Point3::origin(), stand.transpose() * Vector3::y(), roll).expect("a pose");
        let group = if count == 8 { (image / 16) * 4 + image % 4 } else { 0 };
        network.images.push(Exterior::free(format!("{image}"), group, pose));
        for (point, [u, v]) in places.iter().enumerate() {
            let along = (turn.cos() * u - turn.sin() * v) / 250.0;
            let at = Point3::new(*u, *v, bend * (1.0 - along * along));
            let seen = camera.project(pose.ray(&at)).expect("in view");
            network.observations.push(ImageObservation::new(image, point, seen, 1.0));
        }
    }
    for image in &mut network.images {
        image.pose.centre += Vector3::from_fn(|_, _| 5.0 * normal(&mut random));
    }
    network
}

/// Turns of the field and rolls of the camera at one tilt, radians.
pub fn turns(phi: f64) -> impl Iterator<Item = (f64, f64, f64)> {
    let quarter = |i: i32| f64::from(i) * std::f64::consts::FRAC_PI_2;
    (0..16).map(move |i| (phi.to_radians(), quarter(i / 4), quarter(i % 4)))
}
