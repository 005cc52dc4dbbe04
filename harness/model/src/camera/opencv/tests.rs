use super::*;
use crate::camera::conformance::{self, Shape};
use crate::camera::{CameraModel, NoCounterpart, Ray, fold};

const SIZE: ImageSize = ImageSize { width: 4000, height: 3000 };

pub(super) fn camera(coefficients: usize) -> OpenCv {
    let mut distortion = [-0.12, 0.09, 8e-4, -1.7e-3, -0.02, 0.02, -0.01, 0.003, 1e-3, -4e-4, -8e-4, 3e-4, 0.02, -0.03];
    distortion[coefficients..].fill(0.0);
    OpenCv { size: SIZE, fx: 3100.0, fy: 3110.0, cx: 2010.3, cy: 1490.8, distortion, coefficients }
}

#[test]
fn conforms() {
    for coefficients in [0, 4, 5, 8, 12, 14] {
        let shape = if coefficients == 0 { Shape::Straight } else { Shape::Barrel };
        conformance::check(&camera(coefficients), shape);
    }
}

#[test]
fn p2_belongs_to_x() {
    let mut distortion = [0.0; 14];
    distortion[3] = 1e-3;
    let camera = OpenCv { distortion, ..camera(4) };
    let found = camera.project(Ray::from_tangent(0.5, 0.0)).unwrap();
    assert!(found.distance(PixelPoint::new(2010.3 + 3100.0 * (0.5 + 1e-3 * 0.75), 1490.8)) < 1e-9);
}

#[test]
fn what_lies_beyond_a_fold_is_refused() {
    // r (1 + k1 r^2) turns round at r = 1 / sqrt(-3 k1) = 0.577 and reaches 0.385 there.
    let mut distortion = [0.0; 14];
    distortion[0] = -1.0;
    let camera = OpenCv { distortion, ..camera(4) };
    assert_eq!(camera.project(Ray::from_tangent(0.6, 0.0)), Err(NoCounterpart::Fold));
    assert_eq!(camera.project(Ray::from_tangent(5.0, 3.0)), Err(NoCounterpart::Fold));
    assert_eq!(camera.slopes(Ray::from_tangent(0.6, 0.0)), Err(NoCounterpart::Fold));
    assert_eq!(camera.unproject(PixelPoint::new(2010.3 + 3100.0 * 0.39, 1490.8)), Err(NoCounterpart::Fold));
    let found = fold(&camera).unwrap();
    assert!((found.radius_px - 3100.0 * 2.0 / 3.0 / 3_f64.sqrt()).abs() < 1e-6, "{found:?}");
}

#[test]
fn a_solution_beyond_a_fold_is_none() {
    // The radius r (1 - r^2 + 0.4 r^4) turns round at 0.707, where it is 0.424, and rises again from r = 1 on, where it is 0.4.
    let mut distortion = [0.0; 14];
    (distortion[0], distortion[1]) = (-1.0, 0.4);
    let camera = OpenCv { distortion, ..camera(4) };
    for radius in [0.43, 0.7, 1.2, 2.0] {
        assert!(camera.unproject(PixelPoint::new(2010.3 + 3100.0 * radius, 1490.8)).is_err(), "{radius}");
    }
    let (x, _) = camera.unproject(PixelPoint::new(2010.3 + 3100.0 * 0.41, 1490.8)).unwrap().tangent().unwrap();
    assert!(x < 0.707, "{x}");
}

#[test]
fn a_dip_between_samples_is_found() {
    // A polynomial that turns back on a very short way only.
    let (a, width) = (0.3337_f64, 1e-6);
    let f = |s: f64| (s - a) * (s - a) - width * width;
    let found = crate::camera::plane_map::first_fold(f, 1.0, 96).unwrap();
    assert!((found - (a - width)).abs() < 1e-9, "{found}");
}

#[test]
fn a_pole_ends_the_branch() {
    let mut distortion = [0.0; 14];
    distortion[5] = -1.0;
    let camera = OpenCv { distortion, coefficients: 8, ..camera(8) };
    assert!(camera.project(Ray::from_tangent(0.9, 0.0)).is_ok());
    assert_eq!(camera.project(Ray::from_tangent(1.1, 0.0)), Err(NoCounterpart::Fold));
    let pixel = PixelPoint::new(9000.0, 1490.8);
    assert!(camera.project(camera.unproject(pixel).unwrap()).unwrap().distance(pixel) < 1e-9);
}

