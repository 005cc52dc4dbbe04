//! The field-of-view camera of Devernay and Faugeras.

use serde::{Deserialize, Serialize};

use super::convention::{Convention, Verification};
use super::wide_angle::{Axial, Focal, axial_camera};
use super::{ImageSize, double_sphere};

/// The field-of-view camera, also called ATAN. Direction: **ideal to distorted**; y points down; the centre of the first pixel is (0, 0).
///
/// With `r = sqrt(X^2 + Y^2) / Z` (x right, y down, z forward): `r' = atan(2 r tan(w/2)) / w`, `u = fx x r'/r + cx`, `v` alike; with `w = 0` there is no
/// distortion. Rays beyond 90 degrees are not pictured.
///
/// Source: Devernay and Faugeras 2001, "Straight lines have to be straight", Eq. 13.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fov {
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
    /// The angle w, radians: above -pi and below pi.
    pub w: f64,
}

/// The convention of [`Fov`].
pub const CONVENTION: Convention = Convention {
    name: "fov",
    about: "field-of-view camera: fx, fy, cx, cy, w",
    source: "Devernay and Faugeras 2001",
    verification: Verification::Unverified("formula after the paper; no projected point of a tool was at hand"),
    ..double_sphere::CONVENTION
};

const NAMES: [(&str, &str); 1] = [("w", "rad")];
/// Below this the first term of the series in w is exact to the last bits.
const SMALL: f64 = 1e-4;

impl Fov {
    fn lens_values(&self) -> [f64; 1] {
        [self.w]
    }

    fn with_lens(self, lens: &[f64]) -> Self {
        Self { w: lens[0], ..self }
    }
}

impl Axial for Fov {
    fn focal(&self) -> Focal {
        Focal { size: self.size, fx: self.fx, fy: self.fy, cx: self.cx, cy: self.cy }
    }

    fn radius(&self, theta: f64) -> (f64, f64) {
        let ((sin, cos), w) = (theta.sin_cos(), self.w);
        if w.abs() < SMALL {
            let (u, w2) = (sin / cos, w * w);
            return (u * (1.0 + w2 * (1.0 / 12.0 - u * u / 3.0)), (1.0 + w2 * (1.0 / 12.0 - u * u)) / (cos * cos));
        }
        let t = 2.0 * (0.5 * w).tan();
        ((t * sin).atan2(cos) / w, t / (w * (cos * cos + t * t * sin * sin)))
    }

    fn end(&self) -> f64 {
        std::f64::consts::FRAC_PI_2
    }

    fn by_lens(&self, theta: f64) -> Vec<f64> {
        let ((sin, cos), w) = (theta.sin_cos(), self.w);
        if w.abs() < SMALL {
            let u = sin / cos;
            return vec![2.0 * w * u * (1.0 / 12.0 - u * u / 3.0)];
        }
        let t = 2.0 * (0.5 * w).tan();
        let by_t = sin * cos / (cos * cos + t * t * sin * sin);
        vec![((1.0 + 0.25 * t * t) * by_t - self.radius(theta).0) / w]
    }
}

axial_camera!(Fov, NAMES);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::conformance::{self, Shape};
    use crate::camera::{CameraModel, Ray};

    fn camera() -> Fov {
        Fov { size: ImageSize { width: 640, height: 480 }, fx: 350.0, fy: 351.0, cx: 318.0, cy: 243.0, w: 0.93 }
    }

    #[test]
    fn conforms() {
        conformance::check(&camera(), Shape::Barrel);
        conformance::check(&Fov { w: 2.0 * SMALL, ..camera() }, Shape::Barrel);
    }

    #[test]
    fn the_series_and_the_formula_meet() {
        let at = |w: f64| Fov { w, ..camera() }.project(Ray::from_tangent(0.6, 0.3)).unwrap();
        assert!(at(SMALL * 0.999_999).distance(at(SMALL * 1.000_001)) < 1e-9);
        let none = at(0.0);
        assert!((none.x - (318.0 + 350.0 * 0.6)).abs() < 1e-12 && (none.y - (243.0 - 351.0 * 0.3)).abs() < 1e-12);
    }

    #[test]
    fn the_paper_s_formula_at_one_ray() {
        let found = camera().project(Ray::from_tangent(0.8, 0.0)).unwrap();
        assert!((found.x - (318.0 + 350.0 * (2.0 * 0.8 * (0.465_f64).tan()).atan() / 0.93)).abs() < 1e-10);
    }
}
