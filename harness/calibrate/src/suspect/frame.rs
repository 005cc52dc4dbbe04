//! Images of another size than is stated, or coordinates that are exchanged or counted from elsewhere: the principal point and the places of the points tell, and no
//! residual.

use std::collections::HashSet;

use calibench_model::PixelPoint;
use calibench_model::camera::{CameraModel, Ray};

use super::Suspected;
use crate::Calibration;
use crate::doubt::impossible::is_outside;

/// Times that images may be reduced or enlarged.
const TIMES: [f64; 6] = [0.25, 1.0 / 3.0, 0.5, 2.0, 3.0, 4.0];
/// Share of its place by which a principal point may be off the middle of the frame.
const OFF: f64 = 0.1;
/// The same where images may have any size.
const NEAR: f64 = 0.04;
/// A crop differs from the stated size by more: principal points of sound cameras lie nearer to the middle.
const CROPPED: f64 = 0.16;
/// Standard deviations within which a principal point has to be so near.
const SIGMAS: f64 = 3.0;
/// Where the points that are farthest to the right and lowest lie in an image that they fill, as shares of its size if its principal point were in its middle.
const FILLED: std::ops::Range<f64> = 0.96..1.04;
/// What the first pixel may be counted from in place of its centre: the coordinate of that, px, and in words.
const ORIGINS: [(f64, &str); 2] = [(0.5, "from the outer corner of the first pixel"), (1.0, "from 1")];

/// What the cameras of a calibration, and the places of its points, say of the images. `flat`: whether the control is a plane.
pub(super) fn suspected(calibration: &Calibration<'_>, flat: bool) -> Vec<Suspected> {
    let of = |camera: usize| size(calibration, camera).or_else(|| axes(calibration, camera, flat)).or_else(|| origin(calibration, camera));
    (0..calibration.cameras()).filter_map(of).collect()
}

/// The principal point in the coordinates of the outer corner, as a share of half the stated size.
fn shares(calibration: &Calibration<'_>, index: usize) -> Option<[f64; 2]> {
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

/// The image points of a camera that are in use.
fn positions(calibration: &Calibration<'_>, index: usize) -> Vec<PixelPoint> {
    let left_out: HashSet<usize> = calibration.options().left_out.into_iter().collect();
    let observations = calibration.prepared.network.observations.iter().enumerate();
    observations.filter(|(k, one)| calibration.owner(one.image) == index && !left_out.contains(k)).map(|(_, one)| one.position).collect()
}

/// How many times the stated width and height images are in whose middle the principal point lies: reduced or enlarged, or cropped.
fn times(calibration: &Calibration<'_>, index: usize) -> Option<[f64; 2]> {
    let shares = shares(calibration, index)?;
    let is = |times: f64| shares.iter().all(|share| (share / times - 1.0).abs() < OFF);
    TIMES.into_iter().find(|times| is(*times)).map(|times| [times; 2]).or_else(|| cropped(calibration, index))
}

/// How many times the stated width and height images are that were cropped, as the principal point, where it is well known, and the points that fill them show.
pub(crate) fn cropped(calibration: &Calibration<'_>, index: usize) -> Option<[f64; 2]> {
    let size = calibration.camera(index).size();
    let (shares, sigmas) = (shares(calibration, index)?, sigmas(calibration, index)?);
    let reach = positions(calibration, index)
        .into_iter()
        .map(PixelPoint::to_corner)
        .fold([0.0_f64; 2], |most, at| [most[0].max(at.x / f64::from(size.width)), most[1].max(at.y / f64::from(size.height))]);
    let is_whole = |axis: usize| (shares[axis] - 1.0).abs() < NEAR;
    let is_other = |axis: usize| {
        let times = shares[axis];
        (times - 1.0).abs() > CROPPED && (times < 1.0 || reach[axis] > 1.0) && FILLED.contains(&(reach[axis] / times))
    };
    let is_known = (0..2).all(|axis| SIGMAS * sigmas[axis] < NEAR * shares[axis]);
    let is_cropped = (0..2).all(|axis| is_whole(axis) || is_other(axis)) && (0..2).any(is_other);
    (is_known && is_cropped).then(|| [0, 1].map(|axis| if is_whole(axis) { 1.0 } else { shares[axis] }))
}

fn size(calibration: &Calibration<'_>, index: usize) -> Option<Suspected> {
    let camera = calibration.camera(index);
    let size = camera.size();
    let at = camera.project(Ray::from_tangent(0.0, 0.0)).ok()?;
    let times = times(calibration, index)?;
    let [width, height] = [(size.width, times[0]), (size.height, times[1])].map(|(length, times)| (f64::from(length) * times).round());
    let about = if TIMES.contains(&times[0]) { "" } else { "about " };
    Some(Suspected {
        kind: "size",
        what: format!(
            "the image points{} are of images of {about}{width} x {height} px, and {} x {} px is stated: the principal point lies at {:.0}, {:.0}",
            calibration.of(index),
            size.width,
            size.height,
            at.x,
            at.y
        ),
        rms_px: None,
    })
}

/// The principal point where it would be if x and y, or width and height, were exchanged, of images that are no squares. A plane may be seen mirrored, which is the
/// same from behind; of other control it is the size.
fn axes(calibration: &Calibration<'_>, index: usize, flat: bool) -> Option<Suspected> {
    let size = calibration.camera(index).size();
    let aspect = f64::from(size.width) / f64::from(size.height);
    let [x, y] = shares(calibration, index)?;
    let is = |share: f64, expected: f64| (share / expected - 1.0).abs() < OFF;
    ((aspect - 1.0).abs() > 2.0 * OFF && is(x, 1.0 / aspect) && is(y, aspect)).then(|| Suspected {
        kind: if flat { "axes" } else { "size" },
        what: format!(
            "{} exchanged{}: the principal point lies in the middle of {} x {} px",
            if flat { "x and y of the image points, or width and height of the images, are" } else { "width and height of the images are" },
            calibration.of(index),
            size.height,
            size.width
        ),
        rms_px: None,
    })
}

/// Points that lie beside their images by up to a pixel, and in them if they are counted from elsewhere.
fn origin(calibration: &Calibration<'_>, index: usize) -> Option<Suspected> {
    let (size, all) = (calibration.camera(index).size(), positions(calibration, index));
    let outside = |by: f64| all.iter().filter(|at| is_outside(size, PixelPoint::new(at.x - by, at.y - by))).count();
    let count = outside(0.0);
    let from: Vec<&str> = ORIGINS.iter().filter(|(by, _)| count > 0 && outside(*by) == 0).map(|(_, from)| *from).collect();
    (!from.is_empty()).then(|| Suspected {
        kind: "origin",
        what: format!(
            "pixels are counted {}{}: {count} image points lie just outside of the images, and none would then",
            from.join(", or "),
            calibration.of(index)
        ),
        rms_px: None,
    })
}
