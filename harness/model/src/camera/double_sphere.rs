//! The double sphere camera: a ray meets two unit spheres, then a plane.

use serde::{Deserialize, Serialize};

use super::ImageSize;
use super::convention::{Convention, Direction, PixelOrigin, TangentialOrder, Verification, Vertical};
use super::wide_angle::{Axial, Focal, axial_camera};

/// The double sphere camera. Direction: **ideal to distorted**; y points down; the centre of the first pixel is (0, 0).
///
/// With `d1 = |(X, Y, Z)|` (x right, y down, z forward), `t = xi d1 + Z`, `d2 = sqrt(X^2 + Y^2 + t^2)`: `u = fx X / (alpha d2 + (1 - alpha) t) + cx`, `v`
/// alike. Rays beyond 90 degrees are pictured, as far as the image grows.
///
/// Source: Usenko, Demmel and Cremers 2018, "The Double Sphere Camera Model", Eqs. 40 to 42.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct DoubleSphere {
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
    /// Shift of the second sphere, in radii.
    pub xi: f64,
    /// Where the plane lies between the second sphere's centre (0) and infinity: 0 to 1.
    pub alpha: f64,
}

/// The convention of [`DoubleSphere`].
pub const CONVENTION: Convention = Convention {
    name: "double-sphere",
    about: "double sphere: fx, fy, cx, cy, xi, alpha",
    version: "",
    direction: Direction::IdealToDistorted,
    pixel_origin: PixelOrigin::PixelCentre,
    principal_point_from: PixelOrigin::PixelCentre,
    y: Vertical::Down,
    order: TangentialOrder::Without,
    normalisation: "fx, fy, px, times a function of the ray's direction",
    source: "Usenko, Demmel and Cremers 2018",
    verification: Verification::Unverified("formulas after the paper; no projected point of the authors' own program was at hand"),
};

const NAMES: [(&str, &str); 2] = [("xi", ""), ("alpha", "")];

impl DoubleSphere {
    fn lens_values(&self) -> [f64; 2] {
        [self.xi, self.alpha]
    }

    fn with_lens(self, lens: &[f64]) -> Self {
        Self { xi: lens[0], alpha: lens[1], ..self }
    }

    /// sin, cos, t, d2 and the denominator of the unit ray at an angle.
    fn parts(&self, theta: f64) -> [f64; 5] {
        let (r, z) = theta.sin_cos();
        let t = self.xi + z;
        let d2 = r.hypot(t);
        [r, z, t, d2, self.alpha * d2 + (1.0 - self.alpha) * t]
    }
}

impl Axial for DoubleSphere {
    fn focal(&self) -> Focal {
        Focal { size: self.size, fx: self.fx, fy: self.fy, cx: self.cx, cy: self.cy }
    }

    fn radius(&self, theta: f64) -> (f64, f64) {
        let [r, z, _, d2, under] = self.parts(theta);
        let change = -self.alpha * self.xi * r / d2 - (1.0 - self.alpha) * r;
        (r / under, (z * under - r * change) / (under * under))
    }

    /// Where the second sphere's angle has the cosine -w1, the pole or turning point of the unified camera; Eq. 45 of the paper stops short of it.
    fn end(&self) -> f64 {
        let (alpha, xi) = (self.alpha, self.xi);
        let w1 = if alpha <= 0.5 { alpha / (1.0 - alpha) } else { (1.0 - alpha) / alpha };
        let rest = 1.0 - w1 * w1;
        (-(xi * rest + w1 * (1.0 - xi * xi * rest).max(0.0).sqrt())).clamp(-1.0, 1.0).acos()
    }

    fn by_lens(&self, theta: f64) -> Vec<f64> {
        let [r, _, t, d2, under] = self.parts(theta);
        let by = -r / (under * under);
        vec![by * (self.alpha * t / d2 + 1.0 - self.alpha), by * (d2 - t)]
    }
}

axial_camera!(DoubleSphere, NAMES);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::conformance::{self, Shape};
    use crate::camera::wide_angle::tests::rises_to_its_end;
    use crate::camera::{CameraModel, Ray};

    fn camera() -> DoubleSphere {
        let size = ImageSize { width: 752, height: 480 };
        DoubleSphere { size, fx: 349.756, fy: 348.725, cx: 365.894, cy: 249.33, xi: -0.240_957, alpha: 0.566_997 }
    }

    #[test]
    fn conforms() {
        conformance::check(&camera(), Shape::Barrel);
        conformance::check(&DoubleSphere { xi: 0.3, alpha: 0.2, ..camera() }, Shape::Barrel);
    }

    #[test]
    fn the_end_is_where_the_image_stops_growing() {
        for (xi, alpha) in [(-0.24, 0.567), (0.3, 0.2), (0.0, 0.5), (-0.1, 0.8), (0.6, 0.7), (0.0, 0.0)] {
            rises_to_its_end(&DoubleSphere { xi, alpha, ..camera() });
        }
    }

    #[test]
    fn the_paper_s_formula_at_one_ray() {
        let camera = camera();
        let (x, y, z) = (0.7_f64, -0.4_f64, 1.3_f64);
        let d1 = (x * x + y * y + z * z).sqrt();
        let t = camera.xi * d1 + z;
        let d2 = (x * x + y * y + t * t).sqrt();
        let under = camera.alpha * d2 + (1.0 - camera.alpha) * t;
        let found = camera.project(Ray { x, y: -y, z: -z }).unwrap();
        assert!(
            (found.x - (camera.fx * x / under + camera.cx)).abs() < 1e-12 && (found.y - (camera.fy * y / under + camera.cy)).abs() < 1e-12
        );
    }
}
