//! Our model of OpenCV's cameras against OpenCV itself.

use calibench_model::PixelPoint;
use calibench_model::camera::{CameraModel, ImageSize, OpenCv, OpenCvFisheye, Ray};
use opencv::core::{Mat, MatTraitConst, Point2d, Point3d, TermCriteria, TermCriteria_COUNT, Vec3d, no_array};

const POINTS: usize = 100_000;
const SIZE: ImageSize = ImageSize { width: 4000, height: 3000 };
/// px, and px converted to tangents.
const AGREE: f64 = 1e-9;

fn camera(coefficients: usize) -> OpenCv {
    let mut distortion = [-0.12, 0.09, 8e-4, -1.7e-3, -0.02, 0.02, -0.01, 0.003, 1e-3, -4e-4, -8e-4, 3e-4, 0.02, -0.03];
    distortion[coefficients..].fill(0.0);
    OpenCv { size: SIZE, fx: 3100.0, fy: 3110.0, cx: 2010.3, cy: 1490.8, distortion, coefficients }
}

/// Places that fill the frame evenly.
fn places() -> impl Iterator<Item = PixelPoint> {
    let along = |i: usize, step: f64, length: u32| (i as f64 * step).fract() * f64::from(length - 1);
    (0..POINTS).map(move |i| PixelPoint::new(along(i, 0.754_877_666, SIZE.width), along(i, 0.569_840_291, SIZE.height)))
}

fn matrix(fx: f64, fy: f64, cx: f64, cy: f64) -> opencv::Result<Mat> {
    Mat::from_slice_2d(&[[fx, 0.0, cx], [0.0, fy, cy], [0.0, 0.0, 1.0]])
}

/// Object points in OpenCV's frame: x right, y down, z forward.
fn objects(rays: &[Ray]) -> Vec<Point3d> {
    rays.iter().map(|ray| Point3d::new(ray.x, -ray.y, -ray.z)).collect()
}

fn projected(camera: &OpenCv, rays: &[Ray]) -> opencv::Result<Vec<PixelPoint>> {
    let (objects, mut found) = (objects(rays), vec![Point2d::default(); rays.len()]);
    let k = matrix(camera.fx, camera.fy, camera.cx, camera.cy)?;
    let none = Vec3d::default();
    let coefficients = Mat::from_slice(&camera.distortion[..camera.coefficients])?.try_clone()?;
    let mut out = Mat::from_slice_mut(&mut found)?;
    opencv::calib3d::project_points_def(&Mat::from_slice(&objects)?, &none, &none, &k, &coefficients, &mut out)?;
    drop(out);
    Ok(found.into_iter().map(|point| PixelPoint::new(point.x, point.y)).collect())
}

#[test]
fn projections_agree_with_opencv_s() {
    for coefficients in [4, 5, 8, 12, 14] {
        let camera = camera(coefficients);
        let rays: Vec<Ray> = places().map(|place| camera.unproject(place).unwrap()).collect();
        let theirs = projected(&camera, &rays).unwrap();
        for (ray, theirs) in rays.iter().zip(&theirs) {
            let off = camera.project(*ray).unwrap().distance(*theirs);
            assert!(off < AGREE, "{coefficients} coefficients: {off:e} px at {theirs:?}");
        }
    }
}

#[test]
fn undistorted_points_agree_with_opencv_s() {
    for coefficients in [4, 5, 8, 12, 14] {
        let camera = camera(coefficients);
        let places: Vec<PixelPoint> = places().collect();
        let from: Vec<Point2d> = places.iter().map(|place| Point2d::new(place.x, place.y)).collect();
        let mut found = vec![Point2d::default(); from.len()];
        let k = matrix(camera.fx, camera.fy, camera.cx, camera.cy).unwrap();
        let distortion = Mat::from_slice(&camera.distortion[..coefficients]).unwrap().try_clone().unwrap();
        let criteria = TermCriteria::new(TermCriteria_COUNT, 100, 0.0).unwrap();
        let mut out = Mat::from_slice_mut(&mut found).unwrap();
        let source = Mat::from_slice(&from).unwrap();
        opencv::calib3d::undistort_points_iter(&source, &mut out, &k, &distortion, &no_array(), &no_array(), criteria).unwrap();
        drop(out);
        let mut ours = vec![[0.0; 2]; places.len()];
        camera.undistort_all(&places, &mut ours);
        for ([x, y], theirs) in ours.into_iter().zip(&found) {
            let off = camera.fy * (x - theirs.x).hypot(y - theirs.y);
            assert!(off < AGREE, "{coefficients} coefficients: {off:e} px at {theirs:?}");
        }
    }
}

#[test]
fn fisheye_projections_agree_with_opencv_s() {
    let camera =
        OpenCvFisheye { size: SIZE, fx: 1500.0, fy: 1505.0, cx: 2010.3, cy: 1490.8, skew: 0.002, k: [-0.02, 0.006, -0.004, 0.0005] };
    // OpenCV divides by Z: rays before the camera only.
    let rays: Vec<Ray> = places().filter_map(|place| camera.unproject(place).ok()).filter(|ray| ray.z < -0.02).collect();
    assert!(rays.len() > POINTS / 2, "{}", rays.len());
    let objects = objects(&rays);
    let mut found = vec![Point2d::default(); rays.len()];
    let k = matrix(camera.fx, camera.fy, camera.cx, camera.cy).unwrap();
    let (none, distortion) = (Vec3d::default(), Mat::from_slice(&camera.k).unwrap().try_clone().unwrap());
    let mut out = Mat::from_slice_mut(&mut found).unwrap();
    let source = Mat::from_slice(&objects).unwrap();
    opencv::calib3d::fisheye_project_points_vec(&source, &mut out, &none, &none, &k, &distortion, camera.skew, &mut no_array()).unwrap();
    drop(out);
    for (ray, theirs) in rays.iter().zip(&found) {
        let off = camera.project(*ray).unwrap().distance(PixelPoint::new(theirs.x, theirs.y));
        assert!(off < AGREE, "{off:e} px at {theirs:?}");
    }
}
