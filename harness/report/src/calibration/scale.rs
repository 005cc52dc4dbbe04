//! Figures that are off by so much that a unit is likely to be another one.

use std::ops::RangeInclusive;

use calibench_calibrate::{Calibration, Optics};
use calibench_model::camera::{Camera, CameraModel, Ray};
use calibench_model::upper_median;
use nalgebra::Point3;

use crate::plain;

/// Sensors that are made, their longer side, mm: from endoscopes to scanned aerial photographs.
const SENSORS: RangeInclusive<f64> = 0.3..=400.0;
/// Principal distances in units of the image's longer side: of a circular fisheye in a large frame, and of a telescope.
const DISTANCES: RangeInclusive<f64> = 0.05..=100.0;
/// Squares of boards in mm or m, from etched ones in m to grids on a floor in mm.
const SQUARES: RangeInclusive<f64> = 1e-5..=1e4;
/// Fewer points in a plane are no board.
const LEAST: usize = 9;
/// Of a board's points the share whose next neighbours are as far as the median says, to this share of it.
const REGULAR: (f64, f64) = (0.9, 0.01);
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
        "the principal distance of {} is {} px, {} times the image's longer side: is the size of the images right, and do the views differ enough in tilt or depth to tell it?",
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

fn squares(calibration: &Calibration<'_>) -> Option<String> {
    let survey = &calibration.prepared.survey;
    let known: Vec<_> = (0..survey.targets()).map(|target| survey.known(target)).collect::<Option<_>>()?;
    let side = square(&known)?;
    let text = format!(
        "neighbours of the board are {} object units apart: boards in mm or m have squares of {} to {}",
        plain(side),
        plain(*SQUARES.start()),
        plain(*SQUARES.end())
    );
    (!SQUARES.contains(&side)).then_some(text)
}

/// Side of a board's squares in units of its points; `None` for points that are no board: not in one plane Z = constant, or not in a regular grid.
fn square(points: &[Point3<f64>]) -> Option<f64> {
    if points.len() < LEAST || points.iter().any(|point| point.z != points[0].z) {
        return None;
    }
    let some = &points[..points.len().min(MOST)];
    let nearest = |a: &Point3<f64>| points.iter().map(|b| (a - b).norm()).filter(|apart| *apart > 0.0).fold(f64::INFINITY, f64::min);
    let nearest: Vec<f64> = some.iter().map(nearest).collect();
    let middle = upper_median(nearest.iter().copied())?;
    let (share, within) = REGULAR;
    let alike = nearest.iter().filter(|apart| (*apart - middle).abs() <= within * middle).count();
    (middle.is_finite() && alike as f64 >= share * nearest.len() as f64).then_some(middle)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(side: f64, moved: impl Fn(usize) -> f64) -> Vec<Point3<f64>> {
        (0..30).map(|i| Point3::new((i % 6) as f64 * side + moved(i), (i / 6) as f64 * side, 2.0)).collect()
    }

    #[test]
    fn a_board_is_a_regular_grid_in_one_plane() {
        assert_eq!(square(&grid(25.0, |_| 0.0)), Some(25.0));
        // One corner that was moved is no other board.
        assert_eq!(square(&grid(25.0, |i| if i == 7 { 3.0 } else { 0.0 })), Some(25.0));
        let scattered = |i: usize| 4.0 * (i as f64).sin();
        assert_eq!(square(&grid(25.0, scattered)), None);
        assert_eq!(square(&grid(25.0, |_| 0.0)[..LEAST - 1]), None);
        let mut relief = grid(25.0, |_| 0.0);
        relief[3].z += 0.1;
        assert_eq!(square(&relief), None);
        assert_eq!(square(&[Point3::new(1.0, 1.0, 0.0); 12]), None);
    }
}
