//! A fisheye with decentring and thin prism: COLMAP's `THIN_PRISM_FISHEYE`.

use serde::{Deserialize, Serialize};

use super::convention::{Convention, TangentialOrder, Verification};
use super::wide_angle::{Axial, Focal, Plane, axial_camera};
use super::{ImageSize, Turn, opencv_fisheye};

/// An equidistant fisheye with Brown's and thin prism terms. Direction: **ideal to distorted**; y points down; the centre of the first pixel is (0, 0).
///
/// With the angle from the axis `theta`, `x = theta X / r`, `y = theta Y / r`, `r = sqrt(X^2 + Y^2)` (x right, y down, z forward), `t2 = x^2 + y^2`,
/// `q = 1 + k1 t2 + k2 t2^2 + k3 t2^3 + k4 t2^4`: `x' = x q + 2 p1 x y + p2 (t2 + 2 x^2) + s1 t2`, `y' = y q + p1 (t2 + 2 y^2) + 2 p2 x y + s2 t2`,
/// `u = fx x' + cx`, `v = fy y' + cy`. Without p and s it is OpenCV's fisheye.
///
/// Source: COLMAP, `THIN_PRISM_FISHEYE` in its list of camera models; Schöps et al. 2017 (ETH3D).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PrismFisheye {
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
    /// k1 to k4, numbers.
    pub k: [f64; 4],
    /// p1, p2 in OpenCV's order, numbers.
    pub p: [f64; 2],
    /// Thin prism s1 along x and s2 along y, numbers.
    pub s: [f64; 2],
}

/// The convention of [`PrismFisheye`].
pub const CONVENTION: Convention = Convention {
    name: "prism-fisheye",
    about: "fisheye with decentring and thin prism: fx, fy, cx, cy, k1, k2, p1, p2, k3, k4, s1, s2",
    version: "",
    order: TangentialOrder::OpenCv,
    source: "COLMAP, list of camera models, THIN_PRISM_FISHEYE; Schöps et al. 2017",
    verification: Verification::Unverified("formulas after COLMAP's documentation; no projected point of it was at hand"),
    ..opencv_fisheye::CONVENTION
};

const NAMES: [(&str, &str); 8] = [("k1", ""), ("k2", ""), ("p1", ""), ("p2", ""), ("k3", ""), ("k4", ""), ("s1", ""), ("s2", "")];

impl PrismFisheye {
    fn lens_values(&self) -> [f64; 8] {
        let ([k1, k2, k3, k4], [p1, p2], [s1, s2]) = (self.k, self.p, self.s);
        [k1, k2, p1, p2, k3, k4, s1, s2]
    }

    fn with_lens(self, v: &[f64]) -> Self {
        Self { k: [v[0], v[1], v[4], v[5]], p: [v[2], v[3]], s: [v[6], v[7]], ..self }
    }
}

impl Axial for PrismFisheye {
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
        let [k1, k2, k3, k4] = self.k;
        Some(Plane { k: [k1, k2, k3, k4, 0.0, 0.0], p: self.p, s: self.s, s4: [0.0; 2] })
    }

    fn plane_parameters(&self) -> &'static [usize] {
        &[0, 1, 2, 3, 4, 5, 6, 7]
    }

    fn with_turned_plane(self, turn: Turn) -> Self {
        // p2 goes with x.
        let [p2, p1] = turn.vector([self.p[1], self.p[0]]);
        Self { p: [p1, p2], s: turn.vector(self.s), ..self }
    }
}

axial_camera!(PrismFisheye, NAMES);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::conformance::{self, Shape};
    use crate::camera::{CameraModel, OpenCvFisheye, Ray};

    fn camera() -> PrismFisheye {
        let (k, p, s) = ([-0.02, 0.006, -0.004, 0.0005], [4e-4, -3e-4], [2e-4, -5e-4]);
        PrismFisheye { size: ImageSize { width: 1600, height: 1200 }, fx: 520.0, fy: 521.0, cx: 803.2, cy: 598.7, k, p, s }
    }

    #[test]
    fn conforms() {
        conformance::check(&camera(), Shape::Barrel);
    }

    #[test]
    fn without_p_and_s_it_is_opencv_s_fisheye() {
        let ours = PrismFisheye { p: [0.0; 2], s: [0.0; 2], ..camera() };
        let PrismFisheye { size, fx, fy, cx, cy, k, .. } = ours;
        let opencv = OpenCvFisheye { size, fx, fy, cx, cy, skew: 0.0, k };
        for (x, y, z) in [(0.0, 0.0, -1.0), (1.0, 0.5, -0.4), (-0.8, 0.9, 0.1)] {
            let ray = Ray { x, y, z };
            assert!(ours.project(ray).unwrap().distance(opencv.project(ray).unwrap()) < 1e-10);
        }
    }
}
