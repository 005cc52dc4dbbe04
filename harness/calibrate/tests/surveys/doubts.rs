//! What a calibration says of residuals that its model does not explain.

use calibench_calibrate::{BoardShape, Calibration, Prepared, Settings, Verdict, prepare};
use calibench_exchange::{ControlRow, PointRef, Points};
use calibench_model::camera::{Camera, OpenCvFisheye};
use rayon::prelude::*;

use crate::network::{SIZE, Scene, board, lens, settings, wall};

const NOISE: f64 = 0.1;

fn noisy(scene: Scene, seed: u64) -> Scene {
    Scene { sigma: NOISE, seed: 1 + 1_000_003 * seed, ..scene }
}

fn examined<T>(prepared: &Prepared, read: impl FnOnce(&Calibration<'_>) -> T) -> T {
    let mut calibration = prepared.adjust().unwrap();
    calibration.examine();
    read(&calibration)
}

fn doubts(prepared: &Prepared) -> Vec<String> {
    examined(prepared, |calibration| calibration.doubts().into_iter().map(str::to_owned).collect())
}

fn with(points: &Points, change: impl Fn(usize, &mut PointRef<'_>)) -> Points {
    let mut changed = Points::default();
    for (index, mut row) in points.rows().enumerate() {
        change(index, &mut row);
        changed.push(row.image, row.target, row.start);
    }
    changed
}

fn tested() -> Settings {
    Settings { shape: BoardShape::Tested, sigma_px: Some(NOISE), ..settings("opencv5") }
}

/// At most one in a hundred of 500 sound ones; alarms come once in 2500.
#[test]
fn sound_calibrations_are_not_doubted() {
    let alarms: Vec<(u64, Vec<String>)> = (0..500_u64)
        .into_par_iter()
        .filter_map(|seed| {
            let scene = noisy(if seed % 2 == 0 { board(lens()) } else { wall(lens()) }, seed);
            let doubts = doubts(&scene.prepared(&tested()).unwrap());
            (!doubts.is_empty()).then_some((seed, doubts))
        })
        .collect();
    assert!(alarms.len() <= 2, "{alarms:#?}");
}

#[test]
fn every_check_is_made_on_a_board() {
    let checked = examined(&noisy(board(lens()), 1).prepared(&tested()).unwrap(), |calibration| calibration.checked.clone());
    assert_eq!(checked.len(), 4);
    assert!(checked.iter().all(|checked| matches!(checked.verdict, Verdict::Sound(_))), "{checked:?}");
}

fn doubted(points: Points, control: &[ControlRow], settings: &Settings, expected: &str) {
    let prepared = prepare(points, control, settings).unwrap();
    let found = doubts(&prepared);
    assert!(
        found.first().is_some_and(|cause| cause.contains(expected)),
        "{expected}: {:#?}",
        examined(&prepared, |calibration| calibration.checked.clone())
    );
}

#[test]
fn a_third_of_gross_errors_is_said() {
    let scene = noisy(board(lens()), 2);
    let points = with(&scene.points(), |index, row| {
        let size = if index % 3 == 0 { 20.0 + (index % 17) as f64 } else { 0.0 };
        row.start.position.x += size * (index as f64).sin();
        row.start.position.y += size * (index as f64).cos();
    });
    doubted(points, &scene.known(), &Settings { sigma_px: None, ..tested() }, "gross errors");
}

#[test]
fn a_board_that_is_kept_flat_is_said_to_be_bent() {
    let flat = board(lens());
    let bend = |point: &nalgebra::Point3<f64>| {
        let (u, v) = (point.x / 120.0 - 1.0, point.y / 90.0 - 1.0);
        point + nalgebra::Vector3::z() * (1.0 - u * u + 0.5 * (1.0 - v * v))
    };
    let bent = noisy(Scene { targets: flat.targets.iter().map(bend).collect(), ..board(lens()) }, 3);
    let settings = Settings { shape: BoardShape::Flat, sigma_px: None, ..tested() };
    doubted(bent.points(), &flat.known(), &settings, "bent");
}

#[test]
fn control_that_is_not_where_its_file_says_is_named() {
    let settings = Settings { sigma_px: None, ..tested() };
    let scene = noisy(board(lens()), 4);
    let mut swapped = scene.known();
    (swapped[11].position, swapped[12].position) = (swapped[12].position, swapped[11].position);
    doubted(scene.points(), &swapped, &settings, "names of control points t11 and t12 are swapped");
    // One of 63 points, 2 mm off, moves the camera less than its noise does: it is said, and does not count.
    let mut moved = scene.known();
    moved[40].position[0] += 2.0;
    let prepared = prepare(scene.points(), &moved, &settings).unwrap();
    let found = examined(&prepared, |calibration| calibration.checked[2].verdict.clone());
    assert!(matches!(&found, Verdict::Slight(_, cause) if cause.contains("control point t40 moved, by 1.9")), "{found:?}");
    moved[40].position[0] += 8.0;
    doubted(scene.points(), &moved, &settings, "control point t40 moved, by 9.");
    let mut stretched = scene.known();
    stretched.iter_mut().for_each(|row| row.position[0] *= 1.01);
    let found = doubts(&prepare(scene.points(), &stretched, &settings).unwrap());
    // A board that is longer one way is a camera whose pixels are longer the other way: no residual shows it.
    assert!(found.is_empty() || found[0].contains("longer along"), "{found:?}");
    let wall = noisy(wall(lens()), 5);
    let mut swapped = wall.known();
    (swapped[20].position, swapped[30].position) = (swapped[30].position, swapped[20].position);
    doubted(wall.points(), &swapped, &settings, "names of control points t20 and t30 are swapped");
}

#[test]
fn a_model_that_is_too_poor_is_said() {
    let fisheye: Camera =
        OpenCvFisheye { size: SIZE, fx: 700.0, fy: 700.0, cx: 800.0, cy: 600.0, skew: 0.0, k: [0.02, -0.01, 0.003, 0.0] }.into();
    let scene = noisy(board(fisheye), 6);
    let settings = Settings { sigma_px: None, ..settings("opencv4") };
    let settings = Settings { shape: BoardShape::Tested, ..settings };
    let solve = ["fx", "fy", "cx", "cy", "k1"].map(str::to_owned);
    let cameras = settings.cameras.iter().map(|optics| calibench_calibrate::Optics { solve: Some(solve.to_vec()), ..optics.clone() });
    doubted(scene.points(), &scene.known(), &Settings { cameras: cameras.collect(), ..settings.clone() }, "too poor");
}

#[test]
fn a_precision_that_was_stated_too_well_is_said() {
    let scene = noisy(board(lens()), 7);
    doubted(scene.points(), &scene.known(), &Settings { sigma_px: Some(0.04), ..tested() }, "2.5 times as imprecise as stated");
}
