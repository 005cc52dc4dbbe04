//! The fisheye cameras of Agisoft's Metashape.

use serde::{Deserialize, Serialize};

use super::convention::{Convention, TangentialOrder, Verification};
use super::wide_angle::{self, Axial, Focal, Plane};
use super::{CameraModel, CameraParameter, DerivativeBuffer, ImageSize, NoCounterpart, Ray, Reframe, Resampling, Turn, agisoft, named};
use crate::{CornerPoint, PixelPoint};

/// How Metashape's fisheye pictures an angle before it is distorted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum FisheyeProjection {
    /// The radius is the angle: `fisheye` of older files, `equidistant_fisheye`.
    Equidistant,
    /// The radius is twice the sine of half the angle: `equisolid_fisheye`.
    Equisolid,
}

/// Metashape's fisheye camera. Direction: **ideal to distorted**; y points down; the outer corner of the first pixel is (0, 0); normalised by the focal length.
///
/// With the angle from the axis `theta` and `R = sqrt(X^2 + Y^2)` (x right, y down, z forward) `x = s X / R`, `y = s Y / R`, where `s = theta` or
/// `2 sin(theta / 2)`, `r2 = x^2 + y^2` and `q = 1 + k1 r2 + k2 r2^2 + k3 r2^3 + k4 r2^4`: `x' = x q + p1 (r2 + 2 x^2) + 2 p2 x y`,
/// `y' = y q + p2 (r2 + 2 y^2) + 2 p1 x y`, `u = W/2 + cx + f x' + b1 x' + b2 y'`, `v = H/2 + cy + f y'`. Equidistant and without p1, p2 it is OpenCV's fisheye.
///
/// Source: Agisoft Metashape user manuals, appendix "Camera models", fisheye cameras.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct AgisoftFisheye {
    /// Size of its images.
    pub size: ImageSize,
    /// How it pictures angles.
    pub projection: FisheyeProjection,
    /// Focal length, px.
    pub f: f64,
    /// Principal point, x, px from the centre of the frame.
    pub cx: f64,
    /// Principal point, y, px downwards from the centre of the frame.
    pub cy: f64,
    /// Affinity, px.
    pub b1: f64,
    /// Shear, px.
    pub b2: f64,
    /// k1 to k4, numbers.
    pub k: [f64; 4],
    /// p1, p2, numbers, in Brown's order.
    pub p: [f64; 2],
}

/// The convention of [`AgisoftFisheye`].
pub const CONVENTION: Convention = Convention {
    name: "metashape-fisheye",
    about: "Agisoft Metashape, fisheye: f, cx, cy, K1 to K4, P1, P2, B1, B2 on an equidistant or equisolid radius",
    version: "Metashape",
    order: TangentialOrder::Brown,
    normalisation: "divided by f, px; polynomials on a radius that is the angle, or twice the sine of its half",
    source: "Agisoft Metashape User Manual, appendix Camera models, fisheye cameras",
    verification: Verification::Unverified("formulas by the manual; no numbers of a fisheye of the tool were at hand"),
    ..agisoft::METASHAPE
};

const NAMES: [(&str, &str); 11] = [
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
];

/// The camera with a focal length of one pixel around its axis: x', y' are its pixels.
struct Normalised(AgisoftFisheye);

impl Axial for Normalised {
    fn focal(&self) -> Focal {
        Focal { size: self.0.size, fx: 1.0, fy: 1.0, cx: 0.0, cy: 0.0 }
    }

    fn radius(&self, theta: f64) -> (f64, f64) {
        match self.0.projection {
            FisheyeProjection::Equidistant => (theta, 1.0),
            FisheyeProjection::Equisolid => {
                let (sin, cos) = (0.5 * theta).sin_cos();
                (2.0 * sin, cos)
            }
        }
    }

    fn end(&self) -> f64 {
        std::f64::consts::PI
    }

    fn by_lens(&self, _theta: f64) -> Vec<f64> {
        Vec::new()
    }

