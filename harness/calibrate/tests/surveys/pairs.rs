//! A pair of images and its model.

use calibench_adjust::approximate::Tolerance;
use calibench_calibrate::orientation::{Pair, Seen};
use calibench_model::camera::CameraModel;
use nalgebra::{Matrix3, Vector3};

use crate::network::{Scene, lens, wall};

#[test]
fn the_model_of_a_pair_is_the_wall_in_base_lengths() {
    let whole = wall(lens());
    let scene = Scene { poses: vec![whole.poses[1], whole.poses[3]], ..wall(lens()) };
    let base = (scene.poses[0].centre - scene.poses[1].centre).norm();
    let seen = Seen::of(&scene.points(), "image_0.png", "image_1.png").unwrap();
    let pair = Pair::orient([&scene.camera; 2], seen, (Tolerance::Pixels(1.0), 1), base, 1e-3).unwrap();
    // Its projection centres in object units.
    let right = pair.pose(&pair.found.pose);
    assert!((right.centre.coords.norm() / base - 1.0).abs() < 1e-9, "{} for {base}", right.centre.coords.norm());
    // Angles between the rays, from the truth.
    let mut angles: Vec<f64> = pair
        .targets
        .iter()
        .filter(|target| target.point.is_ok())
        .map(|target| {
            let point = scene.targets[target.seen.target[1..].parse::<usize>().unwrap()];
            (point - scene.poses[0].centre).angle(&(point - scene.poses[1].centre))
        })
        .collect();
    angles.sort_by(f64::total_cmp);
    let median = angles[angles.len() / 2];
    assert!((pair.median_angle().unwrap() - median).abs() < 1e-6, "{} for {median}", pair.median_angle().unwrap());
    // Extents do not depend on axes or scale.
    let known: Vec<Vector3<f64>> = pair
        .targets
        .iter()
        .filter(|target| target.point.is_ok())
        .map(|target| scene.targets[target.seen.target[1..].parse::<usize>().unwrap()].coords)
        .collect();
    let mean = known.iter().sum::<Vector3<f64>>() / known.len() as f64;
    let spread: Matrix3<f64> = known.iter().map(|point| (point - mean) * (point - mean).transpose()).sum();
    let values = spread.symmetric_eigenvalues();
    let thickness = (values.min() / values.max()).sqrt();
    assert!(thickness > 0.05 && (pair.thickness().unwrap() - thickness).abs() < 1e-6, "{:?} for {thickness}", pair.thickness());
    assert!(scene.camera.size().width == 1600);
}
