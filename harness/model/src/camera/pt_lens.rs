//! The lens model of PanoTools, PTLens, Hugin and lensfun: a polynomial with even and odd powers on a radius of the angle.

use std::f64::consts::{FRAC_PI_2, PI};

use serde::{Deserialize, Serialize};

use super::convention::{Convention, TangentialOrder, Verification};
use super::plane_map::first_fold;
use super::wide_angle::{self, Axial, Focal};
use super::{CameraModel, CameraParameter, DerivativeBuffer, ImageSize, NoCounterpart, Ray, Reframe, Resampling, Turn, named, opencv};
use crate::PixelPoint;

/// How a lens pictures an angle from its axis before the polynomial.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum LensProjection {
    /// The radius is the tangent.
    Rectilinear,
    /// The radius is the angle: PanoTools' full-frame and circular fisheye.
    Equidistant,
    /// The radius is twice the sine of half the angle.
    Equisolid,
    /// The radius is twice the tangent of half the angle.
    Stereographic,
    /// The radius is the sine.
    Orthographic,
    /// The radius is 1.47 times the sine of 0.713 times the angle: Thoby's measurement of a Nikkor 10.5 mm.
    Thoby,
}

/// Thoby's two numbers.
const THOBY: [f64; 2] = [1.47, 0.713];
/// Halvings that find a radius; Newton's steps end them sooner.
const MOST_STEPS: usize = 200;
/// Places up to the end of a projection where the polynomial may turn round.
const PLACES: usize = 360;

impl LensProjection {
    /// All of them.
    pub const ALL: [Self; 6] =
        [Self::Rectilinear, Self::Equidistant, Self::Equisolid, Self::Stereographic, Self::Orthographic, Self::Thoby];

    /// The radius of an angle from the axis, radians, in focal lengths; `None` beyond what the projection pictures.
    pub fn radius_of(self, theta: f64) -> Option<f64> {
        (theta > 0.0 && theta < self.end()).then(|| self.radius(theta).0)
    }

    /// The angle from the axis, radians, of a radius in focal lengths; `None` beyond what the projection pictures.
    pub fn angle_of(self, radius: f64) -> Option<f64> {
        let theta = match self {
            Self::Rectilinear => radius.atan(),
            Self::Equidistant => radius,
            Self::Equisolid => 2.0 * (0.5 * radius).asin(),
            Self::Stereographic => 2.0 * (0.5 * radius).atan(),
            Self::Orthographic => radius.asin(),
            Self::Thoby => (radius / THOBY[0]).asin() / THOBY[1],
        };
        (theta > 0.0 && theta < self.end()).then_some(theta)
    }

    /// The radius of an angle, radians, and its derivative.
    fn radius(self, theta: f64) -> (f64, f64) {
        let (sin, cos) = theta.sin_cos();
        let (half_sin, half_cos) = (0.5 * theta).sin_cos();
        match self {
            Self::Rectilinear => (sin / cos, 1.0 / (cos * cos)),
            Self::Equidistant => (theta, 1.0),
            Self::Equisolid => (2.0 * half_sin, half_cos),
            Self::Stereographic => (2.0 * half_sin / half_cos, 1.0 / (half_cos * half_cos)),
            Self::Orthographic => (sin, cos),
            Self::Thoby => (THOBY[0] * (THOBY[1] * theta).sin(), THOBY[0] * THOBY[1] * (THOBY[1] * theta).cos()),
        }
    }

    /// The angle to which the radius rises.
    fn end(self) -> f64 {
        match self {
            Self::Rectilinear | Self::Orthographic => FRAC_PI_2,
            Self::Equidistant | Self::Equisolid | Self::Stereographic => PI,
            Self::Thoby => FRAC_PI_2 / THOBY[1],
        }
    }
}

