//! What a further image would tell of the interior orientation.

use calibench_model::Pose;
use calibench_model::camera::{Camera, CameraModel, DerivativeBuffer};
use nalgebra::{DMatrix, Matrix6, Matrix6xX, Point3, SMatrix};

use super::frame_uncertainty::by_turn;

/// The information (inverse covariance) on the parameters `names` of `camera` from one image at `pose` of object points that are known, each measured with a
/// standard deviation of `sigma` px in either coordinate; the pose itself is unknown. Its units are the inverse ones of the parameters, squared.
///
/// It adds to the inverse of a covariance of these parameters. `None` where a point has no image, or the points do not determine the pose.
pub fn image_information(camera: &Camera, names: &[&str], pose: &Pose, points: &[Point3<f64>], sigma: f64) -> Option<DMatrix<f64>> {
    let parameters = camera.parameters();
    let places: Vec<usize> =
        names.iter().map(|name| parameters.iter().position(|parameter| parameter.name == *name)).collect::<Option<_>>()?;
    let mut buffer = DerivativeBuffer::default();
    let mut interior = DMatrix::zeros(places.len(), places.len());
    let mut both = Matrix6xX::zeros(places.len());
    let mut exterior = Matrix6::zeros();
    let mut by_interior = DMatrix::zeros(places.len(), 1);
    // Shifts in units of a distance, so that all six columns are of one size.
    let unit = points.first().map(|point| pose.ray(point).z)?;
    for point in points {
        let ray = pose.ray(point);
        camera.derivatives_into(ray, &mut buffer).ok()?;
        for axis in 0..2 {
            places.iter().enumerate().for_each(|(j, &place)| by_interior[j] = buffer.by_parameters()[place][axis] / sigma);
            let gradient = buffer.by_ray[axis];
            let turned = by_turn(gradient, ray);
            let shifted = gradient.map(|by| by * unit);
            let by_pose = SMatrix::<f64, 6, 1>::from_iterator(turned.into_iter().chain(shifted).map(|by| by / sigma));
            interior.ger(1.0, &by_interior.column(0), &by_interior.column(0), 1.0);
            both.ger(1.0, &by_pose, &by_interior.column(0), 1.0);
            exterior.ger(1.0, &by_pose, &by_pose, 1.0);
        }
    }
    let factor = exterior.cholesky()?;
    let least = (0..6).map(|i| factor.l_dirty()[(i, i)].powi(2) / exterior[(i, i)]).fold(f64::INFINITY, f64::min);
    (least > DETERMINED).then(|| interior - both.tr_mul(&factor.solve(&both)))
}

/// Share of a column of the pose that the others leave: below it the points are too few, or all but on a line.
const DETERMINED: f64 = 1e-9;
