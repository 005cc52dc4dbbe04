//! MicMac's frame cameras: a polynomial in pixels around a centre of its own.

use serde::{Deserialize, Serialize};

use super::convention::{Convention, Direction, PixelOrigin, TangentialOrder, Verification, Vertical};
use super::newton::ValueAndDerivatives;
use super::pinhole::{Affinity, Pinhole};
use super::plane_map::is_one_to_one;
use super::{CameraParameter, DerivativeBuffer, ImageSize, Reframe, Resampling, Turn, named};
use crate::PixelPoint;

/// MicMac's camera with `ModRad` or `ModPhgrStd` (Fraser). Direction: **ideal to image** (`eConvApero_DistM2C`); y points down; px throughout.
///
/// With the ideal pixel `q = PP + F (X/Z, Y/Z)` (x right, y down, z forward), `(x, y) = q - CDist`, `r2 = x^2 + y^2`,
/// `s = k1 r2 + k2 r2^2 + ... + k5 r2^5`: `u = q_x + x s + p1 (r2 + 2 x^2) + 2 p2 x y + b1 x + b2 y`,
/// `v = q_y + y s + p2 (r2 + 2 y^2) + 2 p1 x y`. The centre of the distortion is kept here as `CDist - PP`.
///
/// Source: MicMac, Apero and MicMac in a nutshell, section on calibration files; the reader of iTowns.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MicMac {
    /// Size of its images.
    pub size: ImageSize,
    /// Focal length, px.
    pub f: f64,
    /// Principal point PP: x, y, px from the centre of the first pixel.
    pub pp: [f64; 2],
    /// Centre of the distortion from the principal point: x, y, px.
    pub offset: [f64; 2],
    /// k1 to k5: px^-2 to px^-10.
    pub k: [f64; 5],
    /// p1, p2: px^-1, in Brown's order.
    pub p: [f64; 2],
    /// b1, b2, numbers.
    pub b: [f64; 2],
}

/// The convention of [`MicMac`].
pub const CONVENTION: Convention = Convention {
    name: "micmac",
    about: "MicMac: F, PP, CDist, k1 to k5, P1, P2, b1, b2 in pixels",
    version: "Apero's AutoCal with eConvApero_DistM2C",
    direction: Direction::IdealToDistorted,
    pixel_origin: PixelOrigin::PixelCentre,
    principal_point_from: PixelOrigin::PixelCentre,
    y: Vertical::Down,
    order: TangentialOrder::Brown,
    normalisation: "none: px from CDist",
    source: "MicMac's documentation of calibration files; the reader of iTowns",
    verification: Verification::Unverified(
        "formulas by a second program's reader, no numbers of MicMac's own; whether (0, 0) is the centre or the corner of the first pixel is not stated: \
         the centre is assumed",
    ),
};

const NAMES: [(&str, &str); 14] = [
    ("F", "px"),
    ("PPx", "px"),
    ("PPy", "px"),
    ("ex", "px"),
    ("ey", "px"),
    ("k1", "px^-2"),
    ("k2", "px^-4"),
    ("k3", "px^-6"),
    ("k4", "px^-8"),
    ("k5", "px^-10"),
    ("p1", "px^-1"),
    ("p2", "px^-1"),
    ("b1", ""),
    ("b2", ""),
];

impl MicMac {
    /// The displacement at px from the centre of the distortion, with its derivatives.
    fn displacement(&self, [x, y]: [f64; 2]) -> ValueAndDerivatives {
        let ([k1, k2, k3, k4, k5], [p1, p2], [b1, b2]) = (self.k, self.p, self.b);
        let r2 = x * x + y * y;
        let s = r2 * (k1 + r2 * (k2 + r2 * (k3 + r2 * (k4 + r2 * k5))));
        let slope = 2.0 * (k1 + r2 * (2.0 * k2 + r2 * (3.0 * k3 + r2 * (4.0 * k4 + r2 * 5.0 * k5))));
        let value =
            [x * s + p1 * (r2 + 2.0 * x * x) + 2.0 * p2 * x * y + b1 * x + b2 * y, y * s + p2 * (r2 + 2.0 * y * y) + 2.0 * p1 * x * y];
        let cross = x * y * slope + 2.0 * (p1 * y + p2 * x);
        let by =
            [[s + x * x * slope + 6.0 * p1 * x + 2.0 * p2 * y + b1, cross + b2], [cross, s + y * y * slope + 6.0 * p2 * y + 2.0 * p1 * x]];
        (value, by)
    }

    fn about_centre(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [self.f * x - self.offset[0], self.f * y - self.offset[1]]
    }
}

impl Pinhole for MicMac {
    fn image_size(&self) -> ImageSize {
        self.size
    }

