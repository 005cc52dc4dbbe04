//! Boards whose truth is known, with Gaussian noise on their corners: what is measured without truth must agree with it.

mod boards;
mod fields;
mod honest;
mod left;
mod outliers;
mod point_files;
mod ranking;

use std::sync::Arc;

use calibench_calibrate::choice::ModelChoice;
use calibench_measure::Board;
use calibench_model::camera::{Camera, CameraModel, ImageSize, OpenCv};
use calibench_model::{PixelPoint, Pose};
use calibench_random::{Key, Purpose, stream};
use calibench_records::judgement::{Row, Summary};
use calibench_synth::pointing::{Hand, MapError};
use nalgebra::{Point3, Vector3};
use rand::RngExt;

use super::{Corners, Field, Material, Options, judge};

const SIZE: ImageSize = ImageSize { width: 640, height: 480 };
const BOARD: Board = Board { columns: 9, rows: 6 };
const SIDE: f64 = 25.0;

/// About the camera of OpenCV's samples.
fn camera() -> Camera {
    let mut distortion = [0.0; 14];
    distortion[..5].copy_from_slice(&[-0.26, 0.08, 8e-4, -5e-4, 0.0]);
    OpenCv { size: SIZE, fx: 536.0, fy: 536.0, cx: 338.0, cy: 234.0, distortion, coefficients: 5 }.into()
}

/// A board seen whole from `count` stations, its corners moved by `moved`, mm.
fn views(key: Key<'_>, count: usize, moved: &dyn Fn(usize) -> Vector3<f64>) -> Vec<Vec<PixelPoint>> {
    let (camera, mut rng) = (camera(), stream(key, Purpose::Station));
    let middle = Point3::new(4.0 * SIDE, -2.5 * SIDE, 0.0);
    let corner = |k: usize| Point3::new((k % 9) as f64 * SIDE, -((k / 9) as f64 * SIDE), 0.0) + moved(k);
    let mut found = Vec::new();
    while found.len() < count {
        let mut between = |low: f64, high: f64| low + (high - low) * rng.random::<f64>();
        let (across, up, roll) = (between(-0.6, 0.6), between(-0.6, 0.6), between(-1.6, 1.6));
        let (distance, aim) = (between(280.0, 420.0), Vector3::new(between(-60.0, 60.0), between(-40.0, 40.0), 0.0));
        let back = Vector3::new(across.sin() * up.cos(), up.sin(), across.cos() * up.cos());
        let Some(pose) = Pose::looking_at(middle + aim + distance * back, middle + aim, Vector3::y(), roll) else { continue };
        let seen: Vec<PixelPoint> = (0..BOARD.corners()).filter_map(|k| camera.project(pose.ray(&corner(k))).ok()).collect();
        let inside = |at: &PixelPoint| at.x > 5.0 && at.y > 5.0 && at.x < 634.0 && at.y < 474.0;
        if seen.len() == BOARD.corners() && seen.iter().all(inside) {
            found.push(seen);
        }
    }
    found
}

/// What operators with these standard deviations (px) measure of `count` views in a trial.
fn material(scenario: &str, trial: u64, count: usize, sigmas: &[f64]) -> Material {
    material_of(Key { seed: 7, of: scenario, trial, view: "", target: "" }, count, sigmas, &|_| Vector3::zeros())
}

/// The same of a board whose corners are moved.
fn material_of(key: Key<'_>, count: usize, sigmas: &[f64], moved: &dyn Fn(usize) -> Vector3<f64>) -> Material {
    let truth = views(key, count, moved);
    let names: Vec<Arc<str>> = (1..=count).map(|view| format!("v{view:02}").into()).collect();
    let operator = |(index, sigma): (usize, &f64)| {
        let name = format!("operator-{}", index + 1);
        let hand = Hand { sigma: *sigma, whole_pixels: false, map: MapError::default() };
        let mut rng = stream(Key { target: &name, ..key }, Purpose::Pointing);
        let at = truth.iter().map(|view| view.iter().map(|at| Some(hand.point(*at, &mut rng))).collect()).collect();
        Corners { method: name.as_str().into(), unavailable: None, at, rejected: Vec::new() }
    };
    let operators = sigmas.iter().enumerate().map(operator).collect();
    Material { field: Field::Board { board: BOARD, side: SIDE }, size: SIZE, views: names, missed: Vec::new(), operators }
}

fn options(models: &[&str], splits: u64) -> Options {
    let models = models.iter().map(|model| ModelChoice::parse(model).unwrap()).collect();
    Options { models, pitch_um: None, splits, seed: 11, name: "test".into(), published: None, published_sigma: None }
}

fn judged(material: &Material, options: &Options) -> (Vec<Row>, Summary) {
    let rows = judge(material, options).unwrap();
    let summary = Summary::new(&rows, options.seed);
    (rows, summary)
}
