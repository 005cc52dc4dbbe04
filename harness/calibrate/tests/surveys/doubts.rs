//! What a calibration says of residuals that its model does not explain.

use calibench_adjust::Use;
use calibench_calibrate::{BoardShape, Calibration, Checked, GrossErrors, Prepared, Risk, Settings, Subject, Verdict, prepare};
use calibench_model::camera::{Camera, CameraModel, OpenCvFisheye};
use calibench_model::{ControlRow, PixelPoint, PointRef, Points, Pose};
use nalgebra::{Rotation3, Vector3};
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
    examined(prepared, |calibration| calibration.doubts().into_iter().map(|doubt| doubt.words).collect())
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

/// At most one in a hundred of 500 sound ones; alarms come once in 2000. And the probabilities are what they say: of each check a tenth are below 0.1, at most.
#[test]
fn sound_calibrations_are_not_doubted() {
    let all: Vec<Vec<Checked>> = (0..500_u64)
        .into_par_iter()
        .map(|seed| {
            let scene = noisy(if seed % 2 == 0 { board(lens()) } else { wall(lens()) }, seed);
            examined(&scene.prepared(&tested()).unwrap(), |calibration| calibration.checked.clone())
        })
        .collect();
    let alarms: Vec<&Checked> = all.iter().flatten().filter(|checked| checked.doubt().is_some()).collect();
    assert!(alarms.len() <= 2, "{alarms:#?}");
    for check in [0, 2, 3, 4] {
        let p = all.iter().filter_map(|checked| match &checked[check].verdict {
            Verdict::Sound(finding) | Verdict::Slight(finding, _) | Verdict::Doubt(finding, _) => Some(finding.p),
            Verdict::Untested(_) => None,
        });
        let (below, of) = p.fold((0, 0), |(below, of), p| (below + i32::from(p < 0.1), of + 1));
        // Sixteen to 84 of 500 are five standard deviations. Priors hold the coefficients of a richer lens: it explains less than as many free unknowns.
        let least = if all[0][check].subject == Subject::Lens { 0 } else { of / 10 - 34 };
        assert!(of > 400 && (least..of / 10 + 34).contains(&below), "{}: {below} of {of} below 0.1", all[0][check].subject.what());
    }
}

#[test]
fn every_check_is_made_on_a_board() {
    let checked = examined(&noisy(board(lens()), 1).prepared(&tested()).unwrap(), |calibration| calibration.checked.clone());
    assert_eq!(checked.len(), 5);
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
        point + Vector3::z() * (1.0 - u * u + 0.5 * (1.0 - v * v))
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

/// Rows are exposed one after the other while a hand turns the camera, each time otherwise, by `turn` rad or less from the first row to the last.
fn rolling(scene: &Scene, turn: f64) -> Points {
    let steps = 48_u32;
    let at = |step: u32| {
        let part = (f64::from(step) + 0.5) / f64::from(steps) - 0.5;
        let turned = |(index, pose): (usize, &Pose)| {
            let i = index as f64;
            let axis = Vector3::new((1.7 * i).sin(), (2.3 * i).cos(), 0.3 * i.sin());
            Pose { rotation: Rotation3::from_scaled_axis(part * turn * axis).into_inner() * pose.rotation, ..*pose }
        };
        let poses = scene.poses.iter().enumerate().map(turned).collect();
        Scene { poses, targets: scene.targets.clone(), ..*scene }.points()
    };
    let exposed: Vec<Points> = (0..steps).map(at).collect();
    with(&scene.points(), |_, row| {
        let step = (row.start.position.y / f64::from(SIZE.height) * f64::from(steps)) as usize;
        let seen = exposed[step.min(steps as usize - 1)].rows().find(|other| other.image == row.image && other.target == row.target);
        row.start = seen.map_or(row.start, |seen| seen.start);
    })
}

#[test]
fn a_rolling_shutter_is_said() {
    let settings = Settings { sigma_px: None, ..tested() };
    let scene = noisy(board(lens()), 4);
    doubted(rolling(&scene, 12e-3), &scene.known(), &settings, "rolling shutter");
}

/// Points of which a share lies anywhere in the frame.
fn spoilt(scene: &Scene, share: f64) -> Points {
    let mut state = 12_345_u64;
    let mut uniform = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let drawn: Vec<[f64; 3]> = scene.points().rows().map(|_| [uniform(), uniform(), uniform()]).collect();
    with(&scene.points(), |index, row| {
        let [chosen, x, y] = drawn[index];
        if chosen < share {
            row.start.position = PixelPoint::new(x * f64::from(SIZE.width - 1), y * f64::from(SIZE.height - 1));
        }
    })
}

/// Robust calibrations reach the camera of the good points, within its own standard deviations, or say that they do not.
#[test]
fn up_to_a_third_of_gross_errors_is_left_out_or_held_back() {
    for (name, scene) in [("board", noisy(board(lens()), 9)), ("wall", noisy(wall(lens()), 10))] {
        for share in [0.02, 0.1, 0.2, 0.3] {
            let points = spoilt(&scene, share);
            let wrong = scene.points().rows().zip(points.rows()).filter(|(a, b)| a.start.position != b.start.position).count();
            let prepared =
                prepare(points, &scene.known(), &Settings { gross: GrossErrors::Rejected(Risk::EachPoint), sigma_px: None, ..tested() })
                    .unwrap();
            let (left_out, error, sigma, doubts) = examined(&prepared, |calibration| {
                let error = calibration.camera(0).parameters()[0].value - 1450.0;
                let left_out = calibration.found.iter().filter(|found| found.left_out).count();
                let doubts: Vec<String> = calibration.doubts().into_iter().map(|doubt| doubt.words).collect();
                (left_out, error, calibration.covariances.interior[(0, 0)].sqrt(), doubts)
            });
            println!("{name} {share}: {left_out} of {wrong}, {error} +- {sigma} {doubts:?}");
            assert!(left_out >= wrong * 98 / 100 && left_out <= wrong + 5, "{name} {share}: {left_out} of {wrong}");
            assert!(error.abs() < 4.0 * sigma && doubts.is_empty(), "{name} {share}: {error} +- {sigma}, {doubts:?}");
        }
    }
    let prepared = noisy(board(lens()), 9);
    let prepared = prepare(
        spoilt(&prepared, 0.7),
        &prepared.known(),
        &Settings { gross: GrossErrors::Rejected(Risk::EachPoint), sigma_px: None, ..tested() },
    );
    assert!(prepared.is_err() || !doubts(&prepared.unwrap()).is_empty(), "no camera comes of a third of the points without a word");
}

/// Noise twice as large as the precision that is taken when none is stated makes no good point an outlier.
#[test]
fn huber_s_bound_follows_the_residuals() {
    let scene = Scene { sigma: 0.2, ..noisy(board(lens()), 11) };
    let prepared = scene.prepared(&Settings { gross: GrossErrors::Weighted(3.0), sigma_px: None, ..tested() }).unwrap();
    let calibration = prepared.adjust().unwrap();
    let less = calibration.solution.each_residual().filter(|residual| matches!(residual.used, Use::Downweighted(_))).count();
    // Of normal residuals exp(-4.5), 1.1 %.
    assert!(less <= 14 && less > 0, "{less} of {}", calibration.solution.counts().image_coordinates / 2);
    let bound = calibration.huber.unwrap();
    assert!((bound / 6.0 - 1.0).abs() < 0.1, "{bound}");
}
