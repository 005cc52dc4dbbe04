//! Fisheyes that see beyond 90 degrees from their axis, in tools that divide by z.

use calibench_model::camera::{Camera, CameraModel, Ray};
use calibench_model::{CornerPoint, PixelPoint};

/// Columns and rows of the places that are looked at.
const GRID: (usize, usize) = (120, 80);

/// What such tools make of a camera.
pub(super) struct Behind {
    /// Share of the frame that sees rays beyond 90 degrees, 0 to 1.
    pub share: f64,
    /// How far from there these rays are pictured at most, px.
    pub elsewhere_px: f64,
}

/// The share of a fisheye's frame that sees rays beyond 90 degrees; `None` where there is none, and of cameras that are no fisheyes.
pub(super) fn behind(camera: &Camera) -> Option<Behind> {
    if !matches!(camera, Camera::OpenCvFisheye(_) | Camera::PrismFisheye(_) | Camera::RadTanPrismFisheye(_) | Camera::SixPrismFisheye(_)) {
        return None;
    }
    let ((columns, rows), size) = (GRID, camera.size());
    let place = |column: f64, row: f64| -> PixelPoint {
        CornerPoint { x: f64::from(size.width) * column / columns as f64, y: f64::from(size.height) * row / rows as f64 }.to_pixel()
    };
    // What is farthest from the axis is a corner: nearly all cameras end here.
    let corners = [(0, 0), (columns, 0), (0, rows), (columns, rows)].map(|(column, row)| place(column as f64, row as f64));
    if corners.iter().all(|&corner| camera.unproject(corner).is_ok_and(|ray| ray.z <= 0.0)) {
        return None;
    }
    let places = (0..columns * rows).map(|i| place((i % columns) as f64 + 0.5, (i / columns) as f64 + 0.5));
    let inside: Vec<f64> = places.filter_map(|place| elsewhere(camera, place)).collect();
    if inside.is_empty() {
        return None;
    }
    let farthest = corners.into_iter().filter_map(|corner| elsewhere(camera, corner));
    let elsewhere_px = inside.iter().copied().chain(farthest).fold(0.0, f64::max);
    Some(Behind { share: inside.len() as f64 / (columns * rows) as f64, elsewhere_px })
}

/// How far from `at` its ray is pictured after a division by z, if it is beyond 90 degrees.
fn elsewhere(camera: &Camera, at: PixelPoint) -> Option<f64> {
    let ray = camera.unproject(at).ok().filter(|ray| ray.z > 0.0)?;
    // x / z and y / z change their signs with z.
    let mirrored = Ray { x: -ray.x, y: -ray.y, z: -ray.z };
    Some(camera.project(mirrored).map_or(f64::INFINITY, |found| found.distance(at)))
}

#[cfg(test)]
mod tests {
    use calibench_model::camera::{ImageSize, OpenCvFisheye};

    use super::*;

    #[test]
    fn an_equidistant_lens_is_cut_by_a_circle() {
        let size = ImageSize { width: 1000, height: 1000 };
        let of = |f: f64| Camera::from(OpenCvFisheye { size, fx: f, fy: f, cx: 499.5, cy: 499.5, skew: 0.0, k: [0.0; 4] });
        let found = behind(&of(300.0)).unwrap();
        // The circle of 90 degrees lies inside the frame; a corner at 135 degrees goes to 45 on the other side.
        let radius = 300.0 * std::f64::consts::FRAC_PI_2;
        assert!((found.share - (1.0 - std::f64::consts::PI * radius * radius / 1e6)).abs() < 1e-3, "{}", found.share);
        assert!((found.elsewhere_px - std::f64::consts::PI * 300.0).abs() < 1.0, "{}", found.elsewhere_px);
        assert!(behind(&of(500.0)).is_none());
    }
}
