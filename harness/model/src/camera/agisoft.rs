//! The frame cameras of Agisoft: Metashape, PhotoScan, Lens.

use serde::{Deserialize, Serialize};

use super::convention::{Convention, Direction, PixelOrigin, TangentialOrder, Verification, Vertical};
use super::newton::ValueAndDerivatives;
use super::pinhole::{Affinity, Brown, Pinhole};
use super::{CameraParameter, DerivativeBuffer, ImageSize, Reframe, Resampling, Turn, named};
use crate::{CornerPoint, PixelPoint};

/// Whose formulas and origins an [`Agisoft`] camera follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum AgisoftVersion {
    /// PhotoScan from 1.2 and Metashape: f, b1, b2, cx and cy from the centre of the frame, Brown's order of p1 and p2.
    Metashape,
    /// PhotoScan before 1.2: fx, fy, skew, cx and cy from the corner of the first pixel, OpenCV's order of p1 and p2.
    PhotoScan,
    /// Lens 0.4: fx, fy, skew, cx and cy from the corner of the first pixel, OpenCV's order of p1 and p2.
    Lens,
}

/// Agisoft's frame camera. Direction: **ideal to distorted**; y points down; the outer corner of the first pixel is (0, 0); normalised by the focal
/// length.
///
/// With `x = X/Z`, `y = Y/Z` (x right, y down, z forward), `r2 = x^2 + y^2` and `q = 1 + k1 r2 + k2 r2^2 + k3 r2^3 + k4 r2^4`:
///
/// - [`AgisoftVersion::Metashape`]: `x' = x q + (p1 (r2 + 2 x^2) + 2 p2 x y) (1 + p3 r2 + p4 r2^2)`,
///   `y' = y q + (p2 (r2 + 2 y^2) + 2 p1 x y) (1 + p3 r2 + p4 r2^2)`, `u = W/2 + cx + f x' + b1 x' + b2 y'`, `v = H/2 + cy + f y'`;
/// - the older ones: `x' = x q + p2 (r2 + 2 x^2) + 2 p1 x y`, `y' = y q + p1 (r2 + 2 y^2) + 2 p2 x y`, `u = cx + fx x' + skew y'`, `v = cy + fy y'`,
///   kept here as `f = fy`, `b1 = fx - fy`, `b2 = skew`; their k4, p3 and p4 are zero.
///
/// Source: Agisoft Metashape and PhotoScan 1.2 user manuals, appendix "Camera models"; Lens 0.4 user manual; Agisoft's answer in its forum, topic
/// 6437, for `f = fy`, `b1 = fx - fy`, `b2 = skew`. What is confirmed by numbers: [`super::Convention::verification`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Agisoft {
    /// Size of its images.
    pub size: ImageSize,
    /// Whose formulas hold.
    pub version: AgisoftVersion,
    /// Focal length, px; that along y of the older versions.
    pub f: f64,
    /// Principal point, x, px: from the centre of the frame (`Metashape`) or from the corner of the first pixel.
    pub cx: f64,
    /// Principal point, y, px downwards: from the centre of the frame (`Metashape`) or from the corner of the first pixel.
    pub cy: f64,
    /// Affinity, px: fx - fy.
    pub b1: f64,
    /// Shear, px: the older versions' skew.
    pub b2: f64,
    /// k1 to k4, numbers.
    pub k: [f64; 4],
    /// p1 to p4, numbers, in the version's order.
    pub p: [f64; 4],
}

/// The convention of [`AgisoftVersion::Metashape`].
pub const METASHAPE: Convention = Convention {
    name: "metashape",
    about: "Agisoft Metashape: f, cx, cy, K1 to K4, P1 to P4, B1, B2",
    version: "PhotoScan from 1.2, Metashape",
    direction: Direction::IdealToDistorted,
    pixel_origin: PixelOrigin::PixelCorner,
    principal_point_from: PixelOrigin::FrameCentre,
    y: Vertical::Down,
    order: TangentialOrder::Brown,
    normalisation: "divided by f, px",
    source: "Agisoft Metashape User Manual, appendix Camera models",
    verification: Verification::Verified(
        "f, cx, cy, K1, K2, P1, P2 by the tool's own OpenCV export of the same adjustment; B1, B2, P3 and P4 by the manual only",
    ),
};

