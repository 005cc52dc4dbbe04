//! Where a camera stops being one to one.

use super::{CameraModel, ImageSize, Ray, without_ray};
use crate::{CornerPoint, PixelPoint};

/// Directions in which the edge of the fold is looked for.
const DIRECTIONS: usize = 1440;

/// A fold inside the frame: beyond it, no pixel has one ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fold {
    /// Smallest distance of the fold from the image of the axis, px.
    pub radius_px: f64,
    /// Share of the frame that has no ray, 0 to 1: [`without_ray`].
    pub share: f64,
}

/// The fold of `camera` inside its frame (the outer corners of the pixels), if it has one. A camera with a fold cannot give truth for the full frame.
pub fn fold(camera: &dyn CameraModel) -> Option<Fold> {
    fold_radius(camera).map(|radius_px| Fold { radius_px, share: without_ray(camera) })
}

/// [`Fold::radius_px`] alone, at a small part of the cost: that of the nearest of 1440 directions, each located to the last bits.
pub fn fold_radius(camera: &dyn CameraModel) -> Option<f64> {
    if camera.has_surely_no_fold() {
        return None;
    }
    let centre = camera.project(Ray::from_tangent(0.0, 0.0)).ok()?;
    let inside = |point: &PixelPoint| is_inside(camera.size(), *point);
    let angles = (0..DIRECTIONS).map(|i| std::f64::consts::TAU * i as f64 / DIRECTIONS as f64);
    let to_corners = corners(camera.size()).map(|corner| (corner.y - centre.y).atan2(corner.x - centre.x));
    let edge = angles.chain(to_corners).filter_map(|angle| camera.fold_towards(angle)).filter(inside);
    edge.map(|point| point.distance(centre)).min_by(f64::total_cmp)
}

/// The outer corners of a frame.
pub(super) fn corners(size: ImageSize) -> [PixelPoint; 4] {
    let (width, height) = (f64::from(size.width), f64::from(size.height));
    [(0.0, 0.0), (width, 0.0), (0.0, height), (width, height)].map(|(x, y)| CornerPoint { x, y }.to_pixel())
}

/// Whether a position lies in a frame.
pub(super) fn is_inside(size: ImageSize, point: PixelPoint) -> bool {
    let corner = point.to_corner();
    (0.0..=f64::from(size.width)).contains(&corner.x) && (0.0..=f64::from(size.height)).contains(&corner.y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{Ebner, NoCounterpart, OpenCv, OpenCvFisheye, Photogrammetric};

    /// The search alone.
    struct Searched<'a>(&'a dyn CameraModel);

    impl CameraModel for Searched<'_> {
        fn size(&self) -> ImageSize {
            self.0.size()
        }
        fn parameters(&self) -> Vec<crate::camera::CameraParameter> {
            self.0.parameters()
        }
        fn with_parameters(&self, _: &[f64]) -> Self {
            Searched(self.0)
        }
        fn project(&self, ray: Ray) -> Result<PixelPoint, NoCounterpart> {
            self.0.project(ray)
        }
        fn unproject(&self, point: PixelPoint) -> Result<Ray, NoCounterpart> {
            self.0.unproject(point)
        }
        fn derivatives_into(&self, ray: Ray, into: &mut crate::camera::DerivativeBuffer) -> Result<(), NoCounterpart> {
            self.0.derivatives_into(ray, into)
        }
        fn fold_towards(&self, angle: f64) -> Option<PixelPoint> {
            self.0.fold_towards(angle)
        }
    }

    #[test]
    fn what_is_surely_without_a_fold_has_none() {
        let size = ImageSize { width: 640, height: 480 };
        let (mut sure, mut folded) = ([0; 4], [0; 4]);
        for i in 0..400_u32 {
            // Coefficients of every sign and size, principal points beside the middle.
            let part = |shift: u32, scale: f64| {
                scale * (f64::from(i.wrapping_mul(2_654_435_761).rotate_left(shift) >> 8) / f64::from(1 << 24) - 0.5)
            };
            let mut distortion = [0.0; 14];
            distortion[..5].copy_from_slice(&[part(0, 1.2), part(5, 0.8), part(9, 0.1), part(13, 0.1), part(17, 0.6)]);
            let (cx, cy) = (320.0 + part(21, 200.0), 240.0 + part(25, 200.0));
            let pinhole = OpenCv { size, fx: 500.0, fy: 480.0, cx, cy, distortion, coefficients: 5 };
            let k = [part(0, 0.4), part(5, 0.2), part(9, 0.1), part(13, 0.02)];
            let fisheye = OpenCvFisheye { size, fx: 260.0, fy: 255.0, cx, cy, skew: part(17, 0.1), k };
            // Half a frame has 3.2 x 2.4 mm: coefficients that fold at its corners, or nearly.
            let (k, p) = ([part(0, 0.1), part(5, 0.004), part(9, 1e-4)], [part(13, 0.02), part(17, 0.02)]);
            let (x0, y0, b) = (part(21, 2.0), part(25, 2.0), [part(3, 0.1), part(7, 0.1)]);
            let measured = Photogrammetric { size, pitch_um: 10.0, c: 5.0, x0, y0, k, p, b };
            let parameters = std::array::from_fn(|j| part(2 * j as u32, 0.03 * f64::from(i % 8)));
            let ebner = Ebner { base: Photogrammetric { k: [0.0; 3], p: [0.0; 2], ..measured }, b_mm: 4.0, parameters };
            // The search takes its time.
            let fewer = if i < 100 { 4 } else { 2 };
            for (kind, camera) in [&pinhole as &dyn CameraModel, &fisheye, &measured, &ebner].into_iter().enumerate().take(fewer) {
                let found = fold(&Searched(camera));
                if camera.has_surely_no_fold() {
                    sure[kind] += 1;
                    assert_eq!(found, None, "{pinhole:?} {fisheye:?} {measured:?} {ebner:?}");
                }
                folded[kind] += usize::from(found.is_some());
            }
        }
        assert!(sure[0] + sure[1] > 150 && folded[0] + folded[1] > 150, "{sure:?} {folded:?}");
        assert!(sure[2..].iter().chain(&folded[2..]).all(|&count| count > 10), "{sure:?} {folded:?}");
    }
}
