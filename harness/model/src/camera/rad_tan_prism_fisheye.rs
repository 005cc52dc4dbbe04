//! A fisheye whose radial polynomial comes before decentring and thin prism: COLMAP's `RAD_TAN_THIN_PRISM_FISHEYE`, Project Aria's Fisheye624.

use serde::{Deserialize, Serialize};

use super::convention::{Convention, TangentialOrder, Verification};
use super::plane_map::first_fold;
use super::wide_angle::{Axial, Focal, Plane, axial_camera};
use super::{ImageSize, Turn, opencv_fisheye};

/// A fisheye with six radial coefficients, then decentring and thin prism. Direction: **ideal to distorted**; y points down; the centre of the first pixel is
/// (0, 0).
///
/// With the angle from the axis `theta`, `r = sqrt(X^2 + Y^2)` (x right, y down, z forward): `theta_d = theta (1 + k0 theta^2 + ... + k5 theta^12)`,
/// `x = theta_d X / r`, `y = theta_d Y / r`, `t2 = x^2 + y^2`: `x' = x + p0 (t2 + 2 x^2) + 2 p1 x y + s0 t2 + s1 t2^2`,
/// `y' = y + 2 p0 x y + p1 (t2 + 2 y^2) + s2 t2 + s3 t2^2`, `u = fx x' + cx`, `v = fy y' + cy`. Unlike [`super::PrismFisheye`] it bends what the radial
/// polynomial has bent already, and its p0 is Brown's first.
///
/// Source: COLMAP 4, `RAD_TAN_THIN_PRISM_FISHEYE` in its list of camera models; Project Aria, camera intrinsic models, Fisheye624.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RadTanPrismFisheye {
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
    /// k0 to k5, numbers.
    pub k: [f64; 6],
    /// p0, p1 in Brown's order, numbers.
    pub p: [f64; 2],
    /// Thin prism: s0, s1 along x, s2, s3 along y, numbers.
    pub s: [f64; 4],
}

/// The convention of [`RadTanPrismFisheye`].
pub const CONVENTION: Convention = Convention {
    name: "rad-tan-prism-fisheye",
    about: "fisheye, then decentring and thin prism: fx, fy, cx, cy, k0 to k5, p0, p1, s0 to s3",
    version: "",
    order: TangentialOrder::Brown,
    source: "COLMAP 4, list of camera models, RAD_TAN_THIN_PRISM_FISHEYE; Project Aria, Fisheye624",
    verification: Verification::Verified("projections of pycolmap 4.2.1, to 1e-9 px"),
    ..opencv_fisheye::CONVENTION
};

const NAMES: [(&str, &str); 12] = [
    ("k0", ""),
    ("k1", ""),
    ("k2", ""),
    ("k3", ""),
    ("k4", ""),
    ("k5", ""),
    ("p0", ""),
    ("p1", ""),
    ("s0", ""),
    ("s1", ""),
    ("s2", ""),
    ("s3", ""),
];
/// Places between 0 and 180 degrees where the polynomial may turn round.
const PLACES: usize = 360;

impl RadTanPrismFisheye {
    fn lens_values(&self) -> [f64; 12] {
        let ([k0, k1, k2, k3, k4, k5], [p0, p1], [s0, s1, s2, s3]) = (self.k, self.p, self.s);
        [k0, k1, k2, k3, k4, k5, p0, p1, s0, s1, s2, s3]
    }

    fn with_lens(self, v: &[f64]) -> Self {
        Self { k: [v[0], v[1], v[2], v[3], v[4], v[5]], p: [v[6], v[7]], s: [v[8], v[9], v[10], v[11]], ..self }
    }

    /// A bound of how much the coefficients take from the slope.
    fn is_surely_rising(&self, theta: f64) -> bool {
        let t2 = theta * theta;
        self.k.iter().enumerate().rev().fold(0.0, |sum, (i, k)| (sum + (2 * i + 3) as f64 * k.abs()) * t2) < 1.0
    }
}

impl Axial for RadTanPrismFisheye {
    fn focal(&self) -> Focal {
        Focal { size: self.size, fx: self.fx, fy: self.fy, cx: self.cx, cy: self.cy }
    }

    fn radius(&self, theta: f64) -> (f64, f64) {
        let t2 = theta * theta;
        let sums = self
            .k
            .iter()
            .enumerate()
            .rev()
            .fold((0.0, 0.0), |(value, slope), (i, k)| ((value + k) * t2, (slope + (2 * i + 3) as f64 * k) * t2));
        (theta * (1.0 + sums.0), 1.0 + sums.1)
    }

