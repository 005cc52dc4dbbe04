//! The enhanced unified camera.

use serde::{Deserialize, Serialize};

use super::convention::{Convention, Verification};
use super::wide_angle::{Axial, Focal, axial_camera};
use super::{ImageSize, double_sphere};

/// The enhanced unified camera. Direction: **ideal to distorted**; y points down; the centre of the first pixel is (0, 0).
///
/// With `d = sqrt(beta (X^2 + Y^2) + Z^2)` (x right, y down, z forward): `u = fx X / (alpha d + (1 - alpha) Z) + cx`, `v` alike. With `beta = 1` it is the
/// unified camera, with `alpha = 0` a pinhole, with `alpha = 1/2`, `beta = 1` the stereographic projection.
///
/// With `alpha = 1/2` it is the division model, `x = x' / (1 + k r'^2)` for the ideal x and the distorted x', with `beta = -4 k`: solved for r' that reads
/// `r' = 2 R / (Z + sqrt(Z^2 - 4 k R^2))`, `R = sqrt(X^2 + Y^2)`. Pincushion distortion has k above and beta below zero, and no image beyond `d = 0`.
///
/// Source: Khomutenko, Garcia and Martinet 2016, "An Enhanced Unified Camera Model"; Usenko, Demmel and Cremers 2018, Eqs. 22 to 26; Fitzgibbon 2001, Eq. 3
/// (division model).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Eucm {
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
    /// A number, 0 to 1.
    pub alpha: f64,
    /// A number; above zero but for division models.
    pub beta: f64,
}

/// The convention of [`Eucm`].
pub const CONVENTION: Convention = Convention {
    name: "eucm",
    about: "enhanced unified camera: fx, fy, cx, cy, alpha, beta",
    source: "Khomutenko, Garcia and Martinet 2016",
    verification: Verification::Unverified("formulas after the papers; no projected point of a tool was at hand"),
    ..double_sphere::CONVENTION
};

const NAMES: [(&str, &str); 2] = [("alpha", ""), ("beta", "")];

impl Eucm {
    fn lens_values(&self) -> [f64; 2] {
        [self.alpha, self.beta]
    }

    fn with_lens(self, lens: &[f64]) -> Self {
        Self { alpha: lens[0], beta: lens[1], ..self }
    }

    /// sin, cos, d and the denominator of the unit ray at an angle.
    fn parts(&self, theta: f64) -> [f64; 4] {
        let (r, z) = theta.sin_cos();
        // Below zero there is no image, but at the very end rounding alone may lead there.
        let d = (self.beta * r * r + z * z).max(0.0).sqrt();
        [r, z, d, self.alpha * d + (1.0 - self.alpha) * z]
    }
}

impl Axial for Eucm {
    fn focal(&self) -> Focal {
        Focal { size: self.size, fx: self.fx, fy: self.fy, cx: self.cx, cy: self.cy }
    }

    fn radius(&self, theta: f64) -> (f64, f64) {
        let [r, z, d, under] = self.parts(theta);
        let change = self.alpha * r * z * (self.beta - 1.0) / d - (1.0 - self.alpha) * r;
        (r / under, (z * under - r * change) / (under * under))
    }

    fn end(&self) -> f64 {
        if self.beta <= 0.0 {
            // Where d vanishes.
            return (1.0 / (-self.beta).sqrt()).atan();
        }
        // Z = -w d at the pole, or where the image stops growing.
        let alpha = self.alpha;
        let w = if alpha <= 0.5 { alpha / (1.0 - alpha) } else { (1.0 - alpha) / alpha };
        std::f64::consts::PI - ((1.0 - w * w).max(0.0) / (w * w * self.beta)).sqrt().atan()
    }

    fn by_lens(&self, theta: f64) -> Vec<f64> {
        let [r, z, d, under] = self.parts(theta);
        let by = -r / (under * under);
        vec![by * (d - z), by * self.alpha * r * r / (2.0 * d)]
    }
}

axial_camera!(Eucm, NAMES);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::PixelPoint;
    use crate::camera::conformance::{self, Shape};
    use crate::camera::wide_angle::tests::rises_to_its_end;
    use crate::camera::{CameraModel, Ray};

    fn camera() -> Eucm {
        Eucm { size: ImageSize { width: 752, height: 480 }, fx: 460.0, fy: 459.0, cx: 365.9, cy: 249.3, alpha: 0.62, beta: 1.08 }
    }

    #[test]
    fn conforms() {
        conformance::check(&camera(), Shape::Barrel);
        conformance::check(&Eucm { alpha: 0.3, beta: 0.9, ..camera() }, Shape::Barrel);
    }

    #[test]
    fn the_end_is_where_the_image_stops_growing() {
        for (alpha, beta) in [(0.62, 1.08), (0.3, 0.9), (0.5, 1.0), (0.0, 1.0), (0.9, 1.4)] {
            rises_to_its_end(&Eucm { alpha, beta, ..camera() });
        }
    }

    /// The division model turns distorted into ideal coordinates without a root.
    #[test]
    fn half_is_the_division_model() {
        for k in [-0.31, -0.02, 0.0, 0.05] {
            let camera = Eucm { alpha: 0.5, beta: -4.0 * k, ..camera() };
            conformance::check(
                &camera,
                if k < 0.0 {
                    Shape::Barrel
                } else if k > 0.0 {
                    Shape::Pincushion
                } else {
                    Shape::Straight
                },
            );
            for (u, v) in [(0.0, 0.0), (751.0, 12.5), (365.9, 479.0), (100.0, 300.0)] {
                let [x, y] = [(u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy];
                let found = camera.project(Ray { x, y: -y, z: -(1.0 + k * (x * x + y * y)) }).unwrap();
                assert!(found.distance(PixelPoint::new(u, v)) < 1e-10, "{k}: {found:?}");
            }
        }
    }

    #[test]
    fn pincushion_division_ends_where_its_root_does() {
        // r'/(1 + k r'^2) turns round at r' = 1 / sqrt(k).
        let camera = Eucm { alpha: 0.5, beta: -4.0 * 0.8, fx: 300.0, fy: 300.0, ..camera() };
        let fold = crate::camera::fold(&camera).unwrap();
        assert!((fold.radius_px - 300.0 / 0.8_f64.sqrt()).abs() < 1e-3, "{fold:?}");
        assert!(camera.unproject(PixelPoint::new(camera.cx + 336.0, camera.cy)).is_err());
        assert!(camera.project(Ray { x: 1.0, y: 0.0, z: -1.7 }).is_err() && camera.project(Ray { x: 1.0, y: 0.0, z: -1.8 }).is_ok());
    }

    #[test]
    fn half_is_stereographic() {
        let camera = Eucm { alpha: 0.5, beta: 1.0, ..camera() };
        let theta = 1.9_f64;
        let found = camera.project(Ray { x: theta.sin(), y: 0.0, z: -theta.cos() }).unwrap();
        assert!((found.x - camera.cx - camera.fx * 2.0 * (theta / 2.0).tan()).abs() < 1e-10);
    }
}
