//! Figures that are off by so much that a unit is likely to be another one.

use std::ops::RangeInclusive;

use calibench_calibrate::{Calibration, Optics};
use calibench_model::camera::{Camera, CameraModel, Ray};

use crate::plain;

/// Sensors that are made, their longer side, mm: from endoscopes to scanned aerial photographs.
const SENSORS: RangeInclusive<f64> = 0.3..=400.0;
/// Principal distances in units of the image's longer side: of a circular fisheye in a large frame, and of a telescope.
const DISTANCES: RangeInclusive<f64> = 0.05..=100.0;
/// Squares of boards in mm or m.
const SQUARES: RangeInclusive<f64> = 0.001..=2000.0;
/// Times that a start may be off.
const START: RangeInclusive<f64> = 0.2..=5.0;
/// Points of a board that are looked at.
const MOST: usize = 400;

/// Sentences on the pixel pitch, principal distances, the start and the squares of a board.
pub(super) fn warnings(calibration: &Calibration<'_>) -> Vec<String> {
    let cameras = calibration.prepared.settings.cameras.iter().enumerate();
    let each = cameras.flat_map(|(i, optics)| {
        let camera = calibration.camera(i);
        [pitch(optics, camera), field(optics, camera), start(optics, camera)]
    });
    each.chain([squares(calibration)]).flatten().collect()
}

fn longer(camera: &Camera) -> f64 {
    let size = camera.size();
    f64::from(size.width.max(size.height))
}

fn pitch(optics: &Optics, camera: &Camera) -> Option<String> {
    let um = optics.pitch_um?;
    let side = um * 1e-3 * longer(camera);
    let text = format!("a pixel pitch of {} um makes a sensor of {} mm: is --pitch in micrometres?", plain(um), plain(side));
    (!SENSORS.contains(&side)).then_some(text)
}

/// Pixels for a tangent, in the middle of the camera's field; `None` where it pictures nothing there.
fn principal_distance(camera: &Camera) -> Option<f64> {
    const SMALL: f64 = 1e-3;
    let [left, right] = [-SMALL, SMALL].map(|x| camera.project(Ray::from_tangent(x, 0.0)).ok());
    let (left, right) = left.zip(right)?;
    Some((right.x - left.x).hypot(right.y - left.y) / (2.0 * SMALL))
}

fn field(optics: &Optics, camera: &Camera) -> Option<String> {
    let (c, side) = (principal_distance(camera)?, longer(camera));
    let text = format!(
        "the principal distance of {} is {} px, {} times the image's longer side: are control, squares and image coordinates in the units that were stated?",
        optics.name,
        plain(c),
        plain(c / side)
    );
    (!DISTANCES.contains(&(c / side))).then_some(text)
}

fn start(optics: &Optics, camera: &Camera) -> Option<String> {
    let (from, to) = (principal_distance(optics.start.as_ref()?)?, principal_distance(camera)?);
    let text = format!(
        "the principal distance of {} started at {} px and ended at {} px: is the camera of --start of this size, and in its unit?",
        optics.name,
        plain(from),
        plain(to)
    );
    (!START.contains(&(to / from))).then_some(text)
}

/// Of a board: control in one plane Z = constant.
fn squares(calibration: &Calibration<'_>) -> Option<String> {
    let survey = &calibration.prepared.survey;
    let known: Vec<_> = (0..survey.targets()).filter_map(|target| survey.known(target)).collect();
    let first = known.first()?;
    if known.iter().any(|point| point.z != first.z) {
        return None;
    }
    let near = &known[..known.len().min(MOST)];
    let pairs = near.iter().enumerate().flat_map(|(i, a)| near[..i].iter().map(move |b| (a - b).norm()));
    let side = pairs.filter(|distance| *distance > 0.0).fold(f64::INFINITY, f64::min);
    let text = format!(
        "neighbours of the board are {} object units apart: boards in mm or m have squares of {} to {}",
        plain(side),
        SQUARES.start(),
        SQUARES.end()
    );
    (side.is_finite() && !SQUARES.contains(&side)).then_some(text)
}