    fn named_parameters(&self) -> Vec<CameraParameter> {
        let mut values = vec![self.f, self.pp[0], self.pp[1], self.offset[0], self.offset[1]];
        values.extend(self.k.iter().chain(&self.p).chain(&self.b));
        named(&NAMES, &values)
    }

    fn with_values(&self, v: &[f64]) -> Self {
        let k = [v[5], v[6], v[7], v[8], v[9]];
        Self { f: v[0], pp: [v[1], v[2]], offset: [v[3], v[4]], k, p: [v[10], v[11]], b: [v[12], v[13]], ..*self }
    }

    fn distort(&self, ideal @ [x, y]: [f64; 2]) -> ValueAndDerivatives {
        let ([dx, dy], by) = self.displacement(self.about_centre(ideal));
        ([x + dx / self.f, y + dy / self.f], [[1.0 + by[0][0], by[0][1]], [by[1][0], 1.0 + by[1][1]]])
    }

    fn affinity(&self) -> Affinity {
        Affinity { a: self.f, b: 0.0, d: self.f, shift: PixelPoint::new(self.pp[0], self.pp[1]) }
    }

    fn by_parameters(&self, ideal: [f64; 2], _distorted: [f64; 2], into: &mut DerivativeBuffer) {
        let at @ [x, y] = self.about_centre(ideal);
        let (_, by) = self.displacement(at);
        let r2 = x * x + y * y;
        let moved = |[dx, dy]: [f64; 2]| [dx + by[0][0] * dx + by[0][1] * dy, dy + by[1][0] * dx + by[1][1] * dy];
        into.extend([moved(ideal), [1.0, 0.0], [0.0, 1.0], [-by[0][0], -by[1][0]], [-by[0][1], -by[1][1]]]);
        into.extend((1..=5).map(|power| [x * r2.powi(power), y * r2.powi(power)]));
        into.extend([[r2 + 2.0 * x * x, 2.0 * x * y], [2.0 * x * y, r2 + 2.0 * y * y], [x, 0.0], [y, 0.0]]);
    }

    fn is_surely_one_to_one(&self, radius: f64) -> bool {
        self.offset == [0.0; 2] && is_one_to_one(radius * self.f, &self.k, &self.p, self.b[0].abs() + self.b[1].abs())
    }
}

impl Reframe for MicMac {
    fn has_two_scales(&self) -> bool {
        false
    }

    fn resampled(&self, by: &Resampling) -> Self {
        let (at, s) = (by.point(PixelPoint::new(self.pp[0], self.pp[1])), by.scale[0]);
        let mut k = self.k;
        for (k, power) in k.iter_mut().zip(1..) {
            *k /= s.powi(2 * power);
        }
        let (offset, p) = (self.offset.map(|e| s * e), self.p.map(|p| p / s));
        Self { size: by.size, f: s * self.f, pp: [at.x, at.y], offset, k, p, ..*self }
    }

    fn without_place(&self, turn: Turn) -> Option<&'static str> {
        (turn.swaps_axes() && self.b != [0.0; 2]).then_some("b1 or b2")
    }

    fn turned(&self, turn: Turn) -> Self {
        let at = turn.point(self.size, PixelPoint::new(self.pp[0], self.pp[1]));
        Self { size: turn.size(self.size), pp: [at.x, at.y], offset: turn.vector(self.offset), p: turn.vector(self.p), ..*self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::conformance::{self, Shape};
    use crate::camera::{CameraModel, Ray};

    fn camera() -> MicMac {
        let (k, p, b) = ([-3.1e-9, 4.2e-17, -1e-25, 1e-35, -1e-43], [2e-8, -5e-8], [1e-4, -2e-4]);
        MicMac { size: ImageSize { width: 5616, height: 3744 }, f: 5800.0, pp: [2790.0, 1880.0], offset: [12.0, -7.0], k, p, b }
    }

    #[test]
    fn conforms() {
        conformance::check(&camera(), Shape::Barrel);
    }

    #[test]
    fn the_formula_at_one_ray() {
        let camera = MicMac { p: [0.0; 2], b: [0.0; 2], k: [-3.1e-9, 0.0, 0.0, 0.0, 0.0], ..camera() };
        let (x, y) = (5800.0 * 0.3 - 12.0, 5800.0 * 0.1 + 7.0);
        let s = -3.1e-9 * (x * x + y * y);
        let found = camera.project(Ray::from_tangent(0.3, -0.1)).unwrap();
        assert!(found.distance(PixelPoint::new(2790.0 + 5800.0 * 0.3 + x * s, 1880.0 + 5800.0 * 0.1 + y * s)) < 1e-9);
    }
}