    fn plane(&self) -> Option<Plane> {
        let [p1, p2] = self.0.p;
        let [k1, k2, k3, k4] = self.0.k;
        Some(Plane { k: [k1, k2, k3, k4, 0.0, 0.0], p: [p2, p1], s: [0.0; 2], s4: [0.0; 2] })
    }

    fn plane_parameters(&self) -> &'static [usize] {
        // The plane's p1 is Brown's p2.
        &[0, 1, 4, 5, 3, 2]
    }
}

impl AgisoftFisheye {
    /// Principal point, px from the centre of the first pixel.
    pub(crate) fn principal_point(&self) -> PixelPoint {
        let half = |length: u32| f64::from(length) / 2.0;
        CornerPoint { x: half(self.size.width) + self.cx, y: half(self.size.height) + self.cy }.to_pixel()
    }

    fn affine(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [(self.f + self.b1) * x + self.b2 * y, self.f * y]
    }

    fn pixel(&self, distorted: PixelPoint) -> PixelPoint {
        let (at, [x, y]) = (self.principal_point(), self.affine([distorted.x, distorted.y]));
        PixelPoint::new(at.x + x, at.y + y)
    }
}

impl CameraModel for AgisoftFisheye {
    fn size(&self) -> ImageSize {
        self.size
    }

    fn parameters(&self) -> Vec<CameraParameter> {
        let ([k1, k2, k3, k4], [p1, p2]) = (self.k, self.p);
        named(&NAMES, &[self.f, self.cx, self.cy, self.b1, self.b2, k1, k2, k3, k4, p1, p2])
    }

    fn with_parameters(&self, v: &[f64]) -> Self {
        Self { f: v[0], cx: v[1], cy: v[2], b1: v[3], b2: v[4], k: [v[5], v[6], v[7], v[8]], p: [v[9], v[10]], ..*self }
    }

    fn project(&self, ray: Ray) -> Result<PixelPoint, NoCounterpart> {
        let found = self.pixel(wide_angle::project(&Normalised(*self), ray)?);
        if found.is_finite() { Ok(found) } else { Err(NoCounterpart::NoSolution) }
    }

    fn unproject(&self, point: PixelPoint) -> Result<Ray, NoCounterpart> {
        let at = self.principal_point();
        let y = (point.y - at.y) / self.f;
        let x = (point.x - at.x - self.b2 * y) / (self.f + self.b1);
        wide_angle::unproject(&Normalised(*self), PixelPoint::new(x, y))
    }

    fn derivatives_into(&self, ray: Ray, into: &mut DerivativeBuffer) -> Result<(), NoCounterpart> {
        let mut inner = DerivativeBuffer::default();
        wide_angle::derivatives_into(&Normalised(*self), ray, &mut inner)?;
        let PixelPoint { x, y } = inner.point;
        let by = |i: usize| self.affine([inner.by_ray[0][i], inner.by_ray[1][i]]);
        let columns: [[f64; 2]; 3] = std::array::from_fn(by);
        into.clear();
        into.point = self.pixel(inner.point);
        into.by_ray = [0, 1].map(|row| columns.map(|column| column[row]));
        into.extend([[x, y], [1.0, 0.0], [0.0, 1.0], [x, 0.0], [y, 0.0]]);
        // After fx, fy, cx, cy come those of the plane.
        into.extend(inner.by_parameters()[4..].iter().map(|&by| self.affine(by)));
        Ok(())
    }

    fn fold_towards(&self, angle: f64) -> Option<PixelPoint> {
        // The direction in the image is one in the plane before the affinity, for all but a shear.
        wide_angle::fold_towards(&Normalised(*self), angle).map(|at| self.pixel(at))
    }
}

impl AgisoftFisheye {
    /// The camera of images of `size` whose principal point is at `at`.
    fn centred(&self, at: PixelPoint, size: ImageSize, [f, b1, b2]: [f64; 3]) -> Self {
        let (corner, half) = (at.to_corner(), |length: u32| f64::from(length) / 2.0);
        Self { size, f, b1, b2, cx: corner.x - half(size.width), cy: corner.y - half(size.height), ..*self }
    }
}

