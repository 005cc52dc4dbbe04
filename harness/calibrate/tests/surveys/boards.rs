//! Boards whose corners are measured, and boards of which something is stated.

use calibench_calibrate::{
    AdjustedLength, BoardScale, BoardShape, Calibration, CalibrationError, MeasuredBoard, Prepared, Settings, StatedBoard, Subject,
    calibrate, prepare, with_corners,
};
use calibench_model::camera::CameraModel;
use calibench_model::{MeasuredDistance, Pose};
use nalgebra::{DMatrix, DVector, Matrix3, Point3, Vector3};
use rayon::prelude::*;

use crate::network::{Scene, board, lens, settings};

/// The board of 9 x 7 corners, 30 mm apart, in `count` photographs, tilted and turned, with corners moved by `moved`, mm.
fn photographed(count: usize, moved: impl Fn(usize) -> Vector3<f64>, sigma: f64, seed: u64) -> Scene {
    let scene = board(lens());
    let middle = Point3::new(120.0, 90.0, 0.0);
    let station = |i: usize| {
        let (turn, out) = (2.4 * i as f64, 60.0 + 190.0 * ((i * 7 % 10) as f64 / 10.0));
        let centre = middle + Vector3::new(out * turn.cos(), out * turn.sin(), 330.0 + 12.0 * (i % 5) as f64);
        Pose::looking_at(centre, middle, Vector3::y(), 0.8 * i as f64).unwrap()
    };
    let targets = scene.targets.iter().enumerate().map(|(k, at)| at + moved(k)).collect();
    Scene { poses: (0..count).map(station).collect(), targets, sigma, seed: 1 + 1_000_003 * seed, ..scene }
}

fn asked(stated: StatedBoard) -> Settings {
    Settings { board: stated, shape: BoardShape::Tested, ..settings("opencv4") }
}

const MEASURED: StatedBoard = StatedBoard { scale: None, noise: None, is_measured: true };

fn prepared(scene: &Scene, settings: &Settings) -> Result<Prepared, CalibrationError> {
    prepare(scene.points(), &board(lens()).known(), settings)
}

fn measured(scene: &Scene) -> MeasuredBoard {
    let prepared = prepared(scene, &asked(MEASURED)).unwrap();
    let mut calibration = prepared.adjust().unwrap();
    calibration.measure_board();
    calibration.measured_board.unwrap().unwrap()
}

