//! OpenCV's pinhole camera with up to fourteen distortion coefficients.

mod jacobian;
mod lens;
mod project;
mod region;
mod tilt;
mod undistort;

use serde::{Deserialize, Serialize};

use super::convention::{Convention, Direction, PixelOrigin, TangentialOrder, Verification, Vertical};
use super::newton::ValueAndDerivatives;
use super::pinhole::{Affinity, Pinhole};
use super::plane_map::{is_one_to_one, is_quotient_one_to_one};
use super::{CameraParameter, DerivativeBuffer, ImageSize, Reframe, Resampling, Turn, named};
use crate::PixelPoint;

pub use jacobian::{CameraFromWorld, Jacobian};
pub use project::Prepared;

/// OpenCV's camera. Direction: **ideal to distorted**; y points down; the centre of the first pixel is (0, 0); normalised by the focal length.
///
/// With `x = X/Z`, `y = Y/Z` (x right, y down, z forward), `r2 = x^2 + y^2` and
/// `q = (1 + k1 r2 + k2 r2^2 + k3 r2^3) / (1 + k4 r2 + k5 r2^2 + k6 r2^3)`:
/// `x'' = x q + 2 p1 x y + p2 (r2 + 2 x^2) + s1 r2 + s2 r2^2`, `y'' = y q + p1 (r2 + 2 y^2) + 2 p2 x y + s3 r2 + s4 r2^2`, then the tilt of the sensor
/// by `tx`, `ty`, then `u = fx x'' + cx`, `v = fy y'' + cy`.
///
/// Note the order of p1 and p2: p2 multiplies r^2 + 2 x^2, unlike Brown's.
///
/// Source: OpenCV 4.6, module calib3d, "Camera Calibration and 3D Reconstruction".
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct OpenCv {
    /// Size of its images.
    pub size: ImageSize,
    /// Focal length along x, px.
    pub fx: f64,
    /// Focal length along y, px.
    pub fy: f64,
    /// Principal point, x, px.
    pub cx: f64,
    /// Principal point, y, px downwards.
    pub cy: f64,
    /// k1, k2, p1, p2, k3, k4, k5, k6, s1, s2, s3, s4 (numbers), tx, ty (radians): OpenCV's order. Unused ones are zero.
    pub distortion: [f64; 14],
    /// How many of them the model has: 4, 5, 8, 12 or 14.
    pub coefficients: usize,
}

const NAMES: [(&str, &str); 18] = [
    ("fx", "px"),
    ("fy", "px"),
    ("cx", "px"),
    ("cy", "px"),
    ("k1", ""),
    ("k2", ""),
    ("p1", ""),
    ("p2", ""),
    ("k3", ""),
    ("k4", ""),
    ("k5", ""),
    ("k6", ""),
    ("s1", ""),
    ("s2", ""),
    ("s3", ""),
    ("s4", ""),
    ("tx", "rad"),
    ("ty", "rad"),
];

/// The convention of [`OpenCv`].
pub const CONVENTION: Convention = Convention {
    name: "opencv",
    about: "OpenCV's pinhole camera: fx, fy, cx, cy and 4, 5, 8, 12 or 14 coefficients",
    version: "OpenCV 3 and later",
    direction: Direction::IdealToDistorted,
    pixel_origin: PixelOrigin::PixelCentre,
    principal_point_from: PixelOrigin::PixelCentre,
    y: Vertical::Down,
    order: TangentialOrder::OpenCv,
    normalisation: "divided by fx, fy, px",
    source: "OpenCV, module calib3d, Camera Calibration and 3D Reconstruction",
    verification: Verification::Verified("projectPoints and undistortPoints, to 1e-9, for 4, 5, 8, 12 and 14 coefficients"),
};

/// Places of the coefficients in OpenCV's order.
const RADIAL: [usize; 3] = [0, 1, 4];
const DENOMINATOR: [usize; 3] = [5, 6, 7];

/// The terms before the tilt at one point.
struct Lens {
    r2: f64,
    /// The rational factor, and 1 / its denominator; not numbers at a pole and beyond.
    q: f64,
    inverse: f64,
    value: [f64; 2],
    by: [[f64; 2]; 2],
}

impl OpenCv {
    fn lens(&self, [x, y]: [f64; 2]) -> Lens {
        let [k1, k2, p1, p2, k3, k4, k5, k6, s1, s2, s3, s4, ..] = self.distortion;
        let r2 = x * x + y * y;
        let denominator = 1.0 + r2 * (k4 + r2 * (k5 + r2 * k6));
        // Beyond a pole the model says nothing.
        let inverse = if denominator > 0.0 { 1.0 / denominator } else { f64::NAN };
        let q = (1.0 + r2 * (k1 + r2 * (k2 + r2 * k3))) * inverse;
        let slope = 2.0 * inverse * (k1 + r2 * (2.0 * k2 + r2 * 3.0 * k3) - q * (k4 + r2 * (2.0 * k5 + r2 * 3.0 * k6)));
        let (prism_x, prism_y) = (2.0 * (s1 + 2.0 * r2 * s2), 2.0 * (s3 + 2.0 * r2 * s4));
        let cross = 2.0 * (p1 * x + p2 * y);
        let value = [
            x * q + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x) + r2 * (s1 + r2 * s2),
            y * q + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y + r2 * (s3 + r2 * s4),
        ];
        let by = [
            [q + x * x * slope + 2.0 * p1 * y + 6.0 * p2 * x + prism_x * x, x * y * slope + cross + prism_x * y],
            [x * y * slope + cross + prism_y * x, q + y * y * slope + 6.0 * p1 * y + 2.0 * p2 * x + prism_y * y],
        ];
        Lens { r2, q, inverse, value, by }
    }

    fn is_tilted(&self) -> bool {
        self.distortion[12] != 0.0 || self.distortion[13] != 0.0
    }
}

