//! OpenCV's functions on the same points.

use calibench_model::PixelPoint;
use calibench_model::camera::opencv::CameraFromWorld;
use calibench_model::camera::{ImageSize, OpenCv};
use opencv::core::{Mat, MatTraitConst, Point2d, Point3d, Size, TermCriteria, TermCriteria_COUNT, TermCriteria_EPS, Vec3d, no_array};

/// A camera, points, and places for results that are used again.
pub(crate) struct Theirs {
    matrix: Mat,
    distortion: Mat,
    rotation: Mat,
    translation: Vec3d,
    objects: Vec<Point3d>,
    from: Vec<Point2d>,
    to: Vec<Point2d>,
    jacobian: Mat,
}

impl Theirs {
    pub(crate) fn new(camera: &OpenCv, pose: &CameraFromWorld, objects: &[[f64; 3]]) -> opencv::Result<Self> {
        let matrix = Mat::from_slice_2d(&[[camera.fx, 0.0, camera.cx], [0.0, camera.fy, camera.cy], [0.0, 0.0, 1.0]])?;
        let distortion = Mat::from_slice(&camera.distortion[..camera.coefficients])?.try_clone()?;
        // y down and z forward.
        let [x, y, z] = pose.rotation;
        let turned = Mat::from_slice_2d(&[x, y.map(|v| -v), z.map(|v| -v)])?;
        let mut rotation = Mat::default();
        opencv::calib3d::rodrigues_def(&turned, &mut rotation)?;
        let [x, y, z] = pose.translation;
        let translation = Vec3d::from([x, -y, -z]);
        let objects: Vec<Point3d> = objects.iter().map(|[x, y, z]| Point3d::new(*x, *y, *z)).collect();
        let to = vec![Point2d::default(); objects.len()];
        Ok(Self { matrix, distortion, rotation, translation, objects, from: Vec::new(), to, jacobian: Mat::default() })
    }

    pub(crate) fn with_places(mut self, places: &[PixelPoint]) -> Self {
        self.from = places.iter().map(|place| Point2d::new(place.x, place.y)).collect();
        self.to = vec![Point2d::default(); places.len()];
        self
    }

    /// A fixed number of iterations.
    pub(crate) fn undistort(&mut self, iterations: i32) -> opencv::Result<()> {
        self.undistort_until(TermCriteria::new(TermCriteria_COUNT, iterations, 0.0)?)
    }

    /// Until OpenCV's own measure of accuracy is reached.
    pub(crate) fn undistort_to(&mut self, accuracy: f64) -> opencv::Result<()> {
        self.undistort_until(TermCriteria::new(TermCriteria_COUNT | TermCriteria_EPS, 200, accuracy)?)
    }

    fn undistort_until(&mut self, criteria: TermCriteria) -> opencv::Result<()> {
        let mut to = Mat::from_slice_mut(&mut self.to)?;
        opencv::calib3d::undistort_points_iter(
            &Mat::from_slice(&self.from)?,
            &mut to,
            &self.matrix,
            &self.distortion,
            &no_array(),
            &no_array(),
            criteria,
        )
    }

    /// The map that undistorts an image, floats of 32 bits.
    pub(crate) fn map(&mut self, size: ImageSize) -> opencv::Result<()> {
        let (mut x, mut y) = (Mat::default(), Mat::default());
        let size = Size::new(size.width as i32, size.height as i32);
        opencv::calib3d::init_undistort_rectify_map(
            &self.matrix,
            &self.distortion,
            &no_array(),
            &self.matrix,
            size,
            opencv::core::CV_32FC1,
            &mut x,
            &mut y,
        )
    }

    pub(crate) fn tangents(&self) -> impl Iterator<Item = [f64; 2]> {
        self.to.iter().map(|point| [point.x, point.y])
    }

    pub(crate) fn pixels(&self) -> impl Iterator<Item = PixelPoint> {
        self.to.iter().map(|point| PixelPoint::new(point.x, point.y))
    }

    pub(crate) fn project(&mut self) -> opencv::Result<()> {
        let objects = Mat::from_slice(&self.objects)?;
        let mut to = Mat::from_slice_mut(&mut self.to)?;
        opencv::calib3d::project_points_def(&objects, &self.rotation, &self.translation, &self.matrix, &self.distortion, &mut to)
    }

    pub(crate) fn project_with_derivatives(&mut self) -> opencv::Result<()> {
        let objects = Mat::from_slice(&self.objects)?;
        let mut to = Mat::from_slice_mut(&mut self.to)?;
        let Self { rotation, translation, matrix, distortion, jacobian, .. } = self;
        opencv::calib3d::project_points(&objects, rotation, translation, matrix, distortion, &mut to, jacobian, 0.0)
    }

    /// d(x, y) / d(column): rotation vector, translation, fx, fy, cx, cy, coefficients.
    pub(crate) fn derivative(&self, point: usize, column: usize) -> opencv::Result<[f64; 2]> {
        let at = |row: usize| self.jacobian.at_2d::<f64>(row as i32, column as i32).copied();
        Ok([at(2 * point)?, at(2 * point + 1)?])
    }
}