/// A lens with PanoTools' a, b, c. Direction: **ideal to distorted**; y points down; the centre of the first pixel is (0, 0); normalised by the focal length.
///
/// With the angle from the axis `theta` and its radius `u` by the projection (`tan theta` of a rectilinear lens), `r = u (1 + c u + b u^2 + a u^3)`, and the image at the
/// distance `f r` from the principal point, in the direction of the ray. The tools normalise by half of the shorter side of the image, and scale so that the polynomial
/// is one there: `r' = u' (a' u'^3 + b' u'^2 + c' u' + 1 - a' - b' - c')`; [`Self::of_tool`] and [`Self::tool`] lead from and to that.
///
/// Source: PanoTools wiki, Lens correction model; lensfun's manual, distortion models `ptlens`, `poly3`; Hugin's manual, lens types.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PtLens {
    /// Size of its images.
    pub size: ImageSize,
    /// How it pictures angles.
    pub projection: LensProjection,
    /// Focal length on the axis, px.
    pub f: f64,
    /// Principal point, x, px from the centre of the first pixel.
    pub cx: f64,
    /// Principal point, y, px downwards from the centre of the first pixel.
    pub cy: f64,
    /// Coefficient of u^3 in the factor, a number.
    pub a: f64,
    /// Of u^2.
    pub b: f64,
    /// Of u.
    pub c: f64,
}

/// The convention of [`PtLens`].
pub const CONVENTION: Convention = Convention {
    name: "ptlens",
    about: "PanoTools, Hugin, lensfun: f, a, b, c on a rectilinear or a fisheye radius",
    version: "",
    order: TangentialOrder::Without,
    normalisation: "divided by the focal length on the axis; files by half of the shorter side, so that the polynomial is one there",
    source: "PanoTools wiki, Lens correction model; lensfun manual, elem_distortion",
    verification: Verification::Verified("lensfun 0.3.4 and PanoTools 2.9.21 picture alike, to the digits of each"),
    ..opencv::CONVENTION
};

const NAMES: [(&str, &str); 6] = [("f", "px"), ("cx", "px"), ("cy", "px"), ("a", ""), ("b", ""), ("c", "")];

/// The camera with a focal length of one pixel around its axis.
struct Normalised(PtLens);

impl Normalised {
    /// The factor's product with u, and its derivative.
    fn polynomial(&self, u: f64) -> (f64, f64) {
        let PtLens { a, b, c, .. } = self.0;
        (u * (1.0 + u * (c + u * (b + u * a))), 1.0 + u * (2.0 * c + u * (3.0 * b + u * 4.0 * a)))
    }

    /// A bound of how much the coefficients take from the slope.
    fn is_surely_rising(&self, theta: f64) -> bool {
        let PtLens { a, b, c, .. } = self.0;
        let u = self.0.projection.radius(theta).0;
        u * (2.0 * c.abs() + u * (3.0 * b.abs() + u * 4.0 * a.abs())) < 1.0
    }
}

impl Axial for Normalised {
    fn focal(&self) -> Focal {
        Focal { size: self.0.size, fx: 1.0, fy: 1.0, cx: 0.0, cy: 0.0 }
    }

    fn radius(&self, theta: f64) -> (f64, f64) {
        let (u, slope) = self.0.projection.radius(theta);
        let (r, by_u) = self.polynomial(u);
        (r, by_u * slope)
    }

    fn end(&self) -> f64 {
        let end = self.0.projection.end();
        first_fold(|theta| self.polynomial(self.0.projection.radius(theta).0).1, end, PLACES).unwrap_or(end)
    }

    fn by_lens(&self, theta: f64) -> Vec<f64> {
        let u = self.0.projection.radius(theta).0;
        vec![u.powi(4), u.powi(3), u.powi(2)]
    }

    fn pictures(&self, theta: f64) -> bool {
        theta < self.0.projection.end() && (self.is_surely_rising(theta) || theta < self.end())
    }
}

impl PtLens {
    /// The lens of a tool's coefficients: `a'`, `b'`, `c'` for radii in `unit`, px, and the focal length of the undistorted image, px.
    pub fn of_tool(size: ImageSize, projection: LensProjection, focal: f64, [cx, cy]: [f64; 2], [a, b, c]: [f64; 3], unit: f64) -> Self {
        let (d, s) = (1.0 - a - b - c, focal / unit);
        // u' = s u in units of `unit`, and d f is what is left on the axis.
        Self { size, projection, f: d * focal, cx, cy, a: a / d * s.powi(3), b: b / d * s * s, c: c / d * s }
    }

