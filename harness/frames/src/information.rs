//! What frames tell of a camera's interior orientation.

use calibench_adjust::approximate::{Control, interior_from_planes, interior_from_size, planar_poses};
use calibench_adjust::image_information;
use calibench_model::ControlRow;
use calibench_model::camera::{Camera, CameraModel, ImageSize, OpenCv};
use nalgebra::{DMatrix, Point3};
use rayon::prelude::*;

use crate::Frame;

/// The parameters whose determination counts: of OpenCV's model with five coefficients.
pub(crate) const PARAMETERS: [&str; 9] = ["fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3"];
/// The standard deviation of an image coordinate that information is counted with, px.
const SIGMA: f64 = 0.1;
/// Frames from which the camera is approximated, at most.
const SOME: usize = 60;
/// Before anything is measured, a length of the camera is known to so many longer sides, a coefficient to so much.
const BEFORE: f64 = 0.5;

/// The information of what is known before any frame, and that of each of `frames`, on [`PARAMETERS`] at an approximate camera without distortion; a frame that does not
/// determine its pose has none.
pub(crate) fn information(frames: &[&Frame], control: &[ControlRow], size: ImageSize) -> (DMatrix<f64>, Vec<DMatrix<f64>>) {
    let views: Vec<Vec<Vec<Control>>> = frames.iter().map(|frame| boards(frame, control)).collect();
    let camera = rough(&views, size);
    let of = |views: &Vec<Vec<Control>>| {
        let each = views.iter().filter_map(|view| of_view(&camera, view));
        each.fold(DMatrix::zeros(PARAMETERS.len(), PARAMETERS.len()), |sum, one| sum + one)
    };
    let side = f64::from(size.width.max(size.height));
    let known = |place: usize| if place < 4 { BEFORE * side } else { BEFORE };
    let before = DMatrix::from_fn(PARAMETERS.len(), PARAMETERS.len(), |i, j| if i == j { known(i).powi(-2) } else { 0.0 });
    (before, views.par_iter().map(of).collect())
}

/// What a frame shows of each board.
fn boards(frame: &Frame, control: &[ControlRow]) -> Vec<Vec<Control>> {
    let one = |seen: &crate::Seen| {
        let [x, y, z] = control[seen.target].position;
        Control { object: Point3::new(x, y, z), image: seen.at }
    };
    frame.seen.chunk_by(|a, b| a.board == b.board).map(|board| board.iter().map(one).collect()).collect()
}

/// A camera without distortion, by Zhang's closed form or else by the size of its frames alone.
fn rough(views: &[Vec<Vec<Control>>], size: ImageSize) -> Camera {
    let step = views.len().div_ceil(SOME).max(1);
    let some: Vec<&[Control]> = views.iter().step_by(step).flatten().filter(|view| view.len() >= 4).map(Vec::as_slice).collect();
    let found = interior_from_planes(&some, size).map(|found| found.camera).or_else(|_| interior_from_size(size)).ok();
    let value = |name: &str| found.and_then(|camera| camera.parameters().iter().find(|p| p.name == name).map(|p| p.value));
    let side = f64::from(size.width.max(size.height));
    let focal = value("fx").zip(value("fy")).map_or(side, |(fx, fy)| (fx * fy).sqrt());
    let middle = |name: &str, side: u32| value(name).unwrap_or((f64::from(side) - 1.0) / 2.0);
    let (cx, cy) = (middle("cx", size.width), middle("cy", size.height));
    OpenCv { size, fx: focal, fy: focal, cx, cy, distortion: [0.0; 14], coefficients: 5 }.into()
}

fn of_view(camera: &Camera, view: &[Control]) -> Option<DMatrix<f64>> {
    let pose = planar_poses(camera, view).ok()?.first()?.pose;
    let points: Vec<Point3<f64>> = view.iter().map(|control| control.object).collect();
    image_information(camera, &PARAMETERS, &pose, &points, SIGMA)
}