fn pixels() -> Vec<PixelPoint> {
    (0..5000)
        .map(|i| PixelPoint::new((f64::from(i) * 0.754_877_666).fract() * 3999.0, (f64::from(i) * 0.569_840_291).fract() * 2999.0))
        .collect()
}

#[test]
fn many_points_are_undistorted_as_one() {
    for coefficients in [0, 4, 5, 8, 12, 14] {
        let (camera, points) = (camera(coefficients), pixels());
        let mut tangents = vec![[0.0; 2]; points.len()];
        camera.undistort_all(&points, &mut tangents);
        for (point, [x, y]) in points.iter().zip(&tangents) {
            let back = camera.project(Ray::from_tangent(*x, -y)).unwrap();
            assert!(back.distance(*point) < 1e-10, "{coefficients}: {point:?} {back:?}");
        }
    }
}

#[test]
fn many_points_beyond_a_fold_are_refused() {
    let mut distortion = [0.0; 14];
    distortion[0] = -1.0;
    let camera = OpenCv { distortion, ..camera(4) };
    let points = pixels();
    let mut tangents = vec![[0.0; 2]; points.len()];
    camera.undistort_all(&points, &mut tangents);
    for (point, [x, y]) in points.iter().zip(&tangents) {
        match camera.unproject(*point) {
            Ok(ray) => assert!(ray.angle_to(Ray::from_tangent(*x, -y)) < 1e-8),
            Err(_) => assert!(x.is_nan() && y.is_nan()),
        }
    }
}

/// Points before the camera, one beside it and one behind it, in a turned frame.
fn scene() -> (CameraFromWorld, Vec<[f64; 3]>) {
    let (sin, cos) = 0.3_f64.sin_cos();
    let pose = CameraFromWorld { rotation: [[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]], translation: [0.1, -0.2, -5.0] };
    let coordinate = |i: i32, step: f64, half: f64| ((f64::from(i) * step).fract() - 0.5) * 2.0 * half;
    let mut points: Vec<_> =
        (0..1003).map(|i| [coordinate(i, 0.754_877_666, 2.4), coordinate(i, 0.569_840_291, 1.9), coordinate(i, 0.618, 0.5)]).collect();
    points[17] = [40.0, 0.0, 0.0];
    points[1002] = [0.0, 0.0, 9.0];
    (pose, points)
}

fn ray_of(pose: &CameraFromWorld, point: &[f64; 3]) -> Ray {
    let n: [f64; 3] = std::array::from_fn(|i| (0..3).map(|k| pose.rotation[i][k] * point[k]).sum::<f64>() + pose.translation[i]);
    Ray { x: n[0], y: n[1], z: n[2] }
}

#[test]
fn many_points_are_projected_as_one() {
    for coefficients in [0, 4, 5, 8, 12, 14] {
        let (camera, (pose, points)) = (camera(coefficients), scene());
        let mut pixels = vec![PixelPoint::default(); points.len()];
        let (mut again, mut jacobian) = (pixels.clone(), Jacobian::default());
        camera.project_all(&pose, &points, &mut pixels);
        camera.project_all_with_derivatives(&pose, &points, &mut again, &mut jacobian);
        for (i, point) in points.iter().enumerate() {
            let ray = ray_of(&pose, point);
            let Ok(found) = camera.derivatives(ray) else {
                assert!(pixels[i].x.is_nan() && again[i].y.is_nan() && jacobian.at(i, 0)[0].is_nan());
                continue;
            };
            assert!(pixels[i].distance(found.point) < 1e-10 && again[i].distance(found.point) < 1e-10, "{coefficients} {i}");
            let agree = |column: usize, [x, y]: [f64; 2]| {
                let at = jacobian.at(i, column);
                assert!((at[0] - x).hypot(at[1] - y) < 1e-9 * (1.0 + x.hypot(y)), "{coefficients}: {i}, {column}: {at:?} {x} {y}");
            };
            let by = |row: usize, [x, y, z]: [f64; 3]| found.by_ray[row][0] * x + found.by_ray[row][1] * y + found.by_ray[row][2] * z;
            let turns = [[0.0, -ray.z, ray.y], [ray.z, 0.0, -ray.x], [-ray.y, ray.x, 0.0]];
            turns.iter().enumerate().for_each(|(axis, turn)| agree(axis, [by(0, *turn), by(1, *turn)]));
            (0..3).for_each(|axis| agree(3 + axis, [found.by_ray[0][axis], found.by_ray[1][axis]]));
            found.by_parameters.iter().enumerate().for_each(|(k, by)| agree(6 + k, *by));
            assert_eq!(jacobian.columns(), 6 + found.by_parameters.len());
        }
    }
}