/// The convention of [`AgisoftVersion::PhotoScan`].
pub const PHOTOSCAN: Convention = Convention {
    name: "photoscan",
    about: "Agisoft PhotoScan before 1.2: fx, fy, cx, cy, skew, K1 to K3, P1, P2",
    version: "PhotoScan before 1.2",
    principal_point_from: PixelOrigin::PixelCorner,
    order: TangentialOrder::OpenCv,
    normalisation: "divided by fx, fy, px",
    source: "Agisoft Lens 0.4 User Manual, appendix; Agisoft's forum, topic 6437",
    verification: Verification::Unverified(
        "order of P1 and P2 after the manual of Lens; whether cx = 0 is the corner or the centre of the first pixel is not stated: the corner is assumed",
    ),
    ..METASHAPE
};

/// The convention of [`AgisoftVersion::Lens`].
pub const LENS: Convention = Convention {
    name: "agisoft-lens",
    about: "Agisoft Lens: fx, fy, cx, cy, skew, K1 to K3, P1, P2",
    version: "0.4",
    source: "Agisoft Lens 0.4 User Manual, appendix",
    verification: Verification::Unverified(
        "formulas after the manual; whether cx = 0 is the corner or the centre of the first pixel is not stated: the corner is assumed",
    ),
    ..PHOTOSCAN
};

const NAMES: [(&str, &str); 13] = [
    ("f", "px"),
    ("cx", "px"),
    ("cy", "px"),
    ("b1", "px"),
    ("b2", "px"),
    ("k1", ""),
    ("k2", ""),
    ("k3", ""),
    ("k4", ""),
    ("p1", ""),
    ("p2", ""),
    ("p3", ""),
    ("p4", ""),
];
/// Places in [`NAMES`] of what the older versions have.
const OLD: [usize; 10] = [0, 1, 2, 3, 4, 5, 6, 7, 9, 10];

impl AgisoftVersion {
    /// Its convention.
    pub const fn convention(self) -> &'static Convention {
        match self {
            Self::Metashape => &METASHAPE,
            Self::PhotoScan => &PHOTOSCAN,
            Self::Lens => &LENS,
        }
    }
}

impl Agisoft {
    fn is_old(&self) -> bool {
        self.version != AgisoftVersion::Metashape
    }

    fn brown(&self) -> Brown {
        let ([k1, k2, k3, _], [p1, p2, ..]) = (self.k, self.p);
        if self.is_old() { Brown { k: [k1, k2, k3, 0.0], p: [p2, p1, 0.0, 0.0] } } else { Brown { k: self.k, p: self.p } }
    }

    fn values(&self) -> [f64; 13] {
        let ([k1, k2, k3, k4], [p1, p2, p3, p4]) = (self.k, self.p);
        [self.f, self.cx, self.cy, self.b1, self.b2, k1, k2, k3, k4, p1, p2, p3, p4]
    }

    /// The parameters of the version among all thirteen.
    fn own<T: Copy>(&self, all: [T; 13]) -> Vec<T> {
        if self.is_old() { OLD.map(|i| all[i]).into() } else { all.into() }
    }
}

impl Pinhole for Agisoft {
    fn image_size(&self) -> ImageSize {
        self.size
    }

    fn named_parameters(&self) -> Vec<CameraParameter> {
        named(&self.own(NAMES), &self.own(self.values()))
    }

    fn with_values(&self, values: &[f64]) -> Self {
        let mut v = self.values();
        for (place, value) in self.own(std::array::from_fn(|i| i)).into_iter().zip(values) {
            v[place] = *value;
        }
        let (k, p) = ([v[5], v[6], v[7], v[8]], [v[9], v[10], v[11], v[12]]);
        Self { f: v[0], cx: v[1], cy: v[2], b1: v[3], b2: v[4], k, p, ..*self }
    }

    fn distort(&self, ideal: [f64; 2]) -> ValueAndDerivatives {
        self.brown().distort(ideal)
    }

    fn affinity(&self) -> Affinity {
        let half = |length: u32| if self.is_old() { 0.0 } else { f64::from(length) / 2.0 };
        let shift = CornerPoint { x: half(self.size.width) + self.cx, y: half(self.size.height) + self.cy };
        Affinity { a: self.f + self.b1, b: self.b2, d: self.f, shift: shift.to_pixel() }
    }

    fn by_parameters(&self, ideal: [f64; 2], distorted @ [x, y]: [f64; 2], into: &mut DerivativeBuffer) {
        let Affinity { a, b, d, .. } = self.affinity();
        let [k1, k2, k3, k4, first, second, p3, p4] = self.brown().by_coefficients(ideal).map(|[x, y]| [a * x + b * y, d * y]);
        let (p1, p2) = if self.is_old() { (second, first) } else { (first, second) };
        let all = [distorted, [1.0, 0.0], [0.0, 1.0], [x, 0.0], [y, 0.0], k1, k2, k3, k4, p1, p2, p3, p4];
        if self.is_old() {
            into.extend(OLD.map(|i| all[i]));
        } else {
            into.extend(all);
        }
    }