/// Numbers about 0 with a standard deviation of 1, each by its place and a seed.
fn chance(k: usize, seed: u64) -> f64 {
    let mut state = (k as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ seed.wrapping_mul(0xD1B5_4A32_D192_ED03) ^ 0x1234_5678;
    let mut uniform = || {
        state ^= state >> 30;
        state = state.wrapping_mul(0xBF58_476D_1CE4_E5B9);
        state ^= state >> 27;
        state = state.wrapping_mul(0x94D0_49BB_1331_11EB).wrapping_add(0x9E37_79B9);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    (0..12).map(|_| uniform()).sum::<f64>() - 6.0
}

/// Moves in all three directions without what a datum of all corners takes out: shift, turn and scale.
fn moves(size: f64, seed: u64) -> Vec<Vector3<f64>> {
    let corners = board(lens()).targets;
    let drawn = DVector::from_iterator(189, (0..189).map(|k| size * chance(k, seed)));
    let of = |k: usize| {
        let (point, axis) = (corners[k / 3] - Point3::new(120.0, 90.0, 0.0), k % 3);
        let unit = |i: usize| if i == axis { 1.0 } else { 0.0 };
        let turned = [Vector3::x(), Vector3::y(), Vector3::z()].map(|about| about.cross(&point)[axis]);
        [unit(0), unit(1), unit(2), turned[0], turned[1], turned[2], point[axis]]
    };
    let datum = DMatrix::from_fn(189, 7, |k, i| of(k)[i]);
    let normal = (datum.transpose() * &datum).try_inverse().unwrap();
    let rest = &drawn - &datum * normal * datum.transpose() * &drawn;
    rest.as_slice().chunks(3).map(|moved| Vector3::new(moved[0], moved[1], moved[2])).collect()
}

/// In the datum of all corners what comes out differs from the truth as its covariances say: chi squared of each corner has three degrees of freedom.
#[test]
fn corners_come_out_within_their_covariances() {
    let trials: Vec<(f64, MeasuredBoard, Vec<Vector3<f64>>)> = (0..20_u64)
        .into_par_iter()
        .map(|seed| {
            let truth = moves(0.08, seed);
            let found = measured(&photographed(12, |k| truth[k], 0.1, seed));
            let off = |(k, corner): (usize, &calibench_calibrate::MeasuredCorner)| {
                let off = corner.position - corner.nominal - truth[k];
                (off.transpose() * corner.covariance.try_inverse().unwrap() * off)[0]
            };
            (found.corners.iter().enumerate().map(off).sum::<f64>() / found.corners.len() as f64, found, truth)
        })
        .collect();
    let mean = trials.iter().map(|(chi, ..)| chi).sum::<f64>() / 20.0;
    // Enlarged by what halves say where that is above 1, a few per cent.
    assert!((2.3..3.4).contains(&mean), "{mean}");
    for (_, found, truth) in &trials {
        let rms = |of: fn(&Vector3<f64>) -> f64| (truth.iter().map(of).sum::<f64>() / 63.0).sqrt();
        assert!(found.is_told() && found.doubts().is_empty(), "{:?}", found.doubts());
        let repeats = found.repeats.as_ref().unwrap();
        let in_plane = rms(|moved| moved.xy().norm_squared());
        assert!((repeats.in_plane.common / in_plane - 1.0).abs() < 0.1, "{repeats:?} for {in_plane}");
        assert!(repeats.in_plane.correlation > 0.8 && (0.8..1.25).contains(&repeats.sigmas), "{repeats:?}");
        let expected = 2.0 * repeats.in_plane.correlation / (1.0 + repeats.in_plane.correlation);
        assert!((repeats.in_plane.of_whole - expected).abs() < 1e-12);
        let printer = repeats.printer.unwrap();
        assert!((printer.by_chance - 15.0 / 63.0).abs() < 1e-12 && printer.share < 0.6, "{printer:?}");
    }
}

/// How many of `count` perfect boards are told from perfect ones.
fn alarms(count: u64, photographs: usize) -> usize {
    (0..count)
        .into_par_iter()
        .filter(|seed| measured(&photographed(photographs, |_| Vector3::zeros(), 0.15, 5000 + seed)).is_told())
        .count()
}

/// In at most one of a hundred: one of 300 is an upper bound (95 %) of 1.6 %.
#[test]
fn a_perfect_board_is_not_told_from_one() {
    let alarms = alarms(300, 8);
    assert!(alarms <= 1, "{alarms} of 300");
}

#[test]
#[ignore = "minutes: the same three thousand times, and of six photographs"]
fn a_perfect_board_is_not_told_from_one_of_many() {
    for photographs in [6, 8, 16] {
        let alarms = alarms(3000, photographs);
        assert!(alarms <= 15, "{alarms} of 3000 with {photographs} photographs");
    }
}

#[test]
fn rows_and_columns_that_a_printer_moves_are_told() {
    let feed = |k: usize| Vector3::new(0.06 * chance(k % 9, 1), 0.06 * chance(k / 9, 2), 0.0);
    let printer = measured(&photographed(12, feed, 0.05, 1)).repeats.unwrap().printer.unwrap();
    assert!(printer.share > 0.95, "{printer:?}");
}

#[test]
fn a_bend_alone_leaves_nothing_beyond_it() {
    let bend = |k: usize| {
        let (u, v) = ((k % 9) as f64 / 4.0 - 1.0, (k / 9) as f64 / 3.0 - 1.0);
        Vector3::z() * (0.8 * (1.0 - u * u) - 0.3 * (1.0 - v * v) + 0.1 * u * v)
    };
    let found = measured(&photographed(12, bend, 0.05, 3));
    let (bend, beyond) = (found.bend.unwrap(), found.beyond_bend.unwrap());
    assert!(bend.is_significant() && found.test.p < 1e-6 && beyond.p > 1e-3, "{found:?}");
    assert!(found.test.more - beyond.more == 3 && found.test.more == 3 * 63 - 7, "{:?} {:?}", found.test, beyond);
}

/// The same photographs are less wrong with the corners that others measured, and their file is one of control.
#[test]
fn a_board_that_was_measured_serves_another_camera() {
    let truth = moves(0.1, 9);
    let corners = measured(&photographed(14, |k| truth[k], 0.05, 1)).all(&board(lens()).known(), &MEASURED);
    let later = photographed(9, |k| truth[k], 0.05, 77);
    let known = board(lens()).known();
    let with = with_corners(&known, &corners).unwrap();
    let rms = |control: &[calibench_model::ControlRow]| {
        let prepared = prepare(later.points(), control, &settings("opencv4")).unwrap();
        prepared.adjust().unwrap().rms_px()
    };
    assert!(rms(&with) < 0.4 * rms(&known), "{} {}", rms(&with), rms(&known));
    assert!(corners.iter().all(|corner| corner.photographs.is_some_and(|count| count > 9) && corner.nominal.is_some()));
}

#[test]
fn few_photographs_are_refused_or_in_doubt() {
    let truth = moves(0.08, 4);
    let of = |count: usize| photographed(count, |k| truth[k], 0.1, 1);
    let seven = of(7);
    let prepared = prepared(&seven, &asked(MEASURED)).unwrap();
    calibrate(&prepared, &[], |calibration| {
        let doubt = calibration.doubts().into_iter().find(|doubt| doubt.subject == Subject::Board).unwrap();
        assert!(doubt.words.contains("7 photographs hold the corners of the board: 8 or more"), "{doubt}");
    })
    .unwrap();
    let five = measured(&of(5));
    assert!(five.repeats.as_ref().is_err_and(|why| why.contains("5 photographs")) && !five.is_told());
    assert!(five.doubts().iter().any(|doubt| doubt.contains("cannot be told")), "{:?}", five.doubts());
    let three = of(3);
    let prepared = super::boards::prepared(&three, &asked(MEASURED)).unwrap();
    let mut calibration = prepared.adjust().unwrap();
    calibration.measure_board();
    assert!(calibration.measured_board.unwrap().unwrap_err().contains("3 photographs; expected 4"));
}

#[test]
fn what_does_not_go_with_a_measured_board_is_refused() {
    let scene = photographed(8, |_| Vector3::zeros(), 0.1, 1);
    let refused = |settings: Settings| prepared(&scene, &settings).unwrap_err().to_string();
    assert!(refused(Settings { shape: BoardShape::Bent, ..asked(MEASURED) }).contains("every corner is free"));
    let distances = vec![MeasuredDistance { targets: ["t0".into(), "t8".into()], value: 240.0, sigma: 0.01 }];
    assert!(refused(Settings { distances: distances.clone(), ..asked(MEASURED) }).contains("cannot be measured"));
    let scale = Some(BoardScale { value: 1.0, sigma: 1e-3 });
    let stated = StatedBoard { scale, ..StatedBoard::default() };
    assert!(refused(Settings { distances, ..asked(stated) }).contains("measured distances say the scale, too"));
}

fn adjusted<T>(scene: &Scene, settings: &Settings, read: impl Fn(&Calibration<'_>) -> T) -> T {
    let prepared = prepared(scene, settings).unwrap();
    read(&prepared.adjust().unwrap())
}

/// The camera's parameters, their covariance, stations with theirs, a length, and what is taken as exact.
type Told = (Vec<f64>, DMatrix<f64>, Vec<(Point3<f64>, Matrix3<f64>)>, AdjustedLength, Vec<String>);

fn told(calibration: &Calibration<'_>) -> Told {
    let poses = calibration.solution.poses().iter().zip(&calibration.covariances.poses);
    let stations = poses.map(|(pose, block)| (pose.centre, block.fixed_view::<3, 3>(0, 0).into_owned())).collect();
    let parameters = calibration.camera(0).parameters().iter().map(|parameter| parameter.value).collect();
    let length = calibration.lengths().unwrap()[0].clone();
    (parameters, calibration.covariances.interior.clone(), stations, length, calibration.taken_as_exact())
}

/// All lengths are the scale's: stations go with it, the camera does not, and their covariances have its part to first order.
#[test]
fn a_scale_moves_stations_and_lengths_and_no_camera() {
    let scene = photographed(8, |_| Vector3::zeros(), 0.1, 6);
    let (scale, sigma) = (1.01, 2e-3);
    let lengths = vec![["t0".to_owned(), "t8".to_owned()]];
    let with = |scale| Settings { lengths: lengths.clone(), ..asked(StatedBoard { scale, ..StatedBoard::default() }) };
    let plain = adjusted(&scene, &with(None), told);
    let scaled = adjusted(&scene, &with(Some(BoardScale { value: scale, sigma })), told);
    assert!(plain.0.iter().zip(&scaled.0).all(|(a, b)| (a - b).abs() < 1e-6 * (1.0 + a.abs())), "{:?} {:?}", plain.0, scaled.0);
    assert!((plain.1.clone() - &scaled.1).abs().max() < 1e-6 * plain.1.abs().max());
    let share = sigma / scale;
    for ((a, before), (b, after)) in plain.2.iter().zip(&scaled.2) {
        assert!((a.coords * scale - b.coords).norm() < 1e-6 * b.coords.norm());
        let expected = before * scale * scale + b.coords * b.coords.transpose() * share * share;
        assert!((expected - after).norm() < 1e-6 * after.norm(), "{expected} {after}");
    }
    assert!((scaled.3.value - 240.0 * scale).abs() < 1e-9 && (scaled.3.sigma - 240.0 * sigma).abs() < 1e-9, "{:?}", scaled.3);
    assert!(plain.4[0].contains("--board-scale") && !scaled.4.iter().any(|words| words.contains("--board-scale")));
}

#[test]
fn what_nobody_stated_is_taken_as_exact() {
    let scene = photographed(8, |_| Vector3::zeros(), 0.1, 6);
    #[expect(clippy::redundant_closure_for_method_calls, reason = "of any lifetime")]
    let of = |settings: &Settings| adjusted(&scene, settings, |calibration| calibration.taken_as_exact());
    let flat = of(&settings("opencv4"));
    assert_eq!(flat.len(), 3, "{flat:?}");
    assert!(flat[1].contains("flatness") && flat[2].contains("places of its points"));
    assert_eq!(of(&asked(StatedBoard::default())).len(), 2, "a bend was tested");
    assert_eq!(of(&asked(MEASURED)).len(), 1, "its scale alone");
    let scale = Some(BoardScale { value: 1.0, sigma: 1e-3 });
    assert_eq!(of(&asked(StatedBoard { scale, noise: Some(0.05), is_measured: false })), Vec::<String>::new());
    let noise = StatedBoard { noise: Some(0.05), ..StatedBoard::default() };
    assert_eq!(of(&asked(noise)).len(), 1);
}
