//! How much of a frame has no ray.

use super::CameraModel;
use crate::{CornerPoint, PixelPoint};

/// Columns and rows of cells.
const CELLS: (usize, usize) = (60, 40);
/// Parts of a cell along a side where some of its corners have a ray and some have none.
const PARTS: usize = 8;

/// Share of the frame (to the outer corners of its pixels) that has no ray, 0 to 1, to 5e-4: cells that the border of the rays crosses are looked at in 64 parts.
pub fn without_ray(camera: &dyn CameraModel) -> f64 {
    let ((columns, rows), size) = (CELLS, camera.size());
    let place = |column: f64, row: f64| -> PixelPoint {
        CornerPoint { x: f64::from(size.width) * column / columns as f64, y: f64::from(size.height) * row / rows as f64 }.to_pixel()
    };
    let is_lost = |column: f64, row: f64| camera.unproject(place(column, row)).is_err();
    let node = |i: usize| is_lost((i % (columns + 1)) as f64, (i / (columns + 1)) as f64);
    let nodes: Vec<bool> = (0..(columns + 1) * (rows + 1)).map(node).collect();
    let part = |i: usize| (i as f64 + 0.5) / PARTS as f64;
    let cell = |i: usize| {
        let (column, row) = (i % columns, i / columns);
        let first = row * (columns + 1) + column;
        let corners = [first, first + 1, first + columns + 1, first + columns + 2].map(|corner| nodes[corner]);
        if corners.iter().all(|corner| *corner == corners[0]) {
            return f64::from(u8::from(corners[0]));
        }
        let lost = (0..PARTS * PARTS).filter(|i| is_lost(column as f64 + part(i % PARTS), row as f64 + part(i / PARTS))).count();
        lost as f64 / (PARTS * PARTS) as f64
    };
    (0..columns * rows).map(cell).sum::<f64>() / (columns * rows) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{Camera, DoubleSphere, ImageSize, OpenCv, OpenCvFisheye};

    #[test]
    fn the_share_is_that_of_all_pixels() {
        let size = ImageSize { width: 1280, height: 960 };
        let (cx, cy) = (610.0, 500.0);
        let folded = |k1: f64| {
            let mut distortion = [0.0; 14];
            distortion[0] = k1;
            Camera::from(OpenCv { size, fx: 900.0, fy: 890.0, cx, cy, distortion, coefficients: 5 })
        };
        let cameras = [
            folded(-0.5),
            folded(-0.7),
            folded(-1.5),
            folded(-0.1),
            OpenCvFisheye { size, fx: 260.0, fy: 260.0, cx, cy, skew: 0.0, k: [-0.05, 0.0, 0.0, 0.0] }.into(),
            DoubleSphere { size, fx: 250.0, fy: 250.0, cx, cy, xi: 0.3, alpha: 0.7 }.into(),
        ];
        let mut some = 0;
        for camera in cameras {
            // Every fourth pixel along each side.
            let pixels = (0..320_u32 * 240).map(|i| {
                let place = |i: u32, count: u32, length: u32| (f64::from(i) + 0.5) / f64::from(count) * f64::from(length);
                CornerPoint { x: place(i % 320, 320, size.width), y: place(i / 320, 240, size.height) }.to_pixel()
            });
            let lost = pixels.filter(|&pixel| camera.unproject(pixel).is_err()).count();
            let (found, all) = (without_ray(&camera), lost as f64 / f64::from(320 * 240));
            some += usize::from(all > 0.01 && all < 0.99);
            assert!((found - all).abs() < 7e-4, "{found} {all} {camera:?}");
        }
        assert!(some > 2, "{some}");
    }
}
