//! Pix4D's perspective camera.

use serde::{Deserialize, Serialize};

use super::convention::{Convention, Direction, PixelOrigin, TangentialOrder, Verification, Vertical};
use super::newton::ValueAndDerivatives;
use super::pinhole::{Affinity, Brown, Pinhole};
use super::{CameraParameter, DerivativeBuffer, ImageSize, Reframe, Resampling, Turn, named};
use crate::{CornerPoint, PixelPoint};

/// Pix4D's perspective camera. Direction: **ideal to distorted**; y points down as in its camera matrix; the outer corner of the first pixel is
/// (0, 0); normalised by the focal length.
///
/// With `x = X/Z`, `y = Y/Z` (x right, y down, z forward), `r2 = x^2 + y^2` and `q = 1 + r1 r2 + r2' r2^2 + r3 r2^3`, with the assumed order
/// [`TangentialOrder::OpenCv`]: `x' = x q + 2 t1 x y + t2 (r2 + 2 x^2)`, `y' = y q + 2 t2 x y + t1 (r2 + 2 y^2)`, `u = f x' + px`, `v = f y' + py`.
///
/// Source: Pix4D, "How are the Internal and External Camera Parameters defined?" (text; its formulas are pictures). Camera matrix, .cam file and
/// P-matrices of one project agree; the order and the signs of T1 and T2 are not confirmed by numbers, so the order is a field.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pix4d {
    /// Size of its images.
    pub size: ImageSize,
    /// Width of the sensor, mm: what makes mm of its files px.
    pub sensor_width_mm: f64,
    /// Focal length, px.
    pub f_px: f64,
    /// Principal point, x, px from the outer corner of the first pixel.
    pub px: f64,
    /// Principal point, y, px downwards from the outer corner of the first pixel.
    pub py: f64,
    /// R1, R2, R3, numbers.
    pub r: [f64; 3],
    /// T1, T2, numbers.
    pub t: [f64; 2],
    /// Order of T1 and T2: OpenCV's is assumed, not confirmed.
    pub order: TangentialOrder,
}

/// The convention of [`Pix4d`].
pub const CONVENTION: Convention = Convention {
    name: "pix4d",
    about: "Pix4D's perspective camera: F, Px, Py, R1 to R3, T1, T2",
    version: "PIX4Dmapper 2 and later",
    direction: Direction::IdealToDistorted,
    pixel_origin: PixelOrigin::PixelCorner,
    principal_point_from: PixelOrigin::PixelCorner,
    y: Vertical::Down,
    order: TangentialOrder::OpenCv,
    normalisation: "divided by F; files hold px or mm by the sensor's width",
    source: "Pix4D, How are the Internal and External Camera Parameters defined?",
    verification: Verification::Unverified(
        "camera matrix, .cam and P-matrices of one project agree; direction, order and signs of T1, T2 and the corner as origin are not confirmed by points",
    ),
};

const NAMES: [(&str, &str); 8] = [("F", "px"), ("Px", "px"), ("Py", "px"), ("R1", ""), ("R2", ""), ("R3", ""), ("T1", ""), ("T2", "")];

impl Pix4d {
    fn brown(&self) -> Brown {
        let [r1, r2, r3] = self.r;
        let [first, second] = if self.order == TangentialOrder::OpenCv { [self.t[1], self.t[0]] } else { self.t };
        Brown { k: [r1, r2, r3, 0.0], p: [first, second, 0.0, 0.0] }
    }

    /// The camera of images of `size` whose principal point is at `at`, of pixels that are `scale` times as many along a mm.
    fn centred(&self, at: PixelPoint, size: ImageSize, scale: f64) -> Self {
        let (corner, pitch_mm) = (at.to_corner(), self.sensor_width_mm / f64::from(self.size.width) / scale);
        Self { size, sensor_width_mm: pitch_mm * f64::from(size.width), f_px: scale * self.f_px, px: corner.x, py: corner.y, ..*self }
    }
}

impl Pinhole for Pix4d {
    fn image_size(&self) -> ImageSize {
        self.size
    }

    fn named_parameters(&self) -> Vec<CameraParameter> {
        let ([r1, r2, r3], [t1, t2]) = (self.r, self.t);
        named(&NAMES, &[self.f_px, self.px, self.py, r1, r2, r3, t1, t2])
    }

    fn with_values(&self, v: &[f64]) -> Self {
        Self { f_px: v[0], px: v[1], py: v[2], r: [v[3], v[4], v[5]], t: [v[6], v[7]], ..*self }
    }

    fn distort(&self, ideal: [f64; 2]) -> ValueAndDerivatives {
        self.brown().distort(ideal)
    }

    fn affinity(&self) -> Affinity {
        Affinity { a: self.f_px, b: 0.0, d: self.f_px, shift: CornerPoint { x: self.px, y: self.py }.to_pixel() }
    }

    fn by_parameters(&self, ideal: [f64; 2], distorted: [f64; 2], into: &mut DerivativeBuffer) {
        let scaled = self.brown().by_coefficients(ideal).map(|[x, y]| [self.f_px * x, self.f_px * y]);
        into.extend([distorted, [1.0, 0.0], [0.0, 1.0], scaled[0], scaled[1], scaled[2]]);
        into.extend(if self.order == TangentialOrder::OpenCv { [scaled[5], scaled[4]] } else { [scaled[4], scaled[5]] });
    }

    fn is_surely_one_to_one(&self, radius: f64) -> bool {
        self.brown().is_surely_one_to_one(radius)
    }
}

impl Reframe for Pix4d {
    fn has_two_scales(&self) -> bool {
        false
    }

    fn resampled(&self, by: &Resampling) -> Self {
        self.centred(by.point(self.affinity().shift), by.size, by.scale[0])
    }

    fn turned(&self, turn: Turn) -> Self {
        let t = if self.order == TangentialOrder::OpenCv {
            let [second, first] = turn.vector([self.t[1], self.t[0]]);
            [first, second]
        } else {
            turn.vector(self.t)
        };
        Self { t, ..self.centred(turn.point(self.size, self.affinity().shift), turn.size(self.size), 1.0) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::PixelPoint;
    use crate::camera::conformance::{self, Shape};
    use crate::camera::{CameraModel, Ray};

    fn camera(order: TangentialOrder) -> Pix4d {
        let (r, t) = ([-0.05, 0.015_629, -0.020_954], [-0.002_888, 0.001_965]);
        let size = ImageSize { width: 5472, height: 3648 };
        Pix4d { size, sensor_width_mm: 12.825, f_px: 4470.897, px: 2806.804, py: 1694.574, r, t, order }
    }

    #[test]
    fn conforms() {
        conformance::check(&camera(TangentialOrder::OpenCv), Shape::Barrel);
        conformance::check(&camera(TangentialOrder::Brown), Shape::Barrel);
    }

    #[test]
    fn the_order_of_t_is_the_field_s() {
        // On the x axis, r^2 + 2 x^2 = 3 x^2 belongs to T2 in OpenCV's order and to T1 in Brown's.
        for (order, t) in [(TangentialOrder::OpenCv, 0.001_965), (TangentialOrder::Brown, -0.002_888)] {
            let camera = Pix4d { r: [0.0; 3], ..camera(order) };
            let found = camera.project(Ray::from_tangent(0.5, 0.0)).unwrap();
            let expected = PixelPoint::new(2806.804 - 0.5 + 4470.897 * (0.5 + t * 0.75), found.y);
            assert!(found.distance(expected) < 1e-9);
        }
    }
}
