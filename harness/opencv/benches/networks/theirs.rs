//! OpenCV on a drawn network: `calibrateCamera`, and `fisheye::calibrate` for equidistant lenses.
//!
//! It gets 100 iterations where its default is 30. Before objects with depth `calibrateCamera` asks for a start: the longer side of the image as focal
//! length, and the image's centre; `fisheye::calibrate` starts its poses from a homography, so that an equidistant lens before a wall is outside its
//! method. Coordinates go in as f32, so that its sum of squares may exceed the least by 1e-3 where ours may by 1e-4.

use std::collections::BTreeMap;

use calibench_model::camera::CameraModel;
use opencv::calib3d::{
    CALIB_FIX_K3, CALIB_USE_INTRINSIC_GUESS, Fisheye_CALIB_FIX_SKEW, Fisheye_CALIB_RECOMPUTE_EXTRINSIC, calibrate, calibrate_camera,
};
use opencv::core::{Mat, Point2f, Point3f, Size, TermCriteria, TermCriteria_COUNT, TermCriteria_EPS, Vector};

use crate::draw::{Class, Drawn, Object};

const STEPS: i32 = 100;
const CHANGE: f64 = 1e-12;
const REACHED: f64 = 1e-3;

/// A view: object points, and where they were measured, px.
type View = Vec<([f64; 3], [f64; 2])>;

/// Whether the class is one that OpenCV's methods are made for.
pub fn can(class: Class) -> bool {
    !(class.model == "opencv-fisheye" && matches!(class.object, Object::Wall | Object::Mixed))
}

/// Whether OpenCV arrives at the sum of squares `least`, in units of the noise; not where the network determines no camera.
pub fn reached(class: Class, drawn: &Drawn, least: Option<f64>) -> bool {
    let views = views(drawn);
    let points: usize = views.iter().map(Vec::len).sum();
    let rms = if class.model == "opencv-fisheye" { equidistant(drawn, &views) } else { pinhole(class, drawn, &views) };
    // What it refuses, it does not reach.
    let cost = rms.map(|rms| rms * rms * points as f64 / (drawn.sigma * drawn.sigma));
    least.zip(cost.ok()).is_some_and(|(least, cost)| cost <= least * (1.0 + REACHED))
}

fn views(drawn: &Drawn) -> Vec<View> {
    let control: BTreeMap<&str, [f64; 3]> = drawn.control.iter().map(|row| (row.target.as_str(), row.position)).collect();
    let mut views: BTreeMap<&str, View> = BTreeMap::new();
    for point in drawn.points.rows() {
        views.entry(point.image).or_default().push((control[point.target], [point.start.position.x, point.start.position.y]));
    }
    views.into_values().collect()
}

fn criteria() -> opencv::Result<TermCriteria> {
    TermCriteria::new(TermCriteria_COUNT | TermCriteria_EPS, STEPS, CHANGE)
}

fn size(drawn: &Drawn) -> Size {
    let size = drawn.camera.size();
    Size::new(size.width as i32, size.height as i32)
}

/// Object and image points, one list for each view.
fn lists(views: &[View]) -> (Vector<Vector<Point3f>>, Vector<Vector<Point2f>>) {
    let object = |(p, _): &([f64; 3], [f64; 2])| Point3f::new(p[0] as f32, p[1] as f32, p[2] as f32);
    let image = |(_, p): &([f64; 3], [f64; 2])| Point2f::new(p[0] as f32, p[1] as f32);
    let objects = views.iter().map(|view| view.iter().map(object).collect::<Vector<_>>());
    let images = views.iter().map(|view| view.iter().map(image).collect::<Vector<_>>());
    (objects.collect(), images.collect())
}

/// RMS (2D), px.
fn pinhole(class: Class, drawn: &Drawn, views: &[View]) -> opencv::Result<f64> {
    let (objects, images) = lists(views);
    let size = size(drawn);
    let (mut k, mut d) = (Mat::default(), Mat::default());
    let mut flags = if class.model == "opencv4" { CALIB_FIX_K3 } else { 0 };
    if matches!(class.object, Object::Wall | Object::Mixed) {
        flags |= CALIB_USE_INTRINSIC_GUESS;
        let side = f64::from(size.width.max(size.height));
        let centre = [size.width, size.height].map(|side| 0.5 * f64::from(side - 1));
        k = Mat::from_slice_2d(&[[side, 0.0, centre[0]], [0.0, side, centre[1]], [0.0, 0.0, 1.0]])?;
    }
    let (mut r, mut t) = (Vector::<Mat>::new(), Vector::<Mat>::new());
    calibrate_camera(&objects, &images, size, &mut k, &mut d, &mut r, &mut t, flags, criteria()?)
}

/// RMS (2D), px.
fn equidistant(drawn: &Drawn, views: &[View]) -> opencv::Result<f64> {
    let (objects, images) = lists(views);
    let (mut k, mut d) = (Mat::default(), Mat::default());
    let (mut r, mut t) = (Vector::<Mat>::new(), Vector::<Mat>::new());
    let flags = Fisheye_CALIB_RECOMPUTE_EXTRINSIC | Fisheye_CALIB_FIX_SKEW;
    calibrate(&objects, &images, size(drawn), &mut k, &mut d, &mut r, &mut t, flags, criteria()?)
}
