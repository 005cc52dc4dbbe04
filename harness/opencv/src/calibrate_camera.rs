//! OpenCV's calibration from a flat board.

use calibench_adjust::approximate::Control;
use calibench_calibrate::{BoardSolution, BoardSolver};
use calibench_model::camera::{ImageSize, OpenCv};
use opencv::calib3d::calibrate_camera_extended_def;
use opencv::core::{Mat, MatTraitConst, Point2f, Point3f, Size, Vector, no_array};

/// k1, k2, p1, p2, k3.
const COEFFICIENTS: usize = 5;

/// OpenCV's `calibrateCamera` as it comes: without a guess, with all nine parameters of the plain model and its own criteria of termination.
///
/// Source: OpenCV, module calib3d, `calibrateCameraExtended`; Zhang 2000.
#[derive(Clone, Copy, Debug, Default)]
pub struct CalibrateCamera;

impl BoardSolver for CalibrateCamera {
    fn name(&self) -> &'static str {
        "calibrateCamera"
    }

    fn version(&self) -> String {
        crate::lapack().map_or_else(crate::version, |lapack| format!("{} with {lapack}", crate::version()))
    }

    fn solve(&self, size: ImageSize, views: &[Vec<Control>]) -> Result<BoardSolution, String> {
        if views.is_empty() {
            return Err("calibrateCamera: no view shows the board".into());
        }
        let first = |error: opencv::Error| error.message.lines().next().unwrap_or_default().to_owned();
        solve(size, views).map_err(|error| format!("calibrateCamera: {}", first(error)))
    }
}

fn solve(size: ImageSize, views: &[Vec<Control>]) -> opencv::Result<BoardSolution> {
    // It takes single precision and nothing else.
    let object = |view: &Vec<Control>| {
        let points = view.iter().map(|corner| {
            let [x, y, z] = [corner.object.x, corner.object.y, corner.object.z].map(|at| at as f32);
            Point3f::new(x, y, z)
        });
        points.collect::<Vector<Point3f>>()
    };
    let image = |view: &Vec<Control>| {
        let points = view.iter().map(|corner| Point2f::new(corner.image.x as f32, corner.image.y as f32));
        points.collect::<Vector<Point2f>>()
    };
    let objects: Vector<Vector<Point3f>> = views.iter().map(object).collect();
    let images: Vector<Vector<Point2f>> = views.iter().map(image).collect();
    let [mut k, mut d, mut sigmas] = [Mat::default(), Mat::default(), Mat::default()];
    let (mut rotations, mut translations) = (Vector::<Mat>::new(), Vector::<Mat>::new());
    let frame = Size::new(i32::try_from(size.width).unwrap_or(i32::MAX), i32::try_from(size.height).unwrap_or(i32::MAX));
    let (mut poses, mut residuals) = (no_array(), no_array());
    let rms_px = calibrate_camera_extended_def(
        &objects,
        &images,
        frame,
        &mut k,
        &mut d,
        &mut rotations,
        &mut translations,
        &mut sigmas,
        &mut poses,
        &mut residuals,
    )?;
    let at = |row: i32, column: i32| k.at_2d::<f64>(row, column).copied();
    let mut distortion = [0.0; 14];
    for (index, value) in distortion.iter_mut().take(COEFFICIENTS).enumerate() {
        *value = *d.at::<f64>(index as i32)?;
    }
    let camera = OpenCv { size, fx: at(0, 0)?, fy: at(1, 1)?, cx: at(0, 2)?, cy: at(1, 2)?, distortion, coefficients: COEFFICIENTS };
    // Its own standard deviations begin with fx, fy; they are not independent, and their mean is at most this.
    let sigma_f_px = 0.5 * (*sigmas.at::<f64>(0)? + *sigmas.at::<f64>(1)?);
    Ok(BoardSolution { camera: camera.into(), sigma_f_px: Some(sigma_f_px), rms_px })
}

#[cfg(test)]
mod tests {
    use calibench_adjust::approximate::planar_poses;
    use calibench_adjust::{Exterior, ImageObservation, Interior, Network, ObjectPoint, Options, Variance, adjust};
    use calibench_model::PixelPoint;
    use calibench_model::camera::{Camera, CameraModel, Ray};
    use nalgebra::{Point3, Rotation3, Vector3};
    use rand::SeedableRng;
    use rand_distr::{Distribution, Normal};

    use super::*;

    const SIZE: ImageSize = ImageSize { width: 1280, height: 960 };
    const SIGMA: f64 = 0.1;

    fn truth() -> OpenCv {
        let mut distortion = [0.0; 14];
        distortion[..COEFFICIENTS].copy_from_slice(&[-0.11, 0.07, 0.0006, -0.0004, -0.01]);
        OpenCv { size: SIZE, fx: 1100.0, fy: 1102.0, cx: 652.0, cy: 471.0, distortion, coefficients: COEFFICIENTS }
    }

