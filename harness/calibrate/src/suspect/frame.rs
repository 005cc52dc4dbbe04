//! Images of another size than is stated, or coordinates that are exchanged or counted from elsewhere: the principal point and the places of the points tell, and no
//! residual.

use calibench_model::PixelPoint;
use calibench_model::camera::{CameraModel, Ray};

use super::Suspected;
use crate::Calibration;
use crate::placed::{cropped, is_outside, positions, shares};

/// Times that images may be reduced or enlarged.
const TIMES: [f64; 6] = [0.25, 1.0 / 3.0, 0.5, 2.0, 3.0, 4.0];
/// Share of its place by which a principal point may be off the middle of the frame.
const OFF: f64 = 0.1;
/// What the first pixel may be counted from in place of its centre: the coordinate of that, px, and in words.
const ORIGINS: [(f64, &str); 2] = [(0.5, "from the outer corner of the first pixel"), (1.0, "from 1")];

/// What the cameras of a calibration, and the places of its points, say of the images. `flat`: whether the control is a plane.
pub(super) fn suspected(calibration: &Calibration<'_>, flat: bool) -> Vec<Suspected> {
    let of = |camera: usize| size(calibration, camera).or_else(|| axes(calibration, camera, flat)).or_else(|| origin(calibration, camera));
    (0..calibration.cameras()).filter_map(of).collect()
}

/// How many times the stated width and height images are in whose middle the principal point lies: reduced or enlarged, or cropped.
fn times(calibration: &Calibration<'_>, index: usize) -> Option<[f64; 2]> {
    let shares = shares(calibration, index)?;
    let is = |times: f64| shares.iter().all(|share| (share / times - 1.0).abs() < OFF);
    TIMES.into_iter().find(|times| is(*times)).map(|times| [times; 2]).or_else(|| cropped(calibration, index))
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
