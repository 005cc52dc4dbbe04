//! Object points from two oriented images each.

use calibench_calibrate::Survey;
use calibench_calibrate::orientation::{ObjectPoints, StatedPrecision};
use calibench_exchange::control::parse_control;
use calibench_model::{ControlRow, Pose};

use crate::network::{Scene, lens, wall};

const NOISE: f64 = 0.3;

fn scene(seed: u64) -> Scene {
    let scene = wall(lens());
    Scene { poses: vec![scene.poses[0], scene.poses[4]], sigma: NOISE, seed: 1 + 999_983 * seed, ..scene }
}

fn points(scene: &Scene, sigma_px: Option<f64>) -> (Survey, ObjectPoints) {
    let survey = Survey::without_control(scene.points());
    let poses: Vec<Option<Pose>> = scene.poses.iter().copied().map(Some).collect();
    let found = ObjectPoints::of(&survey, &[scene.camera; 2], &poses, 1e-3, StatedPrecision { sigma_px, ..Default::default() });
    (survey, found)
}

fn rows(survey: &Survey, points: &ObjectPoints) -> Vec<ControlRow> {
    let mut text = Vec::new();
    points.write(survey, &mut text).unwrap();
    parse_control("points.csv", &text[..]).unwrap()
}

fn truth(scene: &Scene, row: &ControlRow) -> [f64; 3] {
    scene.targets[row.target[1..].parse::<usize>().unwrap()].into()
}

/// From its own two images a target has one redundant coordinate, and a fifth of all errors would exceed three of its standard deviations.
#[test]
fn errors_are_as_large_as_the_standard_deviations_say() {
    for stated in [None, Some(NOISE)] {
        let (mut beyond, mut squares, mut count) = (0, 0.0, 0.0);
        for seed in 0..25 {
            let scene = scene(seed);
            let (survey, found) = points(&scene, stated);
            assert!((found.pooled().unwrap() / NOISE - 1.0).abs() < 0.5 && found.agrees_with(NOISE));
            for row in rows(&survey, &found) {
                let errors = truth(&scene, &row).into_iter().zip(row.position).zip(row.sigmas.unwrap()).map(|((t, p), s)| (p - t) / s);
                for error in errors {
                    (beyond, squares, count) = (beyond + usize::from(error.abs() > 3.0), squares + error * error, count + 1.0);
                }
            }
        }
        // 3600 normal errors, three of a point correlated: 0.27 % beyond three, and a mean square of one.
        assert!(count > 3000.0 && (beyond as f64) < 0.008 * count, "{beyond} of {count}");
        assert!((squares / count - 1.0).abs() < 0.12, "{}", squares / count);
    }
}

#[test]
fn what_does_not_fit_is_counted_and_noted() {
    let exact = scene(3);
    let mut points = calibench_model::Points::default();
    for (index, mut row) in exact.points().rows().enumerate() {
        // Across the epipolar lines, which run along x: y of one image.
        row.start.position.y += if index == 5 { 12.0 } else { 0.0 };
        points.push(row.image, row.target, row.start);
    }
    let survey = Survey::without_control(points);
    let poses: Vec<Option<Pose>> = exact.poses.iter().copied().map(Some).collect();
    let found =
        ObjectPoints::of(&survey, &[exact.camera; 2], &poses, 1e-3, StatedPrecision { sigma_px: Some(NOISE), ..Default::default() });
    assert_eq!(found.misfits(), 1);
    let both = (0..survey.targets()).filter(|&target| survey.of_target(target).count() == 2).count();
    assert!(
        both > 30 && (found.len(), found.failed, found.is_empty()) == (both, survey.targets() - both, false),
        "{} of {both}",
        found.len()
    );
    assert!(!found.agrees_with(NOISE));
    let mut text = Vec::new();
    found.write(&survey, &mut text).unwrap();
    let text = String::from_utf8(text).unwrap();
    let noted: Vec<&str> = text.lines().filter(|line| line.ends_with("does not fit")).collect();
    assert!(noted.len() == 1 && noted[0].starts_with(&format!("{},", survey.target(survey.sight(5).target))), "{noted:?}");
}