    /// Twelve views of 9 x 6 corners, with errors of standard deviation `sigma`, px.
    fn views(sigma: f64) -> Vec<Vec<Control>> {
        let camera = Camera::from(truth());
        let normal = Normal::new(0.0, sigma).unwrap();
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(3);
        let view = |i: i32| {
            let turn = Rotation3::from_euler_angles(0.5 * f64::from(i).sin(), 0.5 * f64::from(i * i).cos(), 0.3 * f64::from(i));
            let shift = Vector3::new(60.0 * f64::from(i % 3 - 1), 40.0 * f64::from(i % 4 - 1), 420.0 + 20.0 * f64::from(i % 5));
            let corner = |n: usize| {
                let object = Point3::new(30.0 * (n % 9) as f64 - 120.0, 30.0 * (n / 9) as f64 - 75.0, 0.0);
                let at = turn * object.coords + shift;
                let image = camera.project(Ray::from_tangent(at.x / at.z, at.y / at.z)).unwrap();
                (object, image)
            };
            (0..54).map(corner).collect::<Vec<_>>()
        };
        let noisy = |(object, at): (Point3<f64>, PixelPoint), rng: &mut _| {
            let image = PixelPoint::new(at.x + normal.sample(rng), at.y + normal.sample(rng));
            Control { object, image }
        };
        (0..12).map(view).map(|view| view.into_iter().map(|corner| noisy(corner, &mut rng)).collect()).collect()
    }

    fn values(camera: &Camera) -> Vec<f64> {
        camera.parameters().iter().map(|parameter| parameter.value).collect()
    }

    /// Coordinates go in as f32, which rounds to 6e-5 px here.
    #[test]
    fn without_errors_the_camera_is_the_true_one() {
        let found = CalibrateCamera.solve(SIZE, &views(0.0)).unwrap();
        assert!(found.rms_px < 1e-4, "{}", found.rms_px);
        for (found, truth) in values(&found.camera).iter().zip(values(&truth().into())) {
            assert!((found - truth).abs() < 1e-3 * truth.abs().max(0.01), "{found} {truth}");
        }
    }

    /// Both are least squares. Up to 4.7 OpenCV divides the squares by points less unknowns where there are two coordinates a point: its standard deviations are
    /// too wide.
    #[test]
    fn its_minimum_is_ours() {
        let views = views(SIGMA);
        let theirs = CalibrateCamera.solve(SIZE, &views).unwrap();
        let names = ["fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3"];
        let start = Camera::from(OpenCv { distortion: [0.0; 14], ..truth() });
        let mut network = Network { cameras: vec![Interior::fixed("camera", start).free(&names).unwrap()], ..Network::default() };
        network.points = views[0].iter().enumerate().map(|(i, corner)| ObjectPoint::fixed(format!("{i}"), corner.object)).collect();
        for (image, view) in views.iter().enumerate() {
            network.images.push(Exterior::free(format!("view {image}"), 0, planar_poses(&start, view).unwrap()[0].pose));
            network.observations.extend(view.iter().enumerate().map(|(i, corner)| ImageObservation::new(image, i, corner.image, SIGMA)));
        }
        let ours = adjust(&network, &Options::default()).unwrap();
        let (_, covariance) = ours.covariances(Variance::Estimated).unwrap().of_camera(0);
        for (i, (theirs, ours)) in values(&theirs.camera).iter().zip(values(&ours.cameras()[0])).enumerate().take(names.len()) {
            let sigma = covariance[(i, i)].sqrt();
            assert!((theirs - ours).abs() < 0.01 * sigma, "{}: {theirs} {ours} +- {sigma}", names[i]);
        }
        let own = 0.5 * (covariance[(0, 0)].sqrt() + covariance[(1, 1)].sqrt());
        let (points, unknowns): (f64, f64) = (12.0 * 54.0, 9.0 + 12.0 * 6.0);
        let version = [opencv::core::get_version_major(), opencv::core::get_version_minor()];
        let wide = if version < [4, 8] { ((2.0 * points - unknowns) / (points - unknowns)).sqrt() } else { 1.0 };
        let expected = own * wide;
        let stated = theirs.sigma_f_px.unwrap();
        assert!((stated / expected - 1.0).abs() < 0.01, "{stated} {own} {expected}");
    }

    #[test]
    fn what_it_refuses_is_told() {
        assert_eq!(CalibrateCamera.solve(SIZE, &[]).unwrap_err(), "calibrateCamera: no view shows the board");
        let two = vec![views(0.0)[0][..2].to_vec()];
        let why = CalibrateCamera.solve(SIZE, &two).unwrap_err();
        assert!(why.starts_with("calibrateCamera: OpenCV") && !why.contains('\n'), "{why}");
    }
}
