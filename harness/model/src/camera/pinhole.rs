//! What the tools' pinhole cameras have in common: ideal tangents, distorted ones, an affinity to pixels.

use super::fold::{corners, is_inside};
use super::newton::{ValueAndDerivatives, determinant};
use super::plane_map::{PlaneMap, first_fold, invert, is_on_branch};
use super::{CameraModel, CameraParameter, DerivativeBuffer, ImageSize, NoCounterpart, Ray, Slopes};
use crate::PixelPoint;

/// The widest angle from the axis at which folds are looked for, radians, and the places on the way.
const WIDEST: f64 = 1.56;
const PLACES: usize = 400;
/// A circle of ideal tangents around those of the frame, relative, and directions in which its image is looked at.
const AROUND: f64 = 1.2;
const DIRECTIONS: usize = 32;

/// Distorted coordinates to pixels: `x = a x' + b y' + shift.x`, `y = d y' + shift.y`.
#[derive(Clone, Copy, Debug)]
pub struct Affinity {
    pub(super) a: f64,
    pub(super) b: f64,
    pub(super) d: f64,
    pub(super) shift: PixelPoint,
}

impl Affinity {
    fn to_pixel(self, [x, y]: [f64; 2]) -> PixelPoint {
        PixelPoint::new(self.a * x + self.b * y + self.shift.x, self.d * y + self.shift.y)
    }

    fn undo(self, point: PixelPoint) -> [f64; 2] {
        let y = (point.y - self.shift.y) / self.d;
        [(point.x - self.shift.x - self.b * y) / self.a, y]
    }
}

/// A camera that takes ideal tangents (x right, y down) to distorted ones, and these to pixels. It is a [`CameraModel`] by that.
pub trait Pinhole: Copy {
    /// See [`CameraModel::size`].
    fn image_size(&self) -> ImageSize;
    /// See [`CameraModel::parameters`].
    fn named_parameters(&self) -> Vec<CameraParameter>;
    /// See [`CameraModel::with_parameters`].
    #[must_use]
    fn with_values(&self, values: &[f64]) -> Self;
    /// Distorted tangents of ideal ones, with their derivatives by these.
    fn distort(&self, ideal: [f64; 2]) -> ValueAndDerivatives;
    /// Distorted tangents to pixels.
    fn affinity(&self) -> Affinity;
    /// Adds d(pixel) / d(parameter) at ideal tangents, of which the distorted ones are given.
    fn by_parameters(&self, ideal: [f64; 2], distorted: [f64; 2], into: &mut DerivativeBuffer);
    /// Whether the distortion is certainly one to one for ideal tangents within `radius` of the axis; `false` when in doubt.
    fn is_surely_one_to_one(&self, radius: f64) -> bool;
}

struct Distortion<'a, P>(&'a P);

impl<P: Pinhole> PlaneMap for Distortion<'_, P> {
    fn map(&self, at: [f64; 2]) -> ValueAndDerivatives {
        self.0.distort(at)
    }

    fn is_surely_one_to_one(&self, radius: f64) -> bool {
        self.0.is_surely_one_to_one(radius)
    }
}

/// The tangents (right, down) of a ray on the branch of the principal point.
fn ideal<P: Pinhole>(camera: &P, ray: Ray) -> Result<[f64; 2], NoCounterpart> {
    let (u, v) = ray.tangent().ok_or(NoCounterpart::Behind)?;
    let at = [u, -v];
    if is_on_branch(&Distortion(camera), at) { Ok(at) } else { Err(NoCounterpart::Fold) }
}

/// The projection of a ray whose tangents are distorted so.
fn slopes_of(affinity: Affinity, (distorted, slope): ValueAndDerivatives, ray: Ray) -> Slopes {
    let by_ideal = [
        [affinity.a * slope[0][0] + affinity.b * slope[1][0], affinity.a * slope[0][1] + affinity.b * slope[1][1]],
        [affinity.d * slope[1][0], affinity.d * slope[1][1]],
    ];
    let tangent = ray.tangent_derivatives();
    let by_ray = by_ideal.map(|[x, y]| std::array::from_fn(|axis| x * tangent[0][axis] - y * tangent[1][axis]));
    Slopes { point: affinity.to_pixel(distorted), by_ray }
}

impl<P: Pinhole> CameraModel for P {
    fn size(&self) -> ImageSize {
        self.image_size()
    }

    fn parameters(&self) -> Vec<CameraParameter> {
        self.named_parameters()
    }

    fn with_parameters(&self, values: &[f64]) -> Self {
        self.with_values(values)
    }

    fn project(&self, ray: Ray) -> Result<PixelPoint, NoCounterpart> {
        let at = ideal(self, ray)?;
        Ok(self.affinity().to_pixel(self.distort(at).0))
    }

