//! Where a camera is surely one to one, so that many points need no search each.

use super::OpenCv;
use crate::PixelPoint;
use crate::camera::newton::determinant;
use crate::camera::pinhole::Pinhole;
use crate::camera::plane_map::first_fold;
use crate::camera::{CameraModel, Ray};

/// Directions and places where a fold is looked for, and what is kept clear of it.
const DIRECTIONS: usize = 64;
const PLACES: usize = 200;
const CLEAR: f64 = 0.97;
/// Ideal radii beyond the corners of the frame, relative.
const BEYOND: f64 = 1.1;

/// Ideal radii, tangents.
#[derive(Clone, Copy, Debug)]
pub(super) struct Region {
    /// Within it the camera is one to one.
    pub(super) safe: f64,
    /// That of the frame's corners, or `safe` if it is less.
    pub(super) widest: f64,
}

/// The region of `camera`.
pub(super) fn of(camera: &OpenCv) -> Region {
    let (width, height) = (f64::from(camera.size.width), f64::from(camera.size.height));
    let corners = [(0.0, 0.0), (width, 0.0), (0.0, height), (width, height)].map(|(x, y)| PixelPoint::new(x, y));
    // A corner without a ray: a fold inside the frame.
    let radii = corners.map(|corner| camera.unproject(corner).ok().and_then(Ray::tangent).map_or(f64::INFINITY, |(x, y)| x.hypot(y)));
    let farthest = BEYOND * radii.into_iter().fold(0.0, f64::max);
    let reach = if farthest.is_finite() { farthest } else { 3.0 };
    let safe = if camera.is_surely_one_to_one(reach) { reach } else { searched(camera, reach) };
    Region { safe, widest: safe.min(reach) }
}

fn searched(camera: &OpenCv, reach: f64) -> f64 {
    let towards = |i: usize| {
        let (sin, cos) = (std::f64::consts::TAU * i as f64 / DIRECTIONS as f64).sin_cos();
        first_fold(|r| determinant(camera.distort([r * cos, r * sin]).1), reach, PLACES).map_or(reach, |fold| CLEAR * fold)
    };
    (0..DIRECTIONS).map(towards).fold(reach, f64::min)
}
