//! Images of another size than is stated, or coordinates that are exchanged or counted from elsewhere: the principal point and the places of the points tell, and no
//! residual.

use calibench_model::PixelPoint;
use calibench_model::camera::{CameraModel, Ray};

use super::Suspected;
use crate::Calibration;
use crate::doubt::impossible::is_outside;

/// Times that images may be reduced or enlarged.
const TIMES: [f64; 6] = [0.25, 1.0 / 3.0, 0.5, 2.0, 3.0, 4.0];
/// Share of its place by which a principal point may be off the middle of the frame.
const OFF: f64 = 0.1;
/// The same where images may have any size: a crop of them is told from them where it differs by more than twice as much.
const NEAR: f64 = 0.04;
/// Standard deviations within which a principal point has to be so near.
const SIGMAS: f64 = 3.0;
/// What the first pixel may be counted from in place of its centre: the coordinate of that, px, and in words.
const ORIGINS: [(f64, &str); 2] = [(0.5, "from the outer corner of the first pixel: --origin corner"), (1.0, "from 1: subtract 1 from each")];

/// What the cameras of a calibration, and the places of its points, say of the images.
pub(super) fn suspected(calibration: &Calibration<'_>) -> Vec<Suspected> {
    let by_camera = |camera: usize| size(calibration, camera).or_else(|| axes(calibration, camera)).or_else(|| origin(calibration, camera));
    (0..calibration.cameras()).filter_map(by_camera).collect()
}

/// The principal point in the coordinates of the outer corner, as a share of half the stated size.
fn shares(calibration: &Calibration<'_>, index: usize) -> Option<[f64; 2]> {
    let camera = calibration.camera(index);
    let at = camera.project(Ray::from_tangent(0.0, 0.0)).ok()?.to_corner();
    Some([2.0 * at.x / f64::from(camera.size().width), 2.0 * at.y / f64::from(camera.size().height)])
}

/// How well the principal point is known, as a share of half the stated size.
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
    Some([2.0 * squares[0].sqrt() / f64::from(camera.size().width), 2.0 * squares[1].sqrt() / f64::from(camera.size().height)])
}

fn positions<'c>(calibration: &'c Calibration<'_>, index: usize) -> impl Iterator<Item = PixelPoint> + 'c {
    let observations = calibration.prepared.network.observations.iter();
    observations.filter(move |one| calibration.owner(one.image) == index).map(|one| one.position)
}

/// How many times the stated size images are in whose middle the principal point lies: reduced or enlarged, or, where the points lie in them and the principal point
/// is well known, of any other size.
fn times(calibration: &Calibration<'_>, index: usize) -> Option<f64> {
    let shares = shares(calibration, index)?;
    let is = |times: f64, off: f64| shares.iter().all(|share| (share / times - 1.0).abs() < off);
    TIMES.into_iter().find(|times| is(*times, OFF)).or_else(|| cropped(calibration, index))
}

/// How many times the stated size images are that were cropped or enlarged to another one, as their points and the principal point show.
pub(crate) fn cropped(calibration: &Calibration<'_>, index: usize) -> Option<f64> {
    let size = calibration.camera(index).size();
    let shares = shares(calibration, index)?;
    let times = f64::midpoint(shares[0], shares[1]);
    let known = sigmas(calibration, index)?.iter().all(|sigma| SIGMAS * sigma < NEAR * times);
    let alike = shares.iter().all(|share| (share / times - 1.0).abs() < NEAR);
    if !known || !alike || (times - 1.0).abs() < 2.0 * NEAR {
        return None;
    }
    let reach = positions(calibration, index).map(PixelPoint::to_corner).fold([0.0_f64; 2], |most, at| {
        [most[0].max(at.x / f64::from(size.width)), most[1].max(at.y / f64::from(size.height))]
    });
    // They fill what is thought to be the image, and no more of it.
    reach.iter().all(|reach| (reach / times - 1.0 + NEAR).abs() < 2.0 * NEAR).then_some(times)
}

fn size(calibration: &Calibration<'_>, index: usize) -> Option<Suspected> {
    let camera = calibration.camera(index);
    let size = camera.size();
    let at = camera.project(Ray::from_tangent(0.0, 0.0)).ok()?;
    let times = times(calibration, index)?;
    let [width, height] = [size.width, size.height].map(|length| (f64::from(length) * times).round());
    let about = if TIMES.contains(&times) { "" } else { "about " };
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

/// The principal point where it would be if x and y were exchanged, of images that are no squares.
fn axes(calibration: &Calibration<'_>, index: usize) -> Option<Suspected> {
    let size = calibration.camera(index).size();
    let aspect = f64::from(size.width) / f64::from(size.height);
    let [x, y] = shares(calibration, index)?;
    let is = |share: f64, expected: f64| (share / expected - 1.0).abs() < OFF;
    ((aspect - 1.0).abs() > 2.0 * OFF && is(x, 1.0 / aspect) && is(y, aspect)).then(|| Suspected {
        kind: "axes",
        what: format!(
            "x and y of the image points{} are exchanged: the principal point lies in the middle of {} x {} px",
            calibration.of(index),
            size.height,
            size.width
        ),
        rms_px: None,
    })
}

/// Points that lie beside their images by less than a pixel, and in them if they are counted from elsewhere.
fn origin(calibration: &Calibration<'_>, index: usize) -> Option<Suspected> {
    let size = calibration.camera(index).size();
    let outside = |by: f64| positions(calibration, index).filter(|at| is_outside(size, PixelPoint::new(at.x - by, at.y - by))).count();
    let count = outside(0.0);
    let (by, from) = ORIGINS.into_iter().find(|(by, _)| count > 0 && outside(*by) == 0)?;
    Some(Suspected {
        kind: "origin",
        what: format!(
            "pixels{} are counted {from}; {count} image points lie up to {by} px outside of the images, and none does so",
            calibration.of(index)
        ),
        rms_px: None,
    })
}
