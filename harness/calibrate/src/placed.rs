//! Where the principal point and the image points lie in the frame that is stated.

use std::collections::HashSet;

use calibench_adjust::ImageObservation;
use calibench_model::PixelPoint;
use calibench_model::camera::{CameraModel, ImageSize, Ray};

use crate::Calibration;

/// Share of its place by which the principal point of a whole image may be off the middle of the frame.
const NEAR: f64 = 0.04;
/// A crop differs from the stated size by more: principal points of sound cameras lie nearer to the middle.
const CROPPED: f64 = 0.16;
/// Standard deviations within which a principal point has to be so near.
const SIGMAS: f64 = 3.0;
/// Where the points that are farthest to the right and lowest lie in an image that they fill, as shares of its size if its principal point were in its middle.
const FILLED: std::ops::Range<f64> = 0.96..1.04;

/// Whether a position is in no pixel of an image.
pub fn is_outside(size: ImageSize, position: PixelPoint) -> bool {
    let at = position.to_corner();
    !((0.0..=f64::from(size.width)).contains(&at.x) && (0.0..=f64::from(size.height)).contains(&at.y))
}

/// The principal point in the coordinates of the outer corner, as a share of half the stated size.
pub fn shares(calibration: &Calibration<'_>, index: usize) -> Option<[f64; 2]> {
    let camera = calibration.camera(index);
    let at = camera.project(Ray::from_tangent(0.0, 0.0)).ok()?.to_corner();
    Some([2.0 * at.x / f64::from(camera.size().width), 2.0 * at.y / f64::from(camera.size().height)])
}

/// How well the principal point is known, as a share of half the stated size; `None` where it is not solved for.
fn sigmas(calibration: &Calibration<'_>, index: usize) -> Option<[f64; 2]> {
    let camera = calibration.camera(index);
    let (names, covariance) = calibration.covariances.of_camera(index);
    let parameters = camera.parameters();
    let axis = |values: &[f64]| camera.with_parameters(values).project(Ray::from_tangent(0.0, 0.0)).ok();
    let values: Vec<f64> = parameters.iter().map(|parameter| parameter.value).collect();
    let at = axis(&values)?;
    let mut squares = [0.0; 2];
    for (row, name) in names.iter().enumerate() {
        let mut moved = values.clone();
        moved[parameters.iter().position(|parameter| parameter.name == *name)?] += covariance[(row, row)].sqrt();
        let to = axis(&moved)?;
        squares[0] += (to.x - at.x).powi(2);
        squares[1] += (to.y - at.y).powi(2);
    }
    let sigmas = [2.0 * squares[0].sqrt() / f64::from(camera.size().width), 2.0 * squares[1].sqrt() / f64::from(camera.size().height)];
    sigmas.iter().all(|sigma| *sigma > 0.0).then_some(sigmas)
}

/// The image points that are in use.
pub fn in_use<'c>(calibration: &'c Calibration<'_>) -> impl Iterator<Item = &'c ImageObservation> {
    let left_out: HashSet<usize> = calibration.options().left_out.into_iter().collect();
    let observations = calibration.prepared.network.observations.iter().enumerate();
    observations.filter(move |(k, _)| !left_out.contains(k)).map(|(_, one)| one)
}

/// Those of a camera, px.
pub fn positions(calibration: &Calibration<'_>, index: usize) -> Vec<PixelPoint> {
    in_use(calibration).filter(|one| calibration.owner(one.image) == index).map(|one| one.position).collect()
}

/// How many times the stated width and height images are that were cropped, as the principal point, where it is well known, and the points that fill them show.
pub fn cropped(calibration: &Calibration<'_>, index: usize) -> Option<[f64; 2]> {
    let size = calibration.camera(index).size();
    let shares = shares(calibration, index)?;
    let is_whole = |axis: usize| (shares[axis] - 1.0).abs() < NEAR;
    // That of nearly every camera is, and its points need not be looked at.
    if is_whole(0) && is_whole(1) {
        return None;
    }
    let sigmas = sigmas(calibration, index)?;
    let reach = positions(calibration, index)
        .into_iter()
        .map(PixelPoint::to_corner)
        .fold([0.0_f64; 2], |most, at| [most[0].max(at.x / f64::from(size.width)), most[1].max(at.y / f64::from(size.height))]);
    let is_other = |axis: usize| {
        let times = shares[axis];
        (times - 1.0).abs() > CROPPED && (times < 1.0 || reach[axis] > 1.0) && FILLED.contains(&(reach[axis] / times))
    };
    let is_known = (0..2).all(|axis| SIGMAS * sigmas[axis] < NEAR * shares[axis]);
    let is_cropped = (0..2).all(|axis| is_whole(axis) || is_other(axis));
    (is_known && is_cropped).then(|| [0, 1].map(|axis| if is_whole(axis) { 1.0 } else { shares[axis] }))
}