    fn end(&self) -> f64 {
        first_fold(|theta| self.radius(theta).1, std::f64::consts::PI, PLACES).unwrap_or(std::f64::consts::PI)
    }

    fn by_lens(&self, theta: f64) -> Vec<f64> {
        (0..6).map(|i| theta.powi(2 * i + 3)).collect()
    }

    fn plane(&self) -> Option<Plane> {
        let ([p0, p1], [s0, s1, s2, s3]) = (self.p, self.s);
        Some(Plane { k: [0.0; 6], p: [p1, p0], s: [s0, s2], s4: [s1, s3] })
    }

    fn plane_parameters(&self) -> &'static [usize] {
        &[3, 2, 6, 8, 7, 9]
    }

    fn pictures(&self, theta: f64) -> bool {
        (theta < std::f64::consts::PI && self.is_surely_rising(theta)) || theta < self.end()
    }

    fn with_turned_plane(self, turn: Turn) -> Self {
        let [s0, s1, s2, s3] = self.s;
        let ([s0, s2], [s1, s3]) = (turn.vector([s0, s2]), turn.vector([s1, s3]));
        Self { p: turn.vector(self.p), s: [s0, s1, s2, s3], ..self }
    }
}

axial_camera!(RadTanPrismFisheye, NAMES);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::PixelPoint;
    use crate::camera::conformance::{self, Shape};
    use crate::camera::wide_angle::tests::rises_to_its_end;
    use crate::camera::{CameraModel, OpenCvFisheye, Ray};

    fn camera() -> RadTanPrismFisheye {
        let (k, p, s) = ([-0.02, 0.006, -0.004, 5e-4, 1e-5, -2e-6], [4e-4, -3e-4], [2e-4, -1e-4, -5e-4, 3e-4]);
        RadTanPrismFisheye { size: ImageSize { width: 1600, height: 1200 }, fx: 520.0, fy: 521.0, cx: 803.2, cy: 598.7, k, p, s }
    }

    #[test]
    fn conforms() {
        conformance::check(&camera(), Shape::Barrel);
        rises_to_its_end(&RadTanPrismFisheye { k: [-0.1, 0.01, 0.0, 0.0, 0.0, 0.0], ..camera() });
    }

    #[test]
    fn without_p_and_s_it_is_opencv_s_fisheye() {
        let ours = RadTanPrismFisheye { k: [-0.02, 0.006, -0.004, 5e-4, 0.0, 0.0], p: [0.0; 2], s: [0.0; 4], ..camera() };
        let RadTanPrismFisheye { size, fx, fy, cx, cy, .. } = ours;
        let opencv = OpenCvFisheye { size, fx, fy, cx, cy, skew: 0.0, k: [-0.02, 0.006, -0.004, 5e-4] };
        for (x, y, z) in [(0.0, 0.0, -1.0), (1.0, 0.5, -0.4), (-0.8, 0.9, 0.1)] {
            let ray = Ray { x, y, z };
            assert!(ours.project(ray).unwrap().distance(opencv.project(ray).unwrap()) < 1e-10);
        }
    }

    /// Points that pycolmap 4.2.1 projects, whose first pixel has its centre at (0.5, 0.5).
    #[test]
    fn pictures_what_colmap_does() {
        let (k, p, s) = ([0.01, -0.02, 0.03, -0.01, 0.005, 0.001], [0.002, -0.003], [0.004, -0.005, 0.006, -0.007]);
        let camera =
            RadTanPrismFisheye { size: ImageSize { width: 640, height: 480 }, fx: 300.0, fy: 310.0, cx: 320.0, cy: 240.0, k, p, s };
        for ((x, y, z), point) in [
            ((0.3, -0.2, 1.0), (406.855_200_541_089_8, 180.380_659_378_391_04)),
            ((-1.5, 0.7, 1.5), (93.464_054_724_246_21, 349.070_491_074_818_73)),
            ((0.9, 1.1, 2.0), (437.967_358_758_472_24, 388.432_637_369_134_5)),
        ] {
            let found = camera.project(Ray { x, y: -y, z: -z }).unwrap();
            assert!(found.distance(PixelPoint::new(point.0, point.1)) < 1e-9, "{found:?}");
        }
    }
}
