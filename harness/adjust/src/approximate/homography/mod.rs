//! Homographies: a plane and its picture.

use nalgebra::{Matrix3, Point3, SVector, Vector3};

use super::ApproximateError;
use super::error::at_least;
use super::least_squares::{Normal, minimise};
use super::projective::{Normaliser, Undetermined, projective};
use super::shape::Shape;

/// A determinant, with both planes normalised and the matrix of unit norm, below which the map flattens its plane.
const SINGULAR: f64 = 1e-10;

/// A projective map of a plane: `(x', y', 1) ~ H (x, y, 1)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Homography {
    /// `H`, of unit norm, with a positive third coordinate at the points it was found from.
    pub matrix: Matrix3<f64>,
}

impl Homography {
    /// The picture `(x', y')` of the point `(x, y)`, in the units of the pairs that the map was found from; `None` beyond the horizon.
    pub fn map(&self, [x, y]: [f64; 2]) -> Option<[f64; 2]> {
        let p = self.matrix * Vector3::new(x, y, 1.0);
        (p.z > 0.0).then(|| [p.x / p.z, p.y / p.z])
    }

    /// Undoes the normalising of both planes.
    fn denormalised(normalised: &Matrix3<f64>, from: &Normaliser, to: &Normaliser) -> Self {
        let matrix = to.inverse() * normalised * from.matrix();
        Self { matrix: matrix / matrix.norm() }
    }
}

/// The homography from pairs of points `(x, y)` and `(x', y')`, of any unit: normalised DLT, exact for exact data.
///
/// # Errors
/// [`ApproximateError::TooFew`] below four pairs, [`ApproximateError::NotFinite`], [`ApproximateError::Collinear`] and
/// [`ApproximateError::ImageCollinear`] when all points, or all but one, lie on a line.
///
/// Source: Hartley & Zisserman 2004, algorithm 4.2.
pub fn homography(pairs: &[([f64; 2], [f64; 2])]) -> Result<Homography, ApproximateError> {
    let (matrix, from, to) = normalised(pairs)?;
    Ok(Homography::denormalised(&matrix, &from, &to))
}

/// The normalised matrix and what normalises the planes.
pub(super) fn normalised(pairs: &[([f64; 2], [f64; 2])]) -> Result<(Matrix3<f64>, Normaliser, Normaliser), ApproximateError> {
    at_least(4, pairs.len(), "points", "a homography")?;
    let finite = |(a, b): &([f64; 2], [f64; 2])| a.iter().chain(b).all(|value| value.is_finite());
    if let Some(index) = pairs.iter().position(|pair| !finite(pair)) {
        return Err(ApproximateError::NotFinite { index });
    }
    let from = Normaliser::of(pairs.iter().map(|pair| pair.0)).ok_or(ApproximateError::Collinear)?;
    let to = Normaliser::of(pairs.iter().map(|pair| pair.1)).ok_or(ApproximateError::ImageCollinear)?;
    let rows = pairs.iter().map(|&(a, b)| {
        let [x, y] = from.apply(a);
        (Vector3::new(x, y, 1.0), to.apply(b))
    });
    let flat = || if all_but_one_in_line(pairs) { ApproximateError::Collinear } else { ApproximateError::ImageCollinear };
    let matrix = projective(rows).map_err(|why| if why == Undetermined::Object { ApproximateError::Collinear } else { flat() })?;
    let matrix = matrix / matrix.norm();
    let determinant = matrix.determinant().abs();
    if determinant.is_nan() || determinant < SINGULAR {
        return Err(flat());
    }
    Ok((matrix, from, to))
}

/// Whether all first points, or all but one, lie on a line.
fn all_but_one_in_line(pairs: &[([f64; 2], [f64; 2])]) -> bool {
    let points = pairs.iter().map(|&([x, y], _)| Point3::new(x, y, 0.0));
    let rest = |left_out: usize| points.clone().enumerate().filter(move |(i, _)| *i != left_out).map(|(_, point)| point);
    // The one is the first point, or that farthest from it, or else both are on the line and it is the one farthest off.
    let largest = |of: &dyn Fn([f64; 2]) -> f64| (0..pairs.len()).max_by(|&a, &b| of(pairs[a].0).total_cmp(&of(pairs[b].0))).unwrap_or(0);
    let Some(&([x, y], _)) = pairs.first() else { return false };
    let farthest = largest(&|[u, v]| (u - x).hypot(v - y));
    let [dx, dy] = [pairs[farthest].0[0] - x, pairs[farthest].0[1] - y];
    let off = largest(&|[u, v]| ((u - x) * dy - (v - y) * dx).abs());
    [0, farthest, off].into_iter().any(|left_out| Shape::of(rest(left_out)).is_line())
}

/// The homography of least squares in the picture, from an approximate one: the distances of `(x', y')` from the mapped `(x, y)`.
///
/// Returns the homography and the sum of the squared distances, in the squared unit of `(x', y')`.
///
/// # Errors
/// As [`homography`]; [`ApproximateError::NoSolution`] when the start does not map every point.
///
/// Source: Hartley & Zisserman 2004, section 4.5, "error in one image".
pub fn refine_homography(start: &Homography, pairs: &[([f64; 2], [f64; 2])]) -> Result<(Homography, f64), ApproximateError> {
    let (_, from, to) = normalised(pairs)?;
    let matrix = to.matrix() * start.matrix * from.inverse();
    let near: Vec<_> = pairs.iter().map(|&(a, b)| (from.apply(a), to.apply(b))).collect();
    // The origin is amidst the points, so the last element of a start that maps them all is not zero.
    let start = matrix / matrix[(2, 2)];
    let moved = |h: &Matrix3<f64>, step: &SVector<f64, 8>| {
        h + Matrix3::new(step[0], step[1], step[2], step[3], step[4], step[5], step[6], step[7], 0.0)
    };
    let (found, normal) = minimise(start, |h| normal(h, &near), moved).ok_or(ApproximateError::NoSolution)?;
    Ok((Homography::denormalised(&found, &from, &to), normal.squares / (to.scale * to.scale)))
}

/// Rows for the eight elements beside the last, row by row.
fn normal(h: &Matrix3<f64>, pairs: &[([f64; 2], [f64; 2])]) -> Option<Normal<8>> {
    let mut normal = Normal::new();
    for &([x, y], [u, v]) in pairs {
        let p = h * Vector3::new(x, y, 1.0);
        if p.z.is_nan() || p.z <= 0.0 {
            return None;
        }
        let w = 1.0 / p.z;
        let (a, b) = (p.x * w, p.y * w);
        normal.add(&SVector::from([x * w, y * w, w, 0.0, 0.0, 0.0, -a * x * w, -a * y * w]), a - u);
        normal.add(&SVector::from([0.0, 0.0, 0.0, x * w, y * w, w, -b * x * w, -b * y * w]), b - v);
    }
    Some(normal)
}

#[cfg(test)]
mod tests;