    /// The focal length of the undistorted image, px, and `a'`, `b'`, `c'` for radii in `unit`, px; `None` where no ray is pictured at that distance.
    pub fn tool(&self, unit: f64) -> Option<(f64, [f64; 3])> {
        // What is pictured at the distance `unit` stays there: unit = f u (1 + c u + b u^2 + a u^3), and the undistorted focal length is unit / u.
        let (lens, goal) = (Normalised(*self), unit / self.f);
        let end = 4.0 * goal + 4.0;
        let (mut low, mut high) = (0.0, first_fold(|u| lens.polynomial(u).1, end, PLACES).unwrap_or(end));
        let mut u = goal.min(high);
        for _ in 0..MOST_STEPS {
            let (value, slope) = lens.polynomial(u);
            if value <= goal {
                low = u;
            } else {
                high = u;
            }
            let newton = u - (value - goal) / slope;
            let next = if newton >= low && newton <= high { newton } else { 0.5 * (low + high) };
            if (next - u).abs() <= 1e-16 * u {
                break;
            }
            u = next;
        }
        let focal = unit / u;
        let (d, s) = (self.f / focal, focal / unit);
        let missed = (lens.polynomial(u).0 - goal).abs() > 1e-9 * goal;
        (!missed && focal.is_finite()).then(|| (focal, [self.a * d / s.powi(3), self.b * d / (s * s), self.c * d / s]))
    }

    /// The radius of a small angle over the angle: one for all projections but Thoby's.
    pub(crate) fn slope_on_axis(projection: LensProjection) -> f64 {
        projection.radius(0.0).1
    }

    fn pixel(&self, at: PixelPoint) -> PixelPoint {
        PixelPoint::new(self.f * at.x + self.cx, self.f * at.y + self.cy)
    }
}

impl CameraModel for PtLens {
    fn size(&self) -> ImageSize {
        self.size
    }

    fn parameters(&self) -> Vec<CameraParameter> {
        named(&NAMES, &[self.f, self.cx, self.cy, self.a, self.b, self.c])
    }

    fn with_parameters(&self, v: &[f64]) -> Self {
        Self { f: v[0], cx: v[1], cy: v[2], a: v[3], b: v[4], c: v[5], ..*self }
    }

    fn project(&self, ray: Ray) -> Result<PixelPoint, NoCounterpart> {
        let found = self.pixel(wide_angle::project(&Normalised(*self), ray)?);
        if found.is_finite() { Ok(found) } else { Err(NoCounterpart::NoSolution) }
    }

    fn unproject(&self, point: PixelPoint) -> Result<Ray, NoCounterpart> {
        let at = PixelPoint::new((point.x - self.cx) / self.f, (point.y - self.cy) / self.f);
        wide_angle::unproject(&Normalised(*self), at)
    }

    fn derivatives_into(&self, ray: Ray, into: &mut DerivativeBuffer) -> Result<(), NoCounterpart> {
        let mut inner = DerivativeBuffer::default();
        wide_angle::derivatives_into(&Normalised(*self), ray, &mut inner)?;
        let PixelPoint { x, y } = inner.point;
        into.clear();
        into.point = self.pixel(inner.point);
        into.by_ray = inner.by_ray.map(|row| row.map(|by| self.f * by));
        into.extend([[x, y], [1.0, 0.0], [0.0, 1.0]]);
        // After fx, fy, cx, cy come those of the lens.
        into.extend(inner.by_parameters()[4..].iter().map(|by| by.map(|by| self.f * by)));
        Ok(())
    }

    fn fold_towards(&self, angle: f64) -> Option<PixelPoint> {
        let end = Normalised(*self).end();
        // The radius of a lens that pictures a pole goes on without end.
        let widest = Normalised(*self).radius(end).0;
        let (sin, cos) = angle.sin_cos();
        (widest.is_finite() && widest < 1e6).then(|| self.pixel(PixelPoint::new(widest * cos, widest * sin)))
    }
}

