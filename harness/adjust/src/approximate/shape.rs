//! The extent of a set of points: a line, a plane or space.

use nalgebra::{Matrix3, Point3, SMatrix, Vector3};

/// Shares of the longest extent below which another is none: half the digits, as the extents come from squares.
pub(super) const FLAT: f64 = 1e-7;
/// Sweeps of Jacobi's rotations; five or six are enough.
const MOST_SWEEPS: usize = 30;

/// Where points lie: their centroid and how far they spread along three axes.
#[derive(Clone, Copy, Debug)]
pub struct Shape {
    /// The mean of the points, object units.
    pub centroid: Point3<f64>,
    /// Columns: the directions, longest first, right-handed.
    pub axes: Matrix3<f64>,
    /// Root mean squares along the axes, object units.
    pub extents: [f64; 3],
}

impl Shape {
    /// The shape of at least one point.
    pub fn of(points: impl Iterator<Item = Point3<f64>> + Clone) -> Self {
        let count = points.clone().count().max(1) as f64;
        let centroid = Point3::from(points.clone().map(|p| p.coords).sum::<Vector3<f64>>() / count);
        let mut moments = Matrix3::zeros();
        for point in points {
            let d = point - centroid;
            moments.ger(1.0 / count, &d, &d, 1.0);
        }
        let (values, vectors) = ascending(moments);
        let (first, second): (Vector3<f64>, Vector3<f64>) = (vectors.column(2).into(), vectors.column(1).into());
        let axes = Matrix3::from_columns(&[first, second, first.cross(&second)]);
        Self { centroid, axes, extents: [2, 1, 0].map(|i| values[i].max(0.0).sqrt()) }
    }

    pub(super) fn is_line(&self) -> bool {
        self.extents[1].is_nan() || self.extents[1] <= FLAT * self.extents[0]
    }

    pub(super) fn is_plane(&self) -> bool {
        self.extents[2] <= FLAT * self.extents[0]
    }

    /// A point in the plane of the two longest axes, from the centroid.
    pub fn in_plane(&self, point: &Point3<f64>) -> [f64; 2] {
        let d = point - self.centroid;
        [self.axes.column(0).dot(&d), self.axes.column(1).dot(&d)]
    }

    /// How far a point is above that plane, on the side of the third axis.
    pub fn height(&self, point: &Point3<f64>) -> f64 {
        self.axes.column(2).dot(&(point - self.centroid))
    }

    /// The smallest extent and the middle one, relative to the largest: 0 of points that coincide.
    pub fn relative(&self) -> [f64; 2] {
        [2, 1].map(|i| self.extents[i] / self.extents[0].max(f64::MIN_POSITIVE))
    }
}

/// Eigenvalues of a symmetric matrix, ascending, and their vectors in the columns: Jacobi's rotations, for a handful of rows.
pub(super) fn ascending<const N: usize>(mut matrix: SMatrix<f64, N, N>) -> ([f64; N], SMatrix<f64, N, N>) {
    let mut vectors = SMatrix::<f64, N, N>::identity();
    for _ in 0..MOST_SWEEPS {
        let outside: f64 = (0..N).flat_map(|i| (0..i).map(move |j| (i, j))).map(|at| matrix[at] * matrix[at]).sum();
        if outside.is_nan() || outside <= (f64::EPSILON * f64::EPSILON * 1e-4) * matrix.norm_squared() {
            break;
        }
        for i in 1..N {
            (0..i).for_each(|j| rotate(&mut matrix, &mut vectors, i, j));
        }
    }
    let mut order: [usize; N] = std::array::from_fn(|i| i);
    order.sort_by(|&a, &b| matrix[(a, a)].total_cmp(&matrix[(b, b)]));
    (order.map(|i| matrix[(i, i)]), SMatrix::from_fn(|row, column| vectors[(row, order[column])]))
}

/// Makes the element (i, j) zero.
fn rotate<const N: usize>(matrix: &mut SMatrix<f64, N, N>, vectors: &mut SMatrix<f64, N, N>, i: usize, j: usize) {
    let off = matrix[(i, j)];
    if off == 0.0 {
        return;
    }
    let half = (matrix[(j, j)] - matrix[(i, i)]) / (2.0 * off);
    // Not `hypot`, which takes longer than the rest: a square that overflows belongs to an angle of zero.
    let tangent = if half < 0.0 { -1.0 } else { 1.0 } / (half.abs() + (half * half + 1.0).sqrt());
    let cosine = 1.0 / (tangent * tangent + 1.0).sqrt();
    let sine = tangent * cosine;
    for k in 0..N {
        let (a, b) = (matrix[(k, i)], matrix[(k, j)]);
        (matrix[(k, i)], matrix[(k, j)]) = (cosine * a - sine * b, sine * a + cosine * b);
        let (a, b) = (vectors[(k, i)], vectors[(k, j)]);
        (vectors[(k, i)], vectors[(k, j)]) = (cosine * a - sine * b, sine * a + cosine * b);
    }
    for k in 0..N {
        let (a, b) = (matrix[(i, k)], matrix[(j, k)]);
        (matrix[(i, k)], matrix[(j, k)]) = (cosine * a - sine * b, sine * a + cosine * b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_planes_and_bodies_are_told_apart() {
        let at = |f: fn(f64) -> [f64; 3]| Shape::of((0..9).map(move |i| Point3::from(f(f64::from(i)))));
        let line = at(|t| [1e4 + t, 2.0 * t, -t]);
        assert!(line.is_line() && line.is_plane());
        let plane = at(|t| [t, (2.0 * t).sin(), 3.0 * t + 1.0]);
        assert!(!plane.is_line() && plane.is_plane());
        let body = at(|t| [t, (2.0 * t).sin(), 3.0 * t.cos()]);
        assert!(!body.is_line() && !body.is_plane());
        assert!((body.axes.determinant() - 1.0).abs() < 1e-12);
        assert!(Shape::of(std::iter::once(Point3::origin())).is_line());
    }

    #[test]
    fn eigenvectors_are_those_of_a_library() {
        let m = SMatrix::<f64, 5, 5>::from_fn(|i, j| ((i * j + i + j) as f64).sin() + if i == j { 2.0 } else { 0.0 });
        let (values, vectors) = ascending(m);
        let mut expected: Vec<f64> = m.symmetric_eigenvalues().iter().copied().collect();
        expected.sort_by(f64::total_cmp);
        values.iter().zip(&expected).for_each(|(a, b)| assert!((a - b).abs() < 1e-13, "{values:?} {expected:?}"));
        let rebuilt = vectors * SMatrix::<f64, 5, 5>::from_diagonal(&values.into()) * vectors.transpose();
        assert!((rebuilt - m).norm() < 1e-13);
        assert!((vectors.transpose() * vectors - SMatrix::<f64, 5, 5>::identity()).norm() < 1e-13);
    }
}