    fn unproject(&self, point: PixelPoint) -> Result<Ray, NoCounterpart> {
        let [x, y] = invert(&Distortion(self), self.affinity().undo(point))?;
        Ok(Ray::from_tangent(x, -y))
    }

    fn derivatives_into(&self, ray: Ray, into: &mut DerivativeBuffer) -> Result<(), NoCounterpart> {
        let at = ideal(self, ray)?;
        let distorted = self.distort(at);
        into.clear();
        Slopes { point: into.point, by_ray: into.by_ray } = slopes_of(self.affinity(), distorted, ray);
        self.by_parameters(at, distorted.0, into);
        Ok(())
    }

    fn slopes(&self, ray: Ray) -> Result<Slopes, NoCounterpart> {
        Ok(slopes_of(self.affinity(), self.distort(ideal(self, ray)?), ray))
    }

    fn fold_towards(&self, angle: f64) -> Option<PixelPoint> {
        let (sin, cos) = angle.sin_cos();
        let at = |theta: f64| [theta.tan() * cos, theta.tan() * sin];
        let theta = first_fold(|theta| determinant(self.distort(at(theta)).1), WIDEST, PLACES)?;
        Some(self.affinity().to_pixel(self.distort(at(theta)).0))
    }

    fn has_surely_no_fold(&self) -> bool {
        let radius = |corner| self.unproject(corner).ok().and_then(Ray::tangent).map_or(f64::INFINITY, |(x, y)| x.hypot(y));
        let around = AROUND * corners(self.size()).map(radius).into_iter().fold(0.0, f64::max);
        // What lies beyond the circle is pictured beyond its image, which is outside of the frame.
        let is_outside = |i: usize| {
            let (sin, cos) = (std::f64::consts::TAU * i as f64 / DIRECTIONS as f64).sin_cos();
            !is_inside(self.size(), self.affinity().to_pixel(self.distort([around * cos, around * sin]).0))
        };
        around.is_finite() && self.is_surely_one_to_one(around) && (0..DIRECTIONS).all(is_outside)
    }
}

/// Brown's terms on normalised coordinates: `x (1 + k1 r^2 + ...) + [p1 (r^2 + 2 x^2) + 2 p2 x y] (1 + p3 r^2 + p4 r^4)`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Brown {
    pub(super) k: [f64; 4],
    /// In Brown's order.
    pub(super) p: [f64; 4],
}

impl Brown {
    pub(super) fn distort(&self, [x, y]: [f64; 2]) -> ValueAndDerivatives {
        let ([k1, k2, k3, k4], [p1, p2, p3, p4]) = (self.k, self.p);
        let r2 = x * x + y * y;
        let q = 1.0 + r2 * (k1 + r2 * (k2 + r2 * (k3 + r2 * k4)));
        let slope = 2.0 * (k1 + r2 * (2.0 * k2 + r2 * (3.0 * k3 + r2 * 4.0 * k4)));
        let (tx, ty) = (p1 * (r2 + 2.0 * x * x) + 2.0 * p2 * x * y, p2 * (r2 + 2.0 * y * y) + 2.0 * p1 * x * y);
        let (more, rise) = (1.0 + r2 * (p3 + r2 * p4), 2.0 * (p3 + 2.0 * r2 * p4));
        let cross = 2.0 * (p1 * y + p2 * x);
        let by = [
            [q + x * x * slope + (6.0 * p1 * x + 2.0 * p2 * y) * more + tx * rise * x, x * y * slope + cross * more + tx * rise * y],
            [x * y * slope + cross * more + ty * rise * x, q + y * y * slope + (6.0 * p2 * y + 2.0 * p1 * x) * more + ty * rise * y],
        ];
        ([x * q + tx * more, y * q + ty * more], by)
    }

    /// d(distorted) / d(k1 to k4, p1 to p4).
    pub(super) fn by_coefficients(&self, [x, y]: [f64; 2]) -> [[f64; 2]; 8] {
        let [p1, p2, p3, p4] = self.p;
        let r2 = x * x + y * y;
        let more = 1.0 + r2 * (p3 + r2 * p4);
        let (tx, ty) = (p1 * (r2 + 2.0 * x * x) + 2.0 * p2 * x * y, p2 * (r2 + 2.0 * y * y) + 2.0 * p1 * x * y);
        let radial = |power: i32| [x * r2.powi(power), y * r2.powi(power)];
        let first = [(r2 + 2.0 * x * x) * more, 2.0 * x * y * more];
        let second = [2.0 * x * y * more, (r2 + 2.0 * y * y) * more];
        [radial(1), radial(2), radial(3), radial(4), first, second, [tx * r2, ty * r2], [tx * r2 * r2, ty * r2 * r2]]
    }

    pub(super) fn is_surely_one_to_one(&self, radius: f64) -> bool {
        self.p[2] == 0.0 && self.p[3] == 0.0 && super::plane_map::is_one_to_one(radius, &self.k, &self.p[..2], 0.0)
    }
}
