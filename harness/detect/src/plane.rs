//! Points and maps of planes.

use calibench_model::{Affine, PixelPoint};
use nalgebra::{DMatrix, Matrix3, Vector3};

/// A point of a plane: px in an image (x right, y down), object units on a board (u right, v up).
pub(crate) type Point = [f64; 2];

pub(crate) fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

pub(crate) fn plus(a: Point, b: Point) -> Point {
    [a[0] + b[0], a[1] + b[1]]
}

pub(crate) fn times(a: Point, factor: f64) -> Point {
    [factor * a[0], factor * a[1]]
}

pub(crate) fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Positive where `b` is clockwise of `a` in an image.
pub(crate) fn cross(a: Point, b: Point) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

pub(crate) fn length(a: Point) -> f64 {
    a[0].hypot(a[1])
}

pub(crate) fn distance(a: Point, b: Point) -> f64 {
    length(minus(a, b))
}

pub(crate) fn mean(points: &[Point]) -> Point {
    times(points.iter().fold([0.0, 0.0], |sum, point| plus(sum, *point)), 1.0 / points.len() as f64)
}

pub(crate) fn pixel([x, y]: Point) -> PixelPoint {
    PixelPoint::new(x, y)
}

/// The linear part of a map of planes, row by row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Linear(pub [[f64; 2]; 2]);

impl Linear {
    pub(crate) fn of(self, a: Point) -> Point {
        self.0.map(|row| dot(row, a))
    }

    pub(crate) fn determinant(self) -> f64 {
        cross(self.0[0], self.0[1])
    }

    /// What it maps to `a`; `None` if it is none or many.
    pub(crate) fn back(self, a: Point) -> Option<Point> {
        let (det, [[p, q], [r, s]]) = (self.determinant(), self.0);
        (det != 0.0).then(|| [(s * a[0] - q * a[1]) / det, (p * a[1] - r * a[0]) / det])
    }

    /// As the affine part of a target's map: its own axes lie along `axes` of the board and their unit is `size`.
    pub(crate) fn affine(self, [u, v]: [Point; 2], size: f64) -> Affine {
        let [x, y] = [self.of(times(u, size)), self.of(times(v, size))];
        Affine { axx: x[0], axy: y[0], ayx: x[1], ayy: y[1] }
    }
}

/// A homography.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Homography(Matrix3<f64>);

impl Homography {
    /// From the unit square to a quadrangle: (0, 0), (1, 0), (1, 1), (0, 1) in its order. `None` for one without area.
    pub(crate) fn of_unit_square([a, b, c, d]: [Point; 4]) -> Option<Self> {
        let (p, q) = (minus(b, c), minus(d, c));
        let s = plus(minus(a, b), minus(c, d));
        let det = cross(p, q);
        if det.abs() < 1e-9 {
            return None;
        }
        let (g, h) = (cross(s, q) / det, cross(p, s) / det);
        let row = |i: usize| [b[i] - a[i] + g * b[i], d[i] - a[i] + h * d[i], a[i]];
        let [[x0, x1, x2], [y0, y1, y2]] = [row(0), row(1)];
        Some(Self(Matrix3::new(x0, x1, x2, y0, y1, y2, g, h, 1.0)))
    }

    /// From the plane of `square`, whose corners are those of a square or a parallelogram, to a quadrangle.
    pub(crate) fn of_square([a, b, _, d]: [Point; 4], quad: [Point; 4]) -> Option<Self> {
        let (p, q) = (minus(b, a), minus(d, a));
        let to_plane = Matrix3::new(p[0], q[0], a[0], p[1], q[1], a[1], 0.0, 0.0, 1.0);
        Some(Self(Self::of_unit_square(quad)?.0 * to_plane.try_inverse()?))
    }

    /// The least-squares one of at least four pairs (from, to). `None` where they determine none.
    pub(crate) fn fitted(pairs: &[(Point, Point)]) -> Option<Self> {
        if pairs.len() < 4 {
            return None;
        }
        let (from, to) = (normal(pairs.iter().map(|pair| pair.0))?, normal(pairs.iter().map(|pair| pair.1))?);
        let mut rows = DMatrix::zeros(2 * pairs.len().max(5), 9);
        for (i, (a, b)) in pairs.iter().enumerate() {
            let ([u, v], [x, y]) = (Self(from).at(*a), Self(to).at(*b));
            let both = [[u, v, 1.0, 0.0, 0.0, 0.0, -x * u, -x * v, -x], [0.0, 0.0, 0.0, u, v, 1.0, -y * u, -y * v, -y]];
            for (k, row) in both.iter().enumerate() {
                row.iter().enumerate().for_each(|(j, value)| rows[(2 * i + k, j)] = *value);
            }
        }
        let eigen = (rows.transpose() * &rows).symmetric_eigen();
        let least = eigen.eigenvalues.imin();
        let h = Matrix3::from_row_iterator(eigen.eigenvectors.column(least).iter().copied());
        let map = to.try_inverse()? * h * from;
        (map[(2, 2)].abs() > 1e-12).then(|| Self(map / map[(2, 2)]))
    }

    /// Its elements, row by row.
    pub(crate) fn elements(&self) -> impl Iterator<Item = f64> + use<> {
        self.0.transpose().data.0.into_iter().flatten()
    }

    pub(crate) fn at(&self, [u, v]: Point) -> Point {
        let image = self.0 * Vector3::new(u, v, 1.0);
        [image.x / image.z, image.y / image.z]
    }

    /// Its derivative at a point.
    pub(crate) fn linear(&self, [u, v]: Point) -> Linear {
        let image = self.0 * Vector3::new(u, v, 1.0);
        let at = [image.x / image.z, image.y / image.z];
        let row = |i: usize| [0, 1].map(|j| (self.0[(i, j)] - at[i] * self.0[(2, j)]) / image.z);
        Linear([row(0), row(1)])
    }
}

/// Moves the middle of points to the origin and scales them to a mean distance of one.
fn normal(points: impl Iterator<Item = Point> + Clone) -> Option<Matrix3<f64>> {
    let all: Vec<Point> = points.collect();
    let middle = mean(&all);
    let spread = all.iter().map(|point| distance(*point, middle)).sum::<f64>() / all.len() as f64;
    let scale = 1.0 / spread;
    scale.is_finite().then(|| Matrix3::new(scale, 0.0, -scale * middle[0], 0.0, scale, -scale * middle[1], 0.0, 0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn homographies_meet_their_points_and_their_differences() {
        let quad = [[10.0, 12.0], [50.0, 8.0], [61.0, 55.0], [5.0, 40.0]];
        let square = [[-1.0, 3.0], [1.0, 3.0], [1.0, 1.0], [-1.0, 1.0]];
        let map = Homography::of_square(square, quad).unwrap();
        let pairs: Vec<(Point, Point)> = square.into_iter().zip(quad).collect();
        let fitted = Homography::fitted(&pairs).unwrap();
        for (from, to) in &pairs {
            assert!(distance(map.at(*from), *to) < 1e-9 && distance(fitted.at(*from), *to) < 1e-6, "{from:?}");
        }
        let (at, step) = ([0.3, 1.7], 1e-6);
        let linear = map.linear(at);
        for direction in [[1.0, 0.0], [0.0, 1.0]] {
            let there = map.at(plus(at, times(direction, step)));
            assert!(distance(times(minus(there, map.at(at)), 1.0 / step), linear.of(direction)) < 1e-3);
        }
    }
}
