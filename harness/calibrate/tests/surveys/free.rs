//! Networks without coordinates, from image points and distances alone.

use calibench_calibrate::{CalibrationError, GrossErrors, Optics, Settings, prepare_free};
use calibench_model::camera::{Camera, CameraModel, OpenCv};
use calibench_model::{MeasuredDistance, Pose};
use nalgebra::{Point3, Vector3};

use crate::network::{SIZE, Scene};

/// Numbers from 0 to 1 that are scattered and the same everywhere.
fn scattered(seed: u64, k: usize) -> f64 {
    ((seed as f64 + 1.0) * 0.754_877_666 + (k as f64 + 1.0) * 0.569_840_291 + ((k * k) as f64) * 0.321).fract()
}

/// Stations around an object of some shape, by a lens of some focal length: what a user may have.
fn scene(seed: u64) -> Scene {
    let number = |k: usize| scattered(seed, k);
    let focal = 1600.0 * [0.65, 0.8, 1.0, 1.3, 1.7, 2.3][seed as usize % 6];
    let mut distortion = [0.0; 14];
    distortion[..3].copy_from_slice(&[-0.12 + 0.1 * number(0), 0.04, 0.0]);
    let camera: Camera = OpenCv { size: SIZE, fx: focal, fy: focal, cx: 820.0, cy: 585.0, distortion, coefficients: 5 }.into();
    let depth = [500.0, 900.0, 150.0][seed as usize % 3];
    let target =
        |i: usize| Point3::new(1600.0 * (number(3 * i + 7) - 0.5), 1200.0 * (number(3 * i + 8) - 0.5), depth * (number(3 * i + 9) - 0.5));
    let away = 2200.0 * focal / 1600.0;
    let count = 8 + seed as usize % 5;
    let station = |i: usize| {
        let (turn, rise) = (std::f64::consts::TAU * i as f64 / count as f64, 0.5 + 0.4 * number(200 + i));
        let centre = Point3::new(away * 0.7 * turn.cos(), away * 0.7 * turn.sin(), away * (0.4 + rise));
        let look = Point3::new(120.0 * number(300 + i), 120.0 * number(400 + i), 0.0);
        Pose::looking_at(centre, look, Vector3::y(), 1.57 * i as f64 + 0.2 * number(500 + i)).unwrap()
    };
    let targets = (0..40).map(target).collect();
    Scene { camera, poses: (0..count).map(station).collect(), targets, control: 0, sigma: 0.2, seed: 50 + seed }
}

fn settings(scene: &Scene) -> Settings {
    let bar = |a: usize, b: usize| MeasuredDistance {
        targets: [a, b].map(|i| format!("t{i}")),
        value: (scene.targets[a] - scene.targets[b]).norm(),
        sigma: 0.05,
    };
    Settings {
        distances: vec![bar(0, 1), bar(2, 3)],
        lengths: (4..14).map(|i| [format!("t{i}"), format!("t{}", i + 20)]).collect(),
        sigma_px: Some(scene.sigma),
        gross: GrossErrors::Kept,
        ..Settings::new(vec![Optics { model: Some("opencv5".into()), ..Optics::new(SIZE) }])
    }
}

/// Whatever shape, focal length and way around: residuals are those of the noise, and lengths lie where their deviations say.
#[test]
fn networks_come_from_their_images_alone() {
    let (mut squares, mut count, mut chi, mut redundancy) = (0.0, 0.0, 0.0, 0.0);
    for seed in 0..24 {
        let scene = scene(seed);
        let prepared = prepare_free(scene.points(), &[], &settings(&scene)).unwrap_or_else(|error| panic!("{seed}: {error}"));
        let found = prepared.adjust().unwrap_or_else(|error| panic!("{seed}: {error}"));
        let sigma0 = found.solution.sigma0().unwrap();
        assert!((sigma0 - 1.0).abs() < 0.2, "{seed}: sigma0 {sigma0}");
        (chi, redundancy) = (chi + found.solution.cost(), redundancy + found.solution.counts().redundancy() as f64);
        for (i, length) in found.lengths().unwrap().iter().skip(2).enumerate() {
            let truth = (scene.targets[4 + i] - scene.targets[24 + i]).norm();
            // Those of the estimated variance factor.
            let off = (length.value - truth) * sigma0 / length.sigma;
            assert!(off.abs() < 5.0, "{seed}: {length:?} is {truth}");
            (squares, count) = (squares + off * off, count + 1.0);
        }
        let focal = found.camera(0).parameters()[0].value;
        let truth = scene.camera.parameters()[0].value;
        assert!((focal / truth - 1.0).abs() < 0.01, "{seed}: {focal} for {truth}");
    }
    assert!((0.97..1.03).contains(&(chi / redundancy)), "{}", chi / redundancy);
    // Ten lengths of a network belong together: as few as 24 numbers.
    let mean: f64 = squares / count;
    assert!((0.6..1.5).contains(&mean), "{mean}");
}

#[test]
fn the_same_points_give_the_same_bits_on_any_number_of_threads() {
    let scene = scene(3);
    let on = |threads: usize| {
        let pool = rayon_pool(threads);
        pool.install(|| prepare_free(scene.points(), &[], &settings(&scene)).unwrap().network.points)
    };
    assert_eq!(on(1), on(3));
}

fn rayon_pool(threads: usize) -> rayon::ThreadPool {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap()
}

#[test]
fn images_that_nothing_joins_are_named() {
    let (near, mut far) = (scene(0), scene(1));
    far.poses.truncate(2);
    let mut points = near.points();
    let apart = far.points();
    let rows = apart.rows().map(|row| (format!("apart_{}", row.image), format!("other_{}", row.target), row.start.position));
    let mut text = String::from("image,target,x,y\n");
    for row in points.rows() {
        text += &format!("{},{},{},{}\n", row.image, row.target, row.start.position.x, row.start.position.y);
    }
    rows.for_each(|(image, target, at)| text += &format!("{image},{target},{},{}\n", at.x, at.y));
    points = calibench_exchange::points::parse_points("p.csv", text.as_bytes()).unwrap().points;
    let error = prepare_free(points, &[], &settings(&near)).unwrap_err();
    assert!(matches!(error, CalibrationError::NoModel { .. }), "{error}");
    let error = error.to_string();
    assert!(error.contains("2 of 10 images do not hang together with the others: apart_image_0.png, apart_image_1.png"), "{error}");
}
