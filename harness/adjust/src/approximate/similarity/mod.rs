//! Absolute orientation: a similarity between two sets of points.

use nalgebra::{Matrix3, Point3, Vector3};

use super::ApproximateError;
use super::error::at_least;
use super::shape::{FLAT, Shape};

/// A similarity of space: `X' = s R X + t`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Similarity {
    /// `s`, positive: units of the target per unit of what is transformed.
    pub scale: f64,
    /// `R`, 3 x 3, of determinant +1.
    pub rotation: Matrix3<f64>,
    /// `t`, in the units of the target.
    pub translation: Vector3<f64>,
    /// Root mean square distance of the target from the transformed points, in the units of the target.
    pub rms: f64,
}

impl Similarity {
    /// The transformed point, in the units of the target.
    pub fn apply(&self, point: &Point3<f64>) -> Point3<f64> {
        Point3::from(self.scale * (self.rotation * point.coords) + self.translation)
    }
}

/// The similarity that brings `from` closest to `to`, point by point, in the least-squares sense; with `with_scale` false the scale is one.
///
/// # Errors
/// [`ApproximateError::TooFew`] below three pairs (the shorter list counts), [`ApproximateError::NotFinite`], [`ApproximateError::Collinear`] when either
/// set lies on a line: the rotation about it is free. [`ApproximateError::Critical`] when the sets are so unlike that several rotations do.
///
/// Source: Umeyama 1991, Eq. 34 to 43.
pub fn similarity(from: &[Point3<f64>], to: &[Point3<f64>], with_scale: bool) -> Result<Similarity, ApproximateError> {
    let count = from.len().min(to.len());
    at_least(3, count, "points", "a similarity")?;
    let (from, to) = (&from[..count], &to[..count]);
    let finite = |point: &Point3<f64>| point.iter().all(|value| value.is_finite());
    if let Some(index) = (0..count).find(|&i| !finite(&from[i]) || !finite(&to[i])) {
        return Err(ApproximateError::NotFinite { index });
    }
    let (shape, target) = (Shape::of(from.iter().copied()), Shape::of(to.iter().copied()));
    if shape.is_line() || target.is_line() {
        return Err(ApproximateError::Collinear);
    }
    let mut products = Matrix3::zeros();
    for (a, b) in from.iter().zip(to) {
        products += (b - target.centroid) * (a - shape.centroid).transpose() / count as f64;
    }
    let svd = products.svd(true, true);
    let (Some(u), Some(v)) = (svd.u, svd.v_t) else { return Err(CRITICAL) };
    let values = svd.singular_values;
    let handed = (u * v).determinant().signum();
    // Without a second direction, or with equal ones of which one must be mirrored, the rotation is not unique.
    if values[1] + handed * values[2] <= FLAT * FLAT * values[0] {
        return Err(CRITICAL);
    }
    let rotation = u * Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, handed)) * v;
    let spread: f64 = shape.extents.iter().map(|extent| extent * extent).sum();
    let scale = if with_scale { (values[0] + values[1] + handed * values[2]) / spread } else { 1.0 };
    let translation = target.centroid.coords - scale * (rotation * shape.centroid.coords);
    // Centred, so that large coordinates cost no digits.
    let square = |(a, b): (&Point3<f64>, &Point3<f64>)| (scale * (rotation * (a - shape.centroid)) - (b - target.centroid)).norm_squared();
    let rms = (from.iter().zip(to).map(square).sum::<f64>() / count as f64).sqrt();
    Ok(Similarity { scale, rotation, translation, rms })
}

const CRITICAL: ApproximateError = ApproximateError::Critical { what: "the rotation" };

#[cfg(test)]
mod tests;
