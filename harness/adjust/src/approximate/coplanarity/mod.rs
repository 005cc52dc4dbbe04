//! Two pictures: the coplanarity of corresponding rays, and the least residuals in both images that fulfil it.

use calibench_model::PixelPoint;
use calibench_model::camera::{Camera, CameraModel, Ray};
use nalgebra::{Matrix2, Matrix3, Rotation3, SVector, Vector2, Vector3, Vector4};

use super::least_squares::Normal;

/// Steps to the nearest pair of coplanar rays.
const STEPS: usize = 8;
/// A change of the residuals that ends them, px.
const SMALL: f64 = 1e-11;

/// A point in two pictures, with the tangents (right, up) of its rays.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair {
    pub(super) pixels: [PixelPoint; 2],
    pub(super) tangents: [Vector2<f64>; 2],
}

impl Pair {
    /// `None` where a camera pictures nothing.
    pub(super) fn of(cameras: [&Camera; 2], pixels: [PixelPoint; 2]) -> Option<Self> {
        let tangent = |i: usize| cameras[i].unproject(pixels[i]).ok()?.tangent().map(|(x, y)| Vector2::new(x, y));
        Some(Self { pixels, tangents: [tangent(0)?, tangent(1)?] })
    }

    pub(super) fn rays(&self) -> [Vector3<f64>; 2] {
        self.tangents.map(ray)
    }
}

pub(super) fn ray(tangent: Vector2<f64>) -> Vector3<f64> {
    Vector3::new(tangent.x, tangent.y, -1.0)
}

/// Five unknowns: the rotation `M` of the second camera against the first, and the direction of the base from the first to the second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Motion {
    pub(super) rotation: Matrix3<f64>,
    pub(super) base: Vector3<f64>,
}

impl Motion {
    /// Two unit vectors across the base, along which it moves.
    pub(super) fn axes(&self) -> [Vector3<f64>; 2] {
        let first = self.base.cross(&Vector3::ith(self.base.iamin(), 1.0)).normalize();
        [first, self.base.cross(&first)]
    }

    /// After a small rotation about the second camera's axes and a shift of the base along [`Self::axes`].
    pub(super) fn moved(&self, step: &SVector<f64, 5>) -> Self {
        let [a, b] = self.axes();
        let turn = Rotation3::new(Vector3::new(step[0], step[1], step[2]));
        Self { rotation: turn * self.rotation, base: (self.base + a * step[3] + b * step[4]).normalize() }
    }

    /// `q1 . (b x M' q2)`, and its derivatives by both rays.
    fn condition(&self, q1: &Vector3<f64>, q2: &Vector3<f64>) -> (f64, Vector3<f64>, Vector3<f64>) {
        let by_first = self.base.cross(&(self.rotation.transpose() * q2));
        (q1.dot(&by_first), by_first, self.rotation * q1.cross(&self.base))
    }

    /// The derivatives of the condition by the five unknowns.
    pub(super) fn by_unknowns(&self, q1: &Vector3<f64>, q2: &Vector3<f64>) -> SVector<f64, 5> {
        let by_second = self.rotation * q1.cross(&self.base);
        let turn = by_second.cross(q2);
        let by_base = (self.rotation.transpose() * q2).cross(q1);
        let [a, b] = self.axes();
        SVector::from([turn.x, turn.y, turn.z, a.dot(&by_base), b.dot(&by_base)])
    }
}

/// The coplanar rays nearest to a pair in the images.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nearest {
    /// Nearest minus measured: x and y in the first image, x and y in the second, px.
    pub(super) residual: Vector4<f64>,
    rays: [Vector3<f64>; 2],
    /// 1 / the length of the condition's gradient in the images, with the sign of the misclosure.
    weight: f64,
}