impl Reframe for PtLens {
    fn has_two_scales(&self) -> bool {
        false
    }

    fn resampled(&self, by: &Resampling) -> Self {
        let (at, [f, _]) = (by.point(PixelPoint::new(self.cx, self.cy)), by.lengths([self.f, self.f]));
        Self { size: by.size, f, cx: at.x, cy: at.y, ..*self }
    }

    fn turned(&self, turn: Turn) -> Self {
        let at = turn.point(self.size, PixelPoint::new(self.cx, self.cy));
        Self { size: turn.size(self.size), cx: at.x, cy: at.y, ..*self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::OpenCvFisheye;
    use crate::camera::conformance::{self, Shape};

    const SIZE: ImageSize = ImageSize { width: 1600, height: 1200 };

    fn camera(projection: LensProjection) -> PtLens {
        PtLens { size: SIZE, projection, f: 1100.0, cx: 803.2, cy: 598.7, a: 0.01, b: -0.06, c: 0.012 }
    }

    #[test]
    fn conforms() {
        for projection in LensProjection::ALL {
            conformance::check(&PtLens { c: -0.012, ..camera(projection) }, Shape::Barrel);
            wide_angle::tests::rises_to_its_end(&Normalised(PtLens { a: -0.03, b: 0.0, ..camera(LensProjection::Stereographic) }));
        }
    }

    #[test]
    fn with_b_alone_it_is_brown_s_k1() {
        let ours = PtLens { a: 0.0, c: 0.0, ..camera(LensProjection::Rectilinear) };
        let fisheye = PtLens { projection: LensProjection::Equidistant, ..ours };
        let PtLens { size, f, cx, cy, b, .. } = ours;
        let mut distortion = [0.0; 14];
        distortion[0] = b;
        let brown = super::super::OpenCv { size, fx: f, fy: f, cx, cy, distortion, coefficients: 4 };
        let opencv = OpenCvFisheye { size, fx: f, fy: f, cx, cy, skew: 0.0, k: [b, 0.0, 0.0, 0.0] };
        for (x, y, z) in [(0.0, 0.0, -1.0), (0.5, 0.3, -1.0), (-0.4, 0.2, -0.9)] {
            let ray = Ray { x, y, z };
            assert!(ours.project(ray).unwrap().distance(brown.project(ray).unwrap()) < 1e-10);
            assert!(fisheye.project(ray).unwrap().distance(opencv.project(ray).unwrap()) < 1e-10);
        }
    }

    #[test]
    fn an_angle_has_its_radius() {
        for projection in LensProjection::ALL {
            for theta in [0.1, 0.7, 1.4] {
                let radius = projection.radius_of(theta).unwrap();
                assert!((projection.angle_of(radius).unwrap() - theta).abs() < 1e-12, "{projection:?}");
            }
            assert!(projection.radius_of(4.0).is_none());
        }
        assert!(LensProjection::Orthographic.angle_of(1.1).is_none());
    }

    #[test]
    fn a_tool_s_numbers_come_back() {
        for coefficients in [[0.01, -0.03, 0.008], [-0.02, 0.0, 0.0], [0.0, -0.15, 0.0], [0.0; 3]] {
            let lens = PtLens::of_tool(SIZE, LensProjection::Rectilinear, 1300.0, [799.5, 599.5], coefficients, 600.0);
            let (focal, found) = lens.tool(600.0).unwrap();
            assert!((focal - 1300.0).abs() < 1e-9, "{focal}");
            assert!(found.iter().zip(coefficients).all(|(a, b)| (a - b).abs() < 1e-14), "{found:?}");
            // What the tool pictures at half of the shorter side stays there.
            let at = lens.project(Ray::from_tangent(600.0 / 1300.0, 0.0)).unwrap();
            assert!((at.x - 799.5 - 600.0).abs() < 1e-9, "{at:?}");
        }
    }
}
