//! Inputs that are something else than they say, and whether what they are is named.

use calibench_calibrate::{Settings, Suspected, calibrate, prepare, suspected};
use calibench_exchange::{ControlRow, Points};
use calibench_model::camera::{Camera, ImageSize, OpenCvFisheye};
use calibench_model::{PixelPoint, Pose};
use nalgebra::{Point3, Vector3};
use rayon::prelude::*;

use crate::network::{SIZE, Scene, board, lens, optics, settings, wall};

/// Draws of each.
const DRAWS: u64 = 20;

fn noisy(scene: Scene, seed: u64) -> Scene {
    Scene { sigma: 0.1, seed: 1 + 1_000_003 * seed, ..scene }
}

/// What is suspected of inputs whose calibration is in doubt or fails, as `calibrate` asks; nothing where it is not.
fn suspects(points: &Points, control: &[ControlRow], settings: &Settings) -> Vec<Suspected> {
    let of_error = |error| suspected(points, control, settings, Err(&error));
    let prepared = match prepare(points.clone(), control, settings) {
        Ok(prepared) => prepared,
        Err(error) => return of_error(error),
    };
    let found = calibrate(&prepared, &[], |calibration| {
        if calibration.doubts().is_empty() { Vec::new() } else { suspected(points, control, settings, Ok(calibration)) }
    });
    found.unwrap_or_else(of_error)
}

fn moved(points: &Points, to: impl Fn(PixelPoint) -> PixelPoint) -> Points {
    let mut moved = points.clone();
    moved.move_each(to);
    moved
}

fn renamed(points: &Points, to: impl Fn(&str) -> String) -> Points {
    let mut renamed = Points::with_capacity(points.len());
    points.rows().enumerate().for_each(|(row, point)| renamed.push(point.image, &to(point.target), points.start(row)));
    renamed
}

/// A board that fills the frame and more.
fn full_frame() -> Scene {
    let targets = (0..187).map(|i| Point3::new(30.0 * f64::from(i % 17) - 120.0, 30.0 * f64::from(i / 17) - 60.0, 0.0)).collect();
    Scene { targets, control: 187, ..board(lens()) }
}

/// In how many of the draws that kind is named first.
fn named(kind: &str, planted: impl Fn(u64) -> (Points, Vec<ControlRow>, Settings) + Sync) {
    let found: Vec<Vec<Suspected>> = (0..DRAWS)
        .into_par_iter()
        .map(|seed| {
            let (points, control, settings) = planted(seed);
            suspects(&points, &control, &settings)
        })
        .collect();
    let first = found.iter().filter(|found| found.first().is_some_and(|first| first.kind == kind)).count();
    assert!(
        first as u64 * 20 >= DRAWS * 19,
        "{kind}: {first} of {DRAWS}; {:?}",
        found.iter().find(|found| found.first().is_none_or(|first| first.kind != kind))
    );
}

/// Tags of 60, gaps of `gap`, four by three, each with its four corners.
fn tags(gap: f64) -> Vec<Point3<f64>> {
    let along = |k: usize| (k / 2) as f64 * (60.0 + gap) + (k % 2) as f64 * 60.0;
    (0..48).map(|k| Point3::new(along(k % 8), along(k / 8), 0.0)).collect()
}

#[test]
fn a_fisheye_taken_for_a_pinhole_is_named() {
    let k = [0.02, -0.01, 0.0, 0.0];
    let truth: Camera = OpenCvFisheye { size: SIZE, fx: 520.0, fy: 520.0, cx: 790.0, cy: 610.0, skew: 0.0, k }.into();
    let middle = Point3::new(120.0, 90.0, 0.0);
    let station = |i: i32| {
        let (sin, cos) = (0.9 * f64::from(i)).sin_cos();
        let at = middle + Vector3::new(70.0 * cos, 60.0 * sin, 90.0 + 6.0 * f64::from(i));
        Pose::looking_at(at, middle + Vector3::new(30.0 * sin, 20.0 * cos, 0.0), Vector3::y(), 0.7 * f64::from(i)).unwrap()
    };
    named("lens", |seed| {
        let scene = noisy(Scene { poses: (0..8).map(station).collect(), ..board(truth) }, seed);
        (scene.points(), scene.known(), settings("opencv5"))
    });
}

#[test]
fn columns_and_rows_that_are_exchanged_are_named() {
    named("raster", |seed| {
        let scene = noisy(board(lens()), seed);
        let turned = |(k, row): (usize, ControlRow)| ControlRow { position: [30.0 * (k % 7) as f64, 30.0 * (k / 7) as f64, 0.0], ..row };
        (scene.points(), scene.known().into_iter().enumerate().map(turned).collect(), settings("opencv5"))
    });
}

#[test]
fn image_points_that_are_mirrored_are_named() {
    named("axes", |seed| {
        let scene = noisy(wall(lens()), seed);
        (moved(&scene.points(), |at| PixelPoint::new(at.y, at.x)), scene.known(), settings("opencv5"))
    });
    named("up", |seed| {
        let scene = noisy(wall(lens()), seed);
        let upwards = |at: PixelPoint| PixelPoint::new(at.x, f64::from(SIZE.height) - 1.0 - at.y);
        (moved(&scene.points(), upwards), scene.known(), settings("opencv5"))
    });
}