/// Iterated linearised conditions of one pair: the Gauss-Helmert model.
///
/// Source: Mikhail & Ackermann 1976, chapter 9; Hartley & Zisserman 2004, section 12.5, for what is minimised.
pub(super) fn nearest(cameras: [&Camera; 2], motion: &Motion, pair: &Pair) -> Option<Nearest> {
    let mut tangents = pair.tangents;
    let mut residual = Vector4::zeros();
    for _ in 0..STEPS {
        let rays = tangents.map(ray);
        let (value, by_first, by_second) = motion.condition(&rays[0], &rays[1]);
        let first = image(cameras[0], &rays[0], pair.pixels[0])?;
        let second = image(cameras[1], &rays[1], pair.pixels[1])?;
        let (g1, g2) = (first.1.transpose() * by_first.xy(), second.1.transpose() * by_second.xy());
        let gradient = Vector4::new(g1.x, g1.y, g2.x, g2.y);
        let at = Vector4::new(first.0.x, first.0.y, second.0.x, second.0.y);
        let square = gradient.norm_squared();
        let misclosure = gradient.dot(&at) - value;
        let next = gradient * (misclosure / square);
        if !next.iter().all(|value| value.is_finite()) {
            return None;
        }
        let shift = next - at;
        tangents = [tangents[0] + first.1 * shift.fixed_rows::<2>(0), tangents[1] + second.1 * shift.fixed_rows::<2>(2)];
        let change = (next - residual).norm();
        residual = next;
        if change < SMALL + 1e-9 * residual.norm() {
            let sign = if misclosure < 0.0 { -1.0 } else { 1.0 };
            return Some(Nearest { residual, rays: tangents.map(ray), weight: sign / square.sqrt() });
        }
    }
    None
}

/// The picture of a ray minus the measured one, and d(tangent) / d(pixel).
fn image(camera: &Camera, ray: &Vector3<f64>, measured: PixelPoint) -> Option<(Vector2<f64>, Matrix2<f64>)> {
    let found = camera.derivatives(Ray { x: ray.x, y: ray.y, z: ray.z }).ok()?;
    let [x, y] = found.by_ray;
    let inverse = Matrix2::new(x[0], x[1], y[0], y[1]).try_inverse()?;
    Some((Vector2::new(found.point.x - measured.x, found.point.y - measured.y), inverse))
}

/// One row for each pair: the signed length of its residual; `None` if a pair has none.
pub(super) fn normal<'a>(cameras: [&Camera; 2], motion: &Motion, pairs: impl Iterator<Item = &'a Pair>) -> Option<Normal<5>> {
    let mut normal = Normal::new();
    for pair in pairs {
        let near = nearest(cameras, motion, pair)?;
        // The length of the residual, signed, falls by the condition's change over the length of its gradient.
        let row = motion.by_unknowns(&near.rays[0], &near.rays[1]) * -near.weight.abs();
        normal.add(&row, near.residual.norm() * near.weight.signum());
    }
    Some(normal)
}

/// The squared distance of a pair from coplanarity, px^2, to first order, with the gradients of [`Slopes`].
///
/// Source: Sampson 1982.
pub(super) fn sampson(motion: &Motion, pair: &Pair, slopes: &Slopes) -> f64 {
    let [q1, q2] = pair.rays();
    let (value, by_first, by_second) = motion.condition(&q1, &q2);
    let square = (slopes[0].transpose() * by_first.xy()).norm_squared() + (slopes[1].transpose() * by_second.xy()).norm_squared();
    let distance = value * value / square;
    if distance.is_finite() { distance } else { f64::INFINITY }
}

/// d(tangent) / d(pixel) at the measured points of a pair.
pub(super) type Slopes = [Matrix2<f64>; 2];

pub(super) fn slopes(cameras: [&Camera; 2], pair: &Pair) -> Option<Slopes> {
    let rays = pair.rays();
    Some([image(cameras[0], &rays[0], pair.pixels[0])?.1, image(cameras[1], &rays[1], pair.pixels[1])?.1])
}

#[cfg(test)]
mod tests;