    fn is_surely_one_to_one(&self, radius: f64) -> bool {
        self.brown().is_surely_one_to_one(radius)
    }
}

/// f, b1, b2 of `u = (f + b1) x + b2 y`, `v = f y` in resampled images.
pub(super) fn resampled_affinity([f, b1, b2]: [f64; 3], by: &Resampling) -> [f64; 3] {
    let [along, down] = by.scale;
    [down * f, along * b1 + (along - down) * f, along * b2]
}

/// The same in turned images, where b2 is zero or they are turned by 180 degrees.
pub(super) fn turned_affinity([f, b1, b2]: [f64; 3], turn: Turn) -> [f64; 3] {
    if turn.swaps_axes() { [f + b1, 0.0 - b1, b2] } else { [f, b1, b2] }
}

impl Agisoft {
    /// The camera of images of `size` whose principal point is at `at`.
    fn centred(&self, at: PixelPoint, size: ImageSize, [f, b1, b2]: [f64; 3]) -> Self {
        let (corner, half) = (at.to_corner(), |length: u32| if self.is_old() { 0.0 } else { f64::from(length) / 2.0 });
        Self { size, f, b1, b2, cx: corner.x - half(size.width), cy: corner.y - half(size.height), ..*self }
    }
}

impl Reframe for Agisoft {
    fn resampled(&self, by: &Resampling) -> Self {
        let affinity = resampled_affinity([self.f, self.b1, self.b2], by);
        self.centred(by.point(self.affinity().shift), by.size, affinity)
    }

    fn without_place(&self, turn: Turn) -> Option<&'static str> {
        (turn.swaps_axes() && self.b2 != 0.0).then_some("b2")
    }

    fn turned(&self, turn: Turn) -> Self {
        let [first, second, p3, p4] = self.p;
        let (first, second) = if self.is_old() {
            let [second, first] = turn.vector([second, first]);
            (first, second)
        } else {
            turn.vector([first, second]).into()
        };
        let affinity = turned_affinity([self.f, self.b1, self.b2], turn);
        let turned = self.centred(turn.point(self.size, self.affinity().shift), turn.size(self.size), affinity);
        Self { p: [first, second, p3, p4], ..turned }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::conformance::{self, Shape};
    use crate::camera::{CameraModel, OpenCv, Ray};

    const SIZE: ImageSize = ImageSize { width: 6012, height: 4008 };

    fn camera(version: AgisoftVersion) -> Agisoft {
        let (cx, cy) = if version == AgisoftVersion::Metashape { (7.744, -60.025) } else { (3013.7, 1943.9) };
        let (k, p) = ([-0.094_183, 0.085_53, -0.01, 0.002], [1.689e-4, -8.746e-4, 0.1, -0.2]);
        Agisoft { size: SIZE, version, f: 6621.74, cx, cy, b1: 0.676, b2: -1.202, k, p }
    }

    #[test]
    fn conforms() {
        for version in [AgisoftVersion::Metashape, AgisoftVersion::PhotoScan, AgisoftVersion::Lens] {
            conformance::check(&camera(version), Shape::Barrel);
        }
    }

    #[test]
    fn metashape_s_two_exports_of_one_camera_agree() {
        let (k, p) = (
            [-0.094_183_039_435_621_31, 0.085_530_352_851_453, 0.0, 0.0],
            [0.000_168_948_638_308_769_24, -0.000_874_637_609_310_216_4, 0.0, 0.0],
        );
        let (f, cx, cy) = (6_621.743_457_206_283, 7.744_200_570_865_082, -60.025_385_337_767_01);
        let own = Agisoft { size: SIZE, version: AgisoftVersion::Metashape, f, cx, cy, b1: 0.0, b2: 0.0, k, p };
        let mut distortion = [0.0; 14];
        let five = [
            -9.418_303_943_562_134e-2,
            8.553_035_285_145_32e-2,
            -8.746_376_093_102_167e-4,
            1.689_486_383_087_698_6e-4,
            -5.024_210_632_290_122e-16,
        ];
        distortion[..5].copy_from_slice(&five);
        let other = OpenCv { size: SIZE, fx: f, fy: f, cx: 3_013.244_200_570_865, cy: 1_943.474_614_662_233, distortion, coefficients: 5 };
        for (x, y) in [(0.0, 0.0), (0.44, 0.3), (-0.45, 0.29), (0.2, -0.31)] {
            let ray = Ray::from_tangent(x, y);
            assert!(own.project(ray).unwrap().distance(other.project(ray).unwrap()) < 1e-9);
        }
    }
}
