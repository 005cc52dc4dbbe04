//! A fisheye with six radial coefficients, decentring and thin prism at once: OpenSfM's `fisheye62` and `fisheye624`.

use serde::{Deserialize, Serialize};

use super::convention::{Convention, TangentialOrder, Verification};
use super::wide_angle::{Axial, Focal, Plane, axial_camera};
use super::{ImageSize, Turn, opencv_fisheye};

/// An equidistant fisheye with Brown's terms and four of a thin prism. Direction: **ideal to distorted**; y points down; the centre of the first pixel is (0, 0).
///
/// With the angle from the axis `theta`, `x = theta X / r`, `y = theta Y / r`, `r = sqrt(X^2 + Y^2)` (x right, y down, z forward), `t2 = x^2 + y^2`,
/// `q = 1 + k1 t2 + ... + k6 t2^6`: `x' = x q + 2 p1 x y + p2 (t2 + 2 x^2) + s0 t2 + s1 t2^2`, `y' = y q + p1 (t2 + 2 y^2) + 2 p2 x y + s2 t2 + s3 t2^2`,
/// `u = fx x' + cx`, `v = fy y' + cy`. Unlike [`super::RadTanPrismFisheye`], which has as many coefficients, all terms are of the angle that is not distorted yet.
///
/// Source: OpenSfM, Geometric Models, and `Disto62`, `Disto624` of its camera functions.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SixPrismFisheye {
    /// Size of its images.
    pub size: ImageSize,
    /// Focal length along x, px.
    pub fx: f64,
    /// Focal length along y, px.
    pub fy: f64,
    /// Principal point, x, px from the centre of the first pixel.
    pub cx: f64,
    /// Principal point, y, px downwards from the centre of the first pixel.
    pub cy: f64,
    /// k1 to k6, numbers.
    pub k: [f64; 6],
    /// p1, p2 in OpenCV's order, numbers.
    pub p: [f64; 2],
    /// Thin prism: s0, s1 along x, s2, s3 along y, numbers.
    pub s: [f64; 4],
}

/// The convention of [`SixPrismFisheye`].
pub const CONVENTION: Convention = Convention {
    name: "six-prism-fisheye",
    about: "fisheye with six radial coefficients, decentring and thin prism: fx, fy, cx, cy, k1 to k6, p1, p2, s0 to s3",
    version: "",
    order: TangentialOrder::OpenCv,
    source: "OpenSfM, Geometric Models: fisheye62, fisheye624",
    verification: Verification::Unverified("formulas after OpenSfM's documentation and source; its package was not at hand"),
    ..opencv_fisheye::CONVENTION
};

const NAMES: [(&str, &str); 12] = [
    ("k1", ""),
    ("k2", ""),
    ("k3", ""),
    ("k4", ""),
    ("k5", ""),
    ("k6", ""),
    ("p1", ""),
    ("p2", ""),
    ("s0", ""),
    ("s1", ""),
    ("s2", ""),
    ("s3", ""),
];

impl SixPrismFisheye {
    fn lens_values(&self) -> [f64; 12] {
        let ([k1, k2, k3, k4, k5, k6], [p1, p2], [s0, s1, s2, s3]) = (self.k, self.p, self.s);
        [k1, k2, k3, k4, k5, k6, p1, p2, s0, s1, s2, s3]
    }

    fn with_lens(self, v: &[f64]) -> Self {
        Self { k: [v[0], v[1], v[2], v[3], v[4], v[5]], p: [v[6], v[7]], s: [v[8], v[9], v[10], v[11]], ..self }
    }
}

impl Axial for SixPrismFisheye {
    fn focal(&self) -> Focal {
        Focal { size: self.size, fx: self.fx, fy: self.fy, cx: self.cx, cy: self.cy }
    }

    fn radius(&self, theta: f64) -> (f64, f64) {
        (theta, 1.0)
    }

    fn end(&self) -> f64 {
        std::f64::consts::PI
    }

    fn by_lens(&self, _theta: f64) -> Vec<f64> {
        Vec::new()
    }

    fn plane(&self) -> Option<Plane> {
        let [s0, s1, s2, s3] = self.s;
        Some(Plane { k: self.k, p: self.p, s: [s0, s2], s4: [s1, s3] })
    }

    fn plane_parameters(&self) -> &'static [usize] {
        &[0, 1, 4, 5, 10, 11, 2, 3, 6, 8, 7, 9]
    }

    fn with_turned_plane(self, turn: Turn) -> Self {
        // p2 goes with x.
        let [p2, p1] = turn.vector([self.p[1], self.p[0]]);
        let [s0, s1, s2, s3] = self.s;
        let ([s0, s2], [s1, s3]) = (turn.vector([s0, s2]), turn.vector([s1, s3]));
        Self { p: [p1, p2], s: [s0, s1, s2, s3], ..self }
    }
}

axial_camera!(SixPrismFisheye, NAMES);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::conformance::{self, Shape};
    use crate::camera::{CameraModel, PrismFisheye, Ray};

    fn camera() -> SixPrismFisheye {
        let (k, p, s) = ([-0.02, 0.006, -0.004, 5e-4, 1e-5, -2e-6], [4e-4, -3e-4], [2e-4, -1e-4, -5e-4, 3e-4]);
        SixPrismFisheye { size: ImageSize { width: 1600, height: 1200 }, fx: 520.0, fy: 521.0, cx: 803.2, cy: 598.7, k, p, s }
    }

    #[test]
    fn conforms() {
        conformance::check(&camera(), Shape::Barrel);
    }

    #[test]
    fn with_fewer_terms_it_is_the_prism_fisheye() {
        let ours = SixPrismFisheye { k: [-0.02, 0.006, -0.004, 5e-4, 0.0, 0.0], s: [2e-4, 0.0, -5e-4, 0.0], ..camera() };
        let SixPrismFisheye { size, fx, fy, cx, cy, p, .. } = ours;
        let other = PrismFisheye { size, fx, fy, cx, cy, k: [-0.02, 0.006, -0.004, 5e-4], p, s: [2e-4, -5e-4] };
        for (x, y, z) in [(0.0, 0.0, -1.0), (1.0, 0.5, -0.4), (-0.8, 0.9, 0.1)] {
            let ray = Ray { x, y, z };
            assert!(ours.project(ray).unwrap().distance(other.project(ray).unwrap()) < 1e-10);
        }
    }
}