impl Reframe for AgisoftFisheye {
    fn resampled(&self, by: &Resampling) -> Self {
        let affinity = agisoft::resampled_affinity([self.f, self.b1, self.b2], by);
        self.centred(by.point(self.principal_point()), by.size, affinity)
    }

    fn without_place(&self, turn: Turn) -> Option<&'static str> {
        (turn.swaps_axes() && self.b2 != 0.0).then_some("b2")
    }

    fn turned(&self, turn: Turn) -> Self {
        let affinity = agisoft::turned_affinity([self.f, self.b1, self.b2], turn);
        let turned = self.centred(turn.point(self.size, self.principal_point()), turn.size(self.size), affinity);
        Self { p: turn.vector(self.p), ..turned }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::OpenCvFisheye;
    use crate::camera::conformance::{self, Shape};

    const SIZE: ImageSize = ImageSize { width: 1600, height: 1200 };

    fn camera(projection: FisheyeProjection) -> AgisoftFisheye {
        let (k, p) = ([-0.02, 0.006, -0.004, 0.0005], [-3e-4, 4e-4]);
        AgisoftFisheye { size: SIZE, projection, f: 520.0, cx: 3.7, cy: -0.8, b1: 1.2, b2: -0.4, k, p }
    }

    #[test]
    fn conforms() {
        for projection in [FisheyeProjection::Equidistant, FisheyeProjection::Equisolid] {
            // An equisolid radius ends at 2 f, which is to lie outside of the frame.
            conformance::check(&AgisoftFisheye { f: 620.0, ..camera(projection) }, Shape::Barrel);
            wide_angle::tests::rises_to_its_end(&Normalised(camera(projection)));
        }
    }

    #[test]
    fn equidistant_and_without_p_it_is_opencv_s_fisheye() {
        let ours = AgisoftFisheye { p: [0.0; 2], ..camera(FisheyeProjection::Equidistant) };
        let (fx, fy, k) = (ours.f + ours.b1, ours.f, ours.k);
        let opencv = OpenCvFisheye { size: SIZE, fx, fy, cx: 799.5 + 3.7, cy: 599.5 - 0.8, skew: ours.b2 / fx, k };
        for (x, y, z) in [(0.0, 0.0, -1.0), (1.0, 0.5, -0.4), (-0.8, 0.9, 0.1)] {
            let ray = Ray { x, y, z };
            assert!(ours.project(ray).unwrap().distance(opencv.project(ray).unwrap()) < 1e-10);
        }
    }

    #[test]
    fn each_pictures_an_angle_by_its_own_law() {
        let plain = |projection| AgisoftFisheye { b1: 0.0, b2: 0.0, cx: 0.0, cy: 0.0, k: [0.0; 4], p: [0.0; 2], ..camera(projection) };
        // A ray 90 degrees off, to the right.
        let right = Ray { x: 1.0, y: 0.0, z: 0.0 };
        let x = |projection| plain(projection).project(right).unwrap().x - 799.5;
        assert!((x(FisheyeProjection::Equidistant) - 520.0 * std::f64::consts::FRAC_PI_2).abs() < 1e-9);
        assert!((x(FisheyeProjection::Equisolid) - 520.0 * std::f64::consts::SQRT_2).abs() < 1e-9);
    }

    #[test]
    fn p1_is_brown_s() {
        let with = |p| AgisoftFisheye { k: [0.0; 4], b1: 0.0, b2: 0.0, p, ..camera(FisheyeProjection::Equidistant) };
        let ray = Ray { x: 1.0, y: 0.0, z: -1.0 };
        let x = |p| with(p).project(ray).unwrap();
        // Along x p1 moves by 3 p1 r^2, and p2 across it by r^2.
        let r2 = std::f64::consts::FRAC_PI_4.powi(2);
        let (plain, first, second) = (x([0.0; 2]), x([1e-3, 0.0]), x([0.0, 1e-3]));
        assert!((first.x - plain.x - 520.0 * 3e-3 * r2).abs() < 1e-9 && (first.y - plain.y).abs() < 1e-12);
        assert!((second.y - plain.y - 520.0 * 1e-3 * r2).abs() < 1e-9 && (second.x - plain.x).abs() < 1e-12);
    }
}
