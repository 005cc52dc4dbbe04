//! Standard deviations from leaving images out.

use calibench_model::{Points, Pose};
use nalgebra::{Point3, Vector3};
use rayon::prelude::*;

use crate::network::{Scene, board, lens, settings};

/// A board from 24 sides.
fn scene(seed: u64) -> Scene {
    let middle = Point3::new(120.0, 90.0, 0.0);
    let station = |i: i32| {
        let (angle, reach) = (2.4 * f64::from(i), 60.0 + 9.0 * f64::from(i));
        let from = Vector3::new(reach * angle.cos(), reach * angle.sin(), 320.0 + 6.0 * f64::from(i % 7));
        Pose::looking_at(middle + from, middle, Vector3::y(), 0.7 * f64::from(i)).unwrap()
    };
    Scene { poses: (0..24).map(station).collect(), sigma: 0.1, seed: 1 + 1_000_003 * seed, ..board(lens()) }
}

/// Points that are farther from the middle, or nearer, in one image than in another, by up to `size` px at 500 px.
fn breathing(scene: &Scene, size: f64) -> Points {
    let mut points = Points::default();
    for mut row in scene.points().rows() {
        let image: f64 = row.image.trim_start_matches("image_").trim_end_matches(".png").parse().unwrap();
        let (dx, dy) = (row.start.position.x - 800.0, row.start.position.y - 600.0);
        let radius = dx.hypot(dy) / 500.0;
        let factor = size * (7.3 * image).sin() * radius * radius / 500.0;
        row.start.position.x += factor * dx;
        row.start.position.y += factor * dy;
        points.push(row.image, row.target, row.start);
    }
    points
}

fn ratio(size: f64) -> f64 {
    let ratios: Vec<f64> = (0..24_u64)
        .into_par_iter()
        .map(|seed| {
            let scene = scene(seed);
            let prepared = calibench_calibrate::prepare(breathing(&scene, size), &scene.known(), &settings("opencv5")).unwrap();
            let mut found = prepared.adjust().unwrap();
            found.resample();
            let resampled = found.resampled.as_ref().unwrap().as_ref().unwrap();
            assert_eq!((resampled.groups, resampled.sigmas.len()), (20, 9));
            let interior = &found.covariances.interior;
            resampled.ratio((0..9).map(|i| interior[(i, i)].sqrt())).unwrap()
        })
        .collect();
    ratios.iter().sum::<f64>() / 24.0
}

#[test]
fn they_are_the_formal_ones_where_errors_are_independent_and_larger_where_images_differ() {
    let independent = ratio(0.0);
    assert!((0.85..1.2).contains(&independent), "{independent}");
    let breathing = ratio(5.0);
    assert!(breathing > 1.5, "{independent} {breathing}");
}

#[test]
fn where_they_cannot_be_is_said() {
    let mut few = scene(1);
    few.poses.truncate(5);
    let prepared = few.prepared(&settings("opencv5")).unwrap();
    let mut found = prepared.adjust().unwrap();
    assert!(found.resampled.is_none());
    found.resample();
    assert_eq!(found.resampled, Some(Err("5 images; it takes 6".into())));
}
