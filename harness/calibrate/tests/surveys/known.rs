//! How well a camera is known over its frame, and what is said where it is not.

use calibench_calibrate::{Calibration, Settings, calibrate, usual_limit_px};
use calibench_model::Pose;
use calibench_model::camera::ImageSize;
use calibench_model::convert::{DifferenceOptions, difference};
use nalgebra::{Point3, Vector3};
use rayon::prelude::*;

use crate::network::{SIZE, Scene, board, lens, settings};

fn noisy(scene: Scene, seed: u64) -> Scene {
    Scene { sigma: 0.1, seed: 1 + 1_000_003 * seed, ..scene }
}

/// A board in the middle of the frame from eight stations, whose axes are inclined by `tilt` (of the distance) at most.
fn inclined(tilt: f64) -> Scene {
    let middle = Point3::new(120.0, 90.0, 0.0);
    let station = |i: i32| {
        let (sin, cos) = (0.8 * f64::from(i)).sin_cos();
        let distance = 500.0 + 20.0 * f64::from(i);
        let centre = middle + Vector3::new(tilt * cos * distance, tilt * sin * distance, distance);
        Pose::looking_at(centre, middle, Vector3::y(), 1.5 * f64::from(i)).unwrap()
    };
    Scene { poses: (0..8).map(station).collect(), ..board(lens()) }
}

/// A board that fills the frame from 24 sides.
fn around() -> Scene {
    let middle = Point3::new(120.0, 90.0, 0.0);
    let station = |i: i32| {
        let (angle, reach) = (2.4 * f64::from(i), 60.0 + 9.0 * f64::from(i));
        let from = Vector3::new(reach * angle.cos(), reach * angle.sin(), 320.0 + 6.0 * f64::from(i % 7));
        Pose::looking_at(middle + from, middle, Vector3::y(), 0.7 * f64::from(i)).unwrap()
    };
    Scene { poses: (0..24).map(station).collect(), ..board(lens()) }
}

fn calibrated<T>(scene: &Scene, settings: &Settings, read: impl Fn(&Calibration<'_>) -> T) -> Result<T, String> {
    let prepared = scene.prepared(settings).map_err(|error| error.to_string())?;
    calibrate(&prepared, &[], read).map_err(|error| error.to_string())
}

/// What is stated is the root mean square of the distances from the truth that trials have.
#[test]
fn the_standard_deviation_over_the_frame_is_that_of_trials() {
    for scene in [|| board(lens()), around] {
        let squares: Vec<[f64; 3]> = (0..200_u64)
            .into_par_iter()
            .map(|seed| {
                let known = |calibration: &Calibration<'_>| {
                    let options = DifferenceOptions { columns: 31, ..DifferenceOptions::default() };
                    let apart = difference(calibration.camera(0), &lens(), &options).unwrap().spread.rms_px;
                    let known = calibration.over_frame[0].unwrap();
                    assert!(known.is_within() && calibration.doubts().is_empty(), "{known:?} {:?}", calibration.doubts());
                    [apart, known.formal_px, known.by_images_px.unwrap()].map(|px| px * px)
                };
                calibrated(&noisy(scene(), seed), &settings("opencv5"), known).unwrap()
            })
            .collect();
        let [apart, formal, by_images] = [0, 1, 2].map(|k| (squares.iter().map(|squares| squares[k]).sum::<f64>() / 200.0).sqrt());
        assert!((apart / formal - 1.0).abs() < 0.1, "{apart} {formal}");
        // Also from seven images, each of which tells much: the jackknife's would be three times as large.
        assert!((by_images / apart - 1.0).abs() < 0.25, "{apart} {by_images}");
    }
}

#[test]
fn a_camera_that_is_hardly_known_is_in_doubt() {
    let doubts = |limit_px: Option<f64>| {
        let read = |calibration: &Calibration<'_>| {
            (calibration.over_frame[0].unwrap(), calibration.doubts().into_iter().map(|doubt| doubt.words).collect::<Vec<_>>())
        };
        calibrated(&noisy(inclined(0.03), 1), &Settings { limit_px, ..settings("opencv5") }, read).unwrap()
    };
    let (known, usual) = doubts(None);
    assert!(known.px() > known.limit_px && known.limit_px == 5.0, "{known:?}");
    assert!(
        usual.iter().any(|doubt| doubt.contains("px over the frame (standard deviation, RMS), beyond the limit of 5.00 px")),
        "{usual:?}"
    );
    let (known, stated) = doubts(Some(1000.0));
    assert!(known.is_within() && stated.iter().all(|doubt| !doubt.contains("is known to")), "{known:?} {stated:?}");
}

/// Whatever the model: the pivots of some are beyond rounding.
#[test]
fn views_straight_onto_a_plane_determine_no_camera() {
    let mut frontal = inclined(0.0);
    for (i, pose) in frontal.poses.iter_mut().enumerate() {
        let at = Point3::new(60.0 + 25.0 * i as f64, 40.0 + 14.0 * i as f64, 0.0);
        let from = at + Vector3::z() * (400.0 + 40.0 * (i % 3) as f64);
        *pose = Pose::looking_at(from, at, Vector3::y(), 0.02 * i as f64).unwrap();
    }
    for model in ["opencv4", "opencv5", "opencv8", "photogrammetric", "metashape", "opencv-fisheye", "eucm", "double-sphere"] {
        for seed in 0..4 {
            let read = |calibration: &Calibration<'_>| calibration.over_frame[0];
            match calibrated(&noisy(Scene { poses: frontal.poses.clone(), ..inclined(0.0) }, seed), &settings(model), read) {
                Err(error) => assert!(error.contains("not determined") || error.contains("converge"), "{model}: {error}"),
                Ok(known) => panic!("{model}: {known:?}"),
            }
        }
    }
}

#[test]
fn the_usual_limit_is_one_percent_of_the_longer_side_and_five_pixels_at_most() {
    for (width, height, expected) in [(320, 240, 3.2), (240, 320, 3.2), (500, 400, 5.0), (6000, 4000, 5.0)] {
        assert_eq!(usual_limit_px(ImageSize { width, height }), expected);
    }
    assert_eq!(usual_limit_px(SIZE), 5.0);
}
