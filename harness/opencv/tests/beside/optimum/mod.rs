//! Our adjustment and OpenCV's reach one optimum on the same corners, each from its own start values.

mod theirs;

use std::path::Path;

use calibench_calibrate::{Optics, Settings, prepare};
use calibench_images::read_photo;
use calibench_measure::{Board, BoardDetector};
use calibench_model::camera::{CameraModel, ImageSize};
use calibench_model::{ControlRow, PixelPoint, Points, Start};

const BOARD: Board = Board { columns: 9, rows: 6 };
const SIZE: ImageSize = ImageSize { width: 640, height: 480 };
const SIDE: f64 = 25.0;

fn control() -> Vec<ControlRow> {
    let corner = |i: usize| [(i % BOARD.columns) as f64 * SIDE, -((i / BOARD.columns) as f64 * SIDE), 0.0];
    (0..BOARD.corners()).map(|i| ControlRow::new(BOARD.target(i), corner(i))).collect()
}

/// The corners that OpenCV finds in the photographs of a folder; single precision, as it gives them.
fn corners(folder: &Path) -> Vec<Vec<PixelPoint>> {
    let mut photos: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    photos.retain(|path| path.extension().is_some_and(|ending| ending == "jpg"));
    photos.sort();
    let detect = |path: &std::path::PathBuf| calibench_opencv::detector().detect(&read_photo(path).unwrap().image, BOARD);
    photos.iter().filter_map(detect).collect()
}

fn same_optimum(views: &[Vec<PixelPoint>]) {
    let mut points = Points::default();
    for (image, view) in views.iter().enumerate() {
        view.iter().enumerate().for_each(|(index, at)| points.push(&image.to_string(), &BOARD.target(index), Start::at(*at)));
    }
    let control = control();
    let optics = Optics { model: Some("opencv5".into()), ..Optics::new(SIZE) };
    let settings = Settings { sigma_px: Some(1.0), ..Settings::new(vec![optics]) };
    let prepared = prepare(points, &control, &settings).unwrap();
    let ours = prepared.adjust().unwrap();
    let plane: Vec<[f64; 2]> = control.iter().map(|row| [row.position[0], row.position[1]]).collect();
    let board = theirs::Board {
        size: (SIZE.width as i32, SIZE.height as i32),
        objects: vec![plane; views.len()],
        images: views.iter().map(|view| view.iter().map(|at| [at.x, at.y]).collect()).collect(),
    };
    let theirs = theirs::calibrate(&board, 1000, 1e-16).unwrap();
    assert!((theirs.rms / ours.rms_px() - 1.0).abs() < 1e-9, "{} {}", theirs.rms, ours.rms_px());
    let (names, covariance) = ours.covariances.of_camera(0);
    let parameters = ours.camera(0).parameters();
    assert_eq!(names, parameters.iter().map(|p| p.name).collect::<Vec<_>>());
    // OpenCV up to 4.6 divides the sum of squares by the number of points less unknowns, not by that of coordinates.
    let (points, unknowns) = (prepared.survey.sights() as f64, ours.solution.counts().unknowns as f64);
    let divisor = ((2.0 * points - unknowns) / (points - unknowns)).sqrt();
    let ratio = theirs.sigmas[0] / covariance[(0, 0)].sqrt();
    let expected = if (ratio - 1.0).abs() < 0.01 { 1.0 } else { divisor };
    for (i, parameter) in parameters.iter().enumerate() {
        let relative = theirs.parameters[i] / parameter.value - 1.0;
        assert!(relative.abs() < 1e-6, "{}: {} and {}", parameter.name, parameter.value, theirs.parameters[i]);
        let ratio = theirs.sigmas[i] / covariance[(i, i)].sqrt();
        assert!((ratio / expected - 1.0).abs() < 1e-5, "{}: {ratio}, expected {expected}", parameter.name);
    }
    for (view, (pose, [a, b, c, x, y, z])) in ours.solution.poses().iter().zip(&theirs.poses).enumerate() {
        // X0 = -R^T t; R and t mean the same axes x right, y down, z forward.
        let centre =
            -nalgebra::Rotation3::new(nalgebra::Vector3::new(*a, *b, *c)).inverse_transform_vector(&nalgebra::Vector3::new(*x, *y, *z));
        let off = (centre - pose.centre.coords).norm() / centre.norm();
        assert!(off < 1e-6, "view {view}: {off}");
    }
}

#[test]
#[cfg_attr(not(photographs), ignore = "needs the photographs opencv-left in the folder CALIBENCH_DATA")]
fn on_opencvs_photographs() {
    let views = corners(Path::new(option_env!("CALIBENCH_PHOTOGRAPHS").unwrap_or("opencv-left")));
    assert_eq!(views.len(), 13);
    same_optimum(&views);
}