/// a b
pub(super) fn product(a: [[f64; 2]; 2], b: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
    std::array::from_fn(|row| std::array::from_fn(|column| a[row][0] * b[0][column] + a[row][1] * b[1][column]))
}

impl Pinhole for OpenCv {
    fn image_size(&self) -> ImageSize {
        self.size
    }

    fn named_parameters(&self) -> Vec<CameraParameter> {
        let mut values = vec![self.fx, self.fy, self.cx, self.cy];
        values.extend(&self.distortion[..self.coefficients.min(14)]);
        named(&NAMES, &values)
    }

    fn with_values(&self, values: &[f64]) -> Self {
        let mut distortion = self.distortion;
        distortion[..values.len() - 4].copy_from_slice(&values[4..]);
        Self { fx: values[0], fy: values[1], cx: values[2], cy: values[3], distortion, ..*self }
    }

    fn distort(&self, ideal: [f64; 2]) -> ValueAndDerivatives {
        let lens = self.lens(ideal);
        if !self.is_tilted() {
            return (lens.value, lens.by);
        }
        let (value, by) = tilt::Tilt::new(self.distortion[12], self.distortion[13]).apply(lens.value);
        (value, product(by, lens.by))
    }

    fn affinity(&self) -> Affinity {
        Affinity { a: self.fx, b: 0.0, d: self.fy, shift: PixelPoint::new(self.cx, self.cy) }
    }

    fn by_parameters(&self, ideal @ [x, y]: [f64; 2], distorted: [f64; 2], into: &mut DerivativeBuffer) {
        let Lens { r2, q, inverse, value, .. } = self.lens(ideal);
        let mut lens = [[0.0; 2]; 12];
        for (power, place) in (1..).zip(RADIAL) {
            let factor = r2.powi(power) * inverse;
            lens[place] = [x * factor, y * factor];
        }
        for (power, place) in (1..).zip(DENOMINATOR) {
            let factor = -q * r2.powi(power) * inverse;
            lens[place] = [x * factor, y * factor];
        }
        lens[2] = [2.0 * x * y, r2 + 2.0 * y * y];
        lens[3] = [r2 + 2.0 * x * x, 2.0 * x * y];
        (lens[8], lens[9], lens[10], lens[11]) = ([r2, 0.0], [r2 * r2, 0.0], [0.0, r2], [0.0, r2 * r2]);
        into.extend([[distorted[0], 0.0], [0.0, distorted[1]], [1.0, 0.0], [0.0, 1.0]]);
        let scaled = |[x, y]: [f64; 2]| [self.fx * x, self.fy * y];
        let coefficients = self.coefficients.min(14);
        if !self.is_tilted() && coefficients < 14 {
            return into.extend(lens.into_iter().take(coefficients).map(scaled));
        }
        let tilt = tilt::Tilt::new(self.distortion[12], self.distortion[13]);
        let (_, [of_x, of_y]) = tilt.apply(value);
        let lens = lens.map(|[x, y]| scaled([of_x[0] * x + of_x[1] * y, of_y[0] * x + of_y[1] * y]));
        into.extend(lens.into_iter().chain(tilt.by_angles(value).map(scaled)).take(coefficients));
    }

    fn is_surely_one_to_one(&self, radius: f64) -> bool {
        let d = &self.distortion;
        let (above, below) = ([d[0], d[1], d[4]], [d[5], d[6], d[7]]);
        let prism = 2.0 * radius * d[8].hypot(d[10]) + 4.0 * radius.powi(3) * d[9].hypot(d[11]);
        let by_polynomials = || match below {
            [0.0, 0.0, 0.0] => is_one_to_one(radius, &above, &d[2..4], prism),
            _ => is_quotient_one_to_one(radius, [above, below], &d[2..4], prism),
        };
        !self.is_tilted() && by_polynomials()
    }
}

impl Reframe for OpenCv {
    fn resampled(&self, by: &Resampling) -> Self {
        let (at, [fx, fy]) = (by.point(PixelPoint::new(self.cx, self.cy)), by.lengths([self.fx, self.fy]));
        Self { size: by.size, fx, fy, cx: at.x, cy: at.y, ..*self }
    }

    /// Tilts about both axes, one after the other, are in the other order none of two angles.
    fn without_place(&self, turn: Turn) -> Option<&'static str> {
        let is_tilted_twice = self.distortion[12] != 0.0 && self.distortion[13] != 0.0;
        (turn.swaps_axes() && is_tilted_twice).then_some("tx and ty together")
    }

    fn turned(&self, turn: Turn) -> Self {
        let (at, [fx, fy]) = (turn.point(self.size, PixelPoint::new(self.cx, self.cy)), turn.along([self.fx, self.fy]));
        let [k1, k2, p1, p2, k3, k4, k5, k6, s1, s2, s3, s4, tx, ty] = self.distortion;
        // p2 goes with x, s1 and s2 do, and s3 and s4 go with y.
        let ([p2, p1], [tx, ty]) = (turn.vector([p2, p1]), turn.vector([tx, ty]));
        let ([s1, s3], [s2, s4]) = (turn.vector([s1, s3]), turn.vector([s2, s4]));
        let distortion = [k1, k2, p1, p2, k3, k4, k5, k6, s1, s2, s3, s4, tx, ty];
        Self { size: turn.size(self.size), fx, fy, cx: at.x, cy: at.y, distortion, ..*self }
    }
}

#[cfg(test)]
mod tests;
