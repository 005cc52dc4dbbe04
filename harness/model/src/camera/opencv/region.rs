//! Where a camera is surely one to one, so that many points need no search each.

use super::OpenCv;
use crate::PixelPoint;
use crate::camera::newton::determinant;
use crate::camera::pinhole::Pinhole;
use crate::camera::plane_map::first_fold;
use crate::camera::{CameraModel, Ray};

/// Halvings that locate the end of what a bound tells to be one to one.
const HALVINGS: usize = 8;
/// A bound is good enough if decentring and prism take no more from its reach.
const NEARLY: f64 = 0.9;
/// Directions and places where a fold is looked for where it is not, and what is kept clear of it.
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
    let safe = bounded(camera, reach).unwrap_or_else(|| searched(camera, reach));
    Region { safe, widest: safe.min(reach) }
}

/// The region by bounds alone; `None` if they see much less of it than there is.
fn bounded(camera: &OpenCv, reach: f64) -> Option<f64> {
    let safe = largest(camera, reach);
    let mut radial = *camera;
    radial.distortion[2..4].fill(0.0);
    radial.distortion[8..].fill(0.0);
    (safe == reach || safe > NEARLY * largest(&radial, reach)).then_some(safe)
}

/// The largest radius up to `reach` that is found to be surely one to one.
fn largest(camera: &OpenCv, reach: f64) -> f64 {
    if camera.is_surely_one_to_one(reach) {
        return reach;
    }
    let (mut safe, mut step) = (0.0, reach);
    for _ in 0..HALVINGS {
        step *= 0.5;
        if camera.is_surely_one_to_one(safe + step) {
            safe += step;
        }
    }
    safe
}

fn searched(camera: &OpenCv, reach: f64) -> f64 {
    let towards = |i: usize| {
        let (sin, cos) = (std::f64::consts::TAU * i as f64 / DIRECTIONS as f64).sin_cos();
        first_fold(|r| determinant(camera.distort([r * cos, r * sin]).1), reach, PLACES).map_or(reach, |fold| CLEAR * fold)
    };
    (0..DIRECTIONS).map(towards).fold(reach, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::ImageSize;

    /// Coefficients of every sign and size; of five, of eight, of a thin prism without decentring, and of a sensor that is tilted so far that it ends the image.
    fn cameras() -> impl Iterator<Item = OpenCv> {
        (0..600_u32).map(|i| {
            let part = |shift: u32, scale: f64| {
                scale * (f64::from(i.wrapping_mul(2_654_435_761).rotate_left(shift) >> 8) / f64::from(1 << 24) - 0.5)
            };
            let all = match i % 4 {
                2 => [1.2, 0.8, 0.0, 0.0, 0.6, 0.8, 0.4, 0.2, 0.8, 0.8, 0.8, 0.8, 0.0, 0.0],
                _ => [1.2, 0.8, 0.1, 0.1, 0.6, 0.8, 0.4, 0.2, 0.05, 0.05, 0.05, 0.05, 2.4, 2.4],
            };
            let coefficients = [5, 8, 12, 14][i as usize % 4];
            let mut distortion = [0.0; 14];
            (0..coefficients).for_each(|k| distortion[k] = part(2 * k as u32 + i % 2, all[k]));
            let size = ImageSize { width: 640, height: 480 };
            OpenCv { size, fx: 500.0, fy: 480.0, cx: 320.0 + part(3, 100.0), cy: 240.0, distortion, coefficients }
        })
    }

    /// Beside the search in many directions.
    #[test]
    fn bounds_reach_as_far_as_the_camera_is_one_to_one() {
        let (mut told, mut in_doubt, mut whole) = (0, 0, 0);
        for camera in cameras() {
            let reach = of(&camera).widest.max(0.3) * 1.5;
            let searched = searched(&camera, reach);
            let Some(safe) = bounded(&camera, reach) else {
                in_doubt += 1;
                continue;
            };
            told += 1;
            whole += usize::from(safe == reach);
            let clear = if searched == reach { 1.0 } else { CLEAR };
            assert!(safe <= searched / clear * (1.0 + 1e-9), "{safe} {searched} {camera:?}");
            assert!(safe >= 0.8 * searched, "{safe} {searched} {camera:?}");
        }
        assert!(told > 200 && in_doubt > 200 && whole > 50 && whole < told - 50, "{told} {in_doubt} {whole}");
    }
}