#[test]
fn another_spacing_and_a_stretch_are_named_with_their_estimates() {
    let of = |targets: Vec<Point3<f64>>, seed: u64| {
        let count = targets.len();
        noisy(Scene { targets, control: count, ..board(lens()) }, seed)
    };
    named("spacing", |seed| {
        let stated = of(tags(15.0), seed).known();
        (of(tags(18.0), seed).points(), stated, settings("opencv5"))
    });
    named("stretch", |seed| {
        let stated = noisy(board(lens()), seed);
        let stretched = stated.targets.iter().map(|at| Point3::new(1.03 * at.x, at.y, 0.0)).collect();
        (Scene { targets: stretched, ..noisy(board(lens()), seed) }.points(), stated.known(), settings("opencv5"))
    });
    let scene = of(tags(18.0), 3);
    let found = suspects(&scene.points(), &of(tags(15.0), 3).known(), &settings("opencv5"));
    assert!(found[0].what.contains("is 0.300 of a tag's side, and 0.250 is stated"), "{found:?}");
    assert!(found[0].rms_px.unwrap() < 0.2 && found[0].words().contains("px RMS then"), "{found:?}");
}

#[test]
fn images_of_another_size_are_named() {
    for stated in [ImageSize { width: 3200, height: 2400 }, ImageSize { width: 800, height: 600 }] {
        named("size", |seed| {
            let scene = noisy(board(lens()), seed);
            let mut optics = optics("opencv5");
            optics.size = stated;
            (scene.points(), scene.known(), Settings::new(vec![optics]))
        });
    }
}

#[test]
fn a_crop_and_pixels_counted_from_elsewhere_are_named_where_the_frame_tells() {
    let cropped = |seed: u64, stated: ImageSize| {
        let mut optics = optics("opencv5");
        optics.size = stated;
        (noisy(full_frame(), seed), Settings::new(vec![optics]))
    };
    named("size", |seed| {
        let (scene, settings) = cropped(seed, ImageSize { width: 2000, height: 1500 });
        (scene.points(), scene.known(), settings)
    });
    let (scene, larger) = cropped(1, ImageSize { width: 2000, height: 1500 });
    let found = suspects(&scene.points(), &scene.known(), &larger);
    assert!(found[0].what.contains("of about 16") && found[0].what.contains("2000 x 1500 px is stated"), "{found:?}");
    // Points between 0 and the width are those of the outer corner, points between a half and a half more those from 1.
    let targets = (0..1536).map(|i| Point3::new(10.0 * f64::from(i % 48) - 110.0, 10.0 * f64::from(i / 48) - 60.0, 0.0)).collect();
    let dense = Scene { targets, control: 1536, ..full_frame() };
    let mut optics = optics("opencv5");
    optics.size = ImageSize { width: SIZE.width - 1, height: SIZE.height - 1 };
    for (by, word) in [(0.0, "--origin corner"), (0.5, "subtract 1")] {
        let points = moved(&dense.points(), |at| PixelPoint::new(at.x + by, at.y + by));
        let found = suspects(&points, &dense.known(), &Settings::new(vec![optics.clone()]));
        assert!(found.len() == 1 && found[0].kind == "origin" && found[0].what.contains(word), "{by}: {found:?}");
    }
}

#[test]
fn x_and_y_of_a_board_that_are_exchanged_are_named_by_the_principal_point() {
    named("axes", |seed| {
        let scene = noisy(board(lens()), seed);
        (moved(&scene.points(), |at| PixelPoint::new(at.y, at.x)), scene.known(), settings("opencv5"))
    });
}

#[test]
fn a_board_of_another_scale_than_the_control_around_it_is_named() {
    let named_rows = |scene: &Scene, side: f64| {
        let row = |(k, row): (usize, ControlRow)| {
            if k < 48 {
                return row;
            }
            let k = k - 48;
            let at = [600.0 + side * (k % 6) as f64, 700.0 + side * (k / 6) as f64, 250.0];
            ControlRow { target: format!("r{}c{}", k / 6 + 1, k % 6 + 1), position: at, ..row }
        };
        scene.known().into_iter().enumerate().map(row).collect::<Vec<_>>()
    };
    let scene = |seed: u64| {
        let wall = wall(lens());
        let board = (0..24).map(|k| Point3::new(600.0 + 97.0 * f64::from(k % 6), 700.0 + 97.0 * f64::from(k / 6), 250.0));
        let targets = wall.targets.iter().copied().chain(board).collect();
        noisy(Scene { targets, control: 72, ..wall }, seed)
    };
    let points = |seed: u64| {
        let named = |name: &str| {
            let k: usize = name[1..].parse().unwrap();
            if k < 48 { name.to_owned() } else { format!("r{}c{}", (k - 48) / 6 + 1, (k - 48) % 6 + 1) }
        };
        renamed(&scene(seed).points(), named)
    };
    named("scale", |seed| (points(seed), named_rows(&scene(seed), 100.0), settings("opencv5")));
    let found = suspects(&points(3), &named_rows(&scene(3), 100.0), &settings("opencv5"));
    assert!(found[0].what.contains("0.970 times as large") && found[0].what.contains("97.0 from one corner"), "{found:?}");
    assert!(suspects(&points(3), &named_rows(&scene(3), 97.0), &settings("opencv5")).is_empty());
}

#[test]
fn of_what_is_as_it_says_nothing_is_suspected() {
    let found: Vec<Vec<Suspected>> = (0..100_u64)
        .into_par_iter()
        .map(|seed| {
            let scene = noisy(if seed % 2 == 0 { board(lens()) } else { wall(lens()) }, seed);
            suspects(&scene.points(), &scene.known(), &settings("opencv5"))
        })
        .collect();
    let some: Vec<&Vec<Suspected>> = found.iter().filter(|found| !found.is_empty()).collect();
    assert!(some.len() <= 1, "{some:?}");
}
