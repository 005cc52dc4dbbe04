//! The unified camera of Mei, which is called omnidirectional: one unit sphere, then Brown's distortion of the plane.

use serde::{Deserialize, Serialize};

use super::convention::{Convention, TangentialOrder, Verification};
use super::wide_angle::{Axial, Focal, Plane, axial_camera};
use super::{ImageSize, Turn, double_sphere};

/// Mei's camera. Direction: **ideal to distorted**; y points down; the centre of the first pixel is (0, 0).
///
/// With `d = |(X, Y, Z)|` (x right, y down, z forward): `x = X / (Z + xi d)`, `y = Y / (Z + xi d)`, `r2 = x^2 + y^2`,
/// `x' = x (1 + k1 r2 + k2 r2^2) + 2 p1 x y + p2 (r2 + 2 x^2)`, `y' = y (1 + k1 r2 + k2 r2^2) + p1 (r2 + 2 y^2) + 2 p2 x y`, `u = fx x' + cx`,
/// `v = fy y' + cy`. With `xi = 0` it is OpenCV's camera with four coefficients. Note that fx is not the focal length on the axis, which is fx / (1 + xi).
///
/// Source: Mei and Rives 2007, "Single View Point Omnidirectional Camera Calibration from Planar Grids".
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Omni {
    /// Size of its images.
    pub size: ImageSize,
    /// Generalised focal length along x, px: gamma1.
    pub fx: f64,
    /// Generalised focal length along y, px: gamma2.
    pub fy: f64,
    /// Principal point, x, px.
    pub cx: f64,
    /// Principal point, y, px downwards.
    pub cy: f64,
    /// Distance of the projection centre from the centre of the sphere, in radii.
    pub xi: f64,
    /// k1, k2, numbers.
    pub k: [f64; 2],
    /// p1, p2 in OpenCV's order, numbers.
    pub p: [f64; 2],
}

/// The convention of [`Omni`].
pub const CONVENTION: Convention = Convention {
    name: "omni",
    about: "unified (omnidirectional) camera of Mei: fx, fy, cx, cy, xi, k1, k2, p1, p2",
    order: TangentialOrder::OpenCv,
    source: "Mei and Rives 2007",
    verification: Verification::Verified("projectPoints of cv2.omnidir, OpenCV 5.0, to 1e-9 px"),
    ..double_sphere::CONVENTION
};

const NAMES: [(&str, &str); 5] = [("xi", ""), ("k1", ""), ("k2", ""), ("p1", ""), ("p2", "")];

impl Omni {
    fn lens_values(&self) -> [f64; 5] {
        [self.xi, self.k[0], self.k[1], self.p[0], self.p[1]]
    }

    fn with_lens(self, lens: &[f64]) -> Self {
        Self { xi: lens[0], k: [lens[1], lens[2]], p: [lens[3], lens[4]], ..self }
    }
}

impl Axial for Omni {
    fn focal(&self) -> Focal {
        Focal { size: self.size, fx: self.fx, fy: self.fy, cx: self.cx, cy: self.cy }
    }

    fn radius(&self, theta: f64) -> (f64, f64) {
        let (r, z) = theta.sin_cos();
        let under = z + self.xi;
        (r / under, (1.0 + self.xi * z) / (under * under))
    }

    fn end(&self) -> f64 {
        if self.xi <= 1.0 { (-self.xi).clamp(-1.0, 1.0).acos() } else { (-1.0 / self.xi).acos() }
    }

    fn by_lens(&self, theta: f64) -> Vec<f64> {
        let (r, z) = theta.sin_cos();
        vec![-r / (z + self.xi).powi(2)]
    }

    fn plane(&self) -> Option<Plane> {
        let plane = Plane { k: [self.k[0], self.k[1], 0.0, 0.0, 0.0, 0.0], p: self.p, s: [0.0; 2], s4: [0.0; 2] };
        (self.k != [0.0; 2] || self.p != [0.0; 2]).then_some(plane)
    }

    fn plane_parameters(&self) -> &'static [usize] {
        &[0, 1, 2, 3]
    }

    fn with_turned_plane(self, turn: Turn) -> Self {
        // p2 goes with x.
        let [p2, p1] = turn.vector([self.p[1], self.p[0]]);
        Self { p: [p1, p2], ..self }
    }
}

axial_camera!(Omni, NAMES);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::conformance::{self, Shape};
    use crate::camera::wide_angle::tests::rises_to_its_end;
    use crate::camera::{CameraModel, OpenCv, Ray};

    fn camera() -> Omni {
        let size = ImageSize { width: 752, height: 480 };
        Omni { size, fx: 880.0, fy: 879.0, cx: 365.9, cy: 249.3, xi: 1.2, k: [-0.12, 0.03], p: [4e-4, -7e-4] }
    }

    #[test]
    fn conforms() {
        conformance::check(&camera(), Shape::Barrel);
        conformance::check(&Omni { xi: 0.7, fx: 700.0, fy: 700.0, k: [0.0; 2], p: [0.0; 2], ..camera() }, Shape::Barrel);
    }

    /// Points (x right, y down, z forward) as OpenCV 5.0.0 (opencv-contrib) pictures them: `cv2.omnidir.projectPoints` with this camera, no rotation.
    #[test]
    fn points_are_pictured_as_by_opencv_s_omnidir() {
        let size = ImageSize { width: 1200, height: 900 };
        let camera = Omni { size, fx: 1100.0, fy: 1101.0, cx: 605.0, cy: 445.0, xi: 1.3, k: [-0.1, 0.02], p: [2e-4, 1e-4] };
        for ([x, y, z], u, v) in [
            ([0.3, -0.2, 1.0], 743.229_117_793_775_9, 352.770_206_953_229),
            ([-2.0, 0.5, 1.0], 66.157_722_858_033_03, 579.899_542_683_391),
            ([1.5, 2.5, 0.4], 978.829_147_293_391_1, 1_068.632_457_037_867_9),
            ([-0.7, -3.0, -0.5], 402.499_134_777_521_36, -423.838_556_726_444_84),
        ] {
            // Rays have y upwards and z backwards.
            let found = camera.project(Ray { x, y: -y, z: -z }).unwrap();
            assert!((found.x - u).hypot(found.y - v) < 1e-9, "{found:?} {u} {v}");
        }
    }

    #[test]
    fn the_end_is_where_the_image_stops_growing() {
        for xi in [0.0, 0.4, 1.0, 1.2, 2.5] {
            rises_to_its_end(&Omni { xi, ..camera() });
        }
    }

    #[test]
    fn without_a_sphere_it_is_opencv_s_camera() {
        let omni = Omni { xi: 0.0, ..camera() };
        let mut distortion = [0.0; 14];
        distortion[..4].copy_from_slice(&[-0.12, 0.03, 4e-4, -7e-4]);
        let opencv = OpenCv { size: omni.size, fx: omni.fx, fy: omni.fy, cx: omni.cx, cy: omni.cy, distortion, coefficients: 4 };
        for (x, y) in [(0.0, 0.0), (0.4, 0.2), (-0.3, 0.25)] {
            let ray = Ray::from_tangent(x, y);
            assert!(omni.project(ray).unwrap().distance(opencv.project(ray).unwrap()) < 1e-10);
        }
    }
}
