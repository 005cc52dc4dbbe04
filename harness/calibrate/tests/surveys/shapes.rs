//! Boards that are bent while their control file says flat.

use calibench_calibrate::{Bend, Board, BoardShape, CalibrationError, DatumChoice, Prepared, Settings, Shape, prepare};
use nalgebra::{Point3, Vector3};
use rayon::prelude::*;

use crate::network::{Scene, agrees, board, lens, settings, wall};

const NOISE: f64 = 0.1;

/// Points of a board of 240 x 180 mm, bent towards the camera by `bend` mm, and the control file of the flat one.
fn prepared(bend: [f64; 3], noise: f64, seed: u64, settings: &Settings) -> Result<Prepared, CalibrationError> {
    let flat = board(lens());
    prepare(bent(bend, noise, seed).points(), &flat.known(), settings)
}

fn bent([a, b, c]: [f64; 3], sigma: f64, seed: u64) -> Scene {
    let scene = board(lens());
    let lifted = |point: &Point3<f64>| {
        let (u, v) = (point.x / 120.0 - 1.0, point.y / 90.0 - 1.0);
        point + Vector3::z() * (a * (1.0 - u * u) + b * (1.0 - v * v) + c * u * v)
    };
    Scene { targets: scene.targets.iter().map(lifted).collect(), sigma, seed: 1 + 1_000_003 * seed, ..scene }
}

fn tested() -> Settings {
    Settings { shape: BoardShape::Tested, ..settings("opencv5") }
}

fn found(shape: &Shape) -> Bend {
    match shape {
        Shape::Flat { bend, .. } | Shape::Bent { bend: Some(bend), .. } => *bend,
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_bend_is_found_within_its_sigmas() {
    for size in [0.3, 1.0, 3.0] {
        let truth = [size, -0.4 * size, 0.2 * size];
        let tests: Vec<(Bend, [f64; 3])> = (0..60)
            .into_par_iter()
            .map(|seed| {
                let prepared = prepared(truth, NOISE, seed, &tested()).unwrap();
                assert!(matches!(prepared.shape, Shape::Bent { .. }), "{size} mm, {seed}: {:?}", prepared.shape);
                let calibration = prepared.adjust().unwrap();
                (found(&prepared.shape), calibration.solution.surfaces().next().unwrap())
            })
            .collect();
        for k in 0..3 {
            let off = |(bend, adjusted): &(Bend, [f64; 3])| (adjusted[k] - truth[k]) / bend.sigmas[k];
            let mean_square = tests.iter().map(|test| off(test).powi(2)).sum::<f64>() / 60.0;
            // Chi squared of 60 degrees of freedom, 99.9 %: 0.52 to 1.66.
            assert!((0.5..1.7).contains(&mean_square), "{size} mm, coefficient {k}: {mean_square}");
        }
    }
}

/// At the level of a thousandth: of 500 flat boards 3 or more are taken for bent once in 500 seeds.
#[test]
fn a_flat_board_stays_flat() {
    let alarms = (0..500_u64).into_par_iter().filter(|&seed| {
        let prepared = prepared([0.0; 3], NOISE, 1000 + seed, &tested()).unwrap();
        assert!(prepared.network.surfaces.is_empty() == matches!(prepared.shape, Shape::Flat { .. }));
        matches!(prepared.shape, Shape::Bent { .. })
    });
    let alarms = alarms.count();
    assert!(alarms <= 3, "{alarms} of 500");
}

#[test]
fn the_camera_of_a_bent_board_is_that_of_a_flat_one() {
    let truth = [1.0, 0.6, -0.3];
    let prepared_as = |shape| prepared(truth, 0.0, 1, &Settings { shape, ..settings("opencv5") }).unwrap();
    let (bent, flat) = (prepared_as(BoardShape::Bent), prepared_as(BoardShape::Flat));
    let bent = bent.adjust().unwrap();
    agrees(&bent, &lens(), 1e-6);
    bent.solution.surfaces().next().unwrap().iter().zip(truth).for_each(|(a, b)| assert!((a - b).abs() < 1e-6, "{a} {b}"));
    let flat = flat.adjust().unwrap();
    assert!(flat.rms_px() > 0.1 && bent.rms_px() < 1e-6, "{} {}", flat.rms_px(), bent.rms_px());
    // Two coefficients, as mrcal has them: the twist of this board stays in the residuals.
    let axes = prepared_as(BoardShape::BentAxes);
    let axes = axes.adjust().unwrap();
    assert_eq!(axes.solution.surfaces().next().unwrap()[2], 0.0);
    assert!(axes.rms_px() > 1e-3 && axes.rms_px() < flat.rms_px());
    // Free corners: the shape is there after the best similarity.
    let free = prepared_as(BoardShape::Free);
    assert_eq!(free.settings.datum, DatumChoice::Free);
    let free = free.adjust().unwrap();
    assert!(free.rms_px() < 1e-6);
    agrees(&free, &lens(), 1e-5);
}

#[test]
fn gross_errors_neither_hide_a_bend_nor_feign_one() {
    for (bend, is_bent) in [([0.0; 3], false), ([1.0, 0.0, 0.0], true)] {
        let (flat, scene) = (board(lens()), bent(bend, NOISE, 5));
        let (whole, mut points) = (scene.points(), calibench_model::Points::default());
        for (index, mut row) in whole.rows().enumerate() {
            row.start.position.x += if index % 40 == 7 { 8.0 } else { 0.0 };
            points.push(row.image, row.target, row.start);
        }
        let prepared = prepare(points, &flat.known(), &tested()).unwrap();
        assert_eq!(matches!(prepared.shape, Shape::Bent { .. }), is_bent, "{:?}", prepared.shape);
    }
}

#[test]
fn what_cannot_be_tested_is_said_and_what_cannot_be_bent_refused() {
    let mut field = wall(lens());
    field.sigma = NOISE;
    let prepared = field.prepared(&tested()).unwrap();
    assert_eq!(prepared.shape, Shape::Untested("the control points do not lie in one plane".into()));
    let error = field.prepared(&Settings { shape: BoardShape::Bent, ..settings("opencv5") }).unwrap_err().to_string();
    assert!(error.contains("do not lie in one plane") && error.contains("--board-shape flat"), "{error}");
    // In a free network every corner is free: nothing to be tested, nothing to bend.
    let free = Settings { datum: DatumChoice::Free, ..tested() };
    assert_eq!(super::shapes::prepared([0.0; 3], NOISE, 1, &free).unwrap().shape, Shape::Untouched);
    let error = super::shapes::prepared([0.0; 3], NOISE, 1, &Settings { shape: BoardShape::Bent, ..free }).unwrap_err();
    assert!(error.to_string().contains("free in this datum"), "{error}");
    // Exact data show nothing but rounding.
    assert!(matches!(super::shapes::prepared([0.0; 3], 0.0, 1, &tested()).unwrap().shape, Shape::Untested(_)));
    // One view from the front does not tell a bend from distortion.
    let mut scene = bent([1.0, 0.0, 0.0], NOISE, 1);
    scene.poses.truncate(1);
    let one = prepare(scene.points(), &board(lens()).known(), &tested());
    let why = "these images do not determine the bend of the board beside the camera";
    assert_eq!(one.map(|one| one.shape).ok(), Some(Shape::Untested(why.into())));
    assert_eq!(Board::deflection([0.5, 0.0, 0.0]), 0.5);
}
