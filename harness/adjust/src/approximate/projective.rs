//! Projective maps to a picture: the linear solution, for planes (3 x 3) and for space (3 x 4).

use nalgebra::{SMatrix, SVector};

use super::shape::ascending;

/// Eigenvalues below this share of the largest are zero: squares of what is left of fifteen digits.
const ZERO: f64 = 1e-13;

/// Moves and scales a plane so that the points' mean is the origin and their root mean square distance from it sqrt(2).
#[derive(Clone, Copy, Debug)]
pub(super) struct Normaliser {
    pub(super) centre: [f64; 2],
    pub(super) scale: f64,
}

impl Normaliser {
    /// `None` if the points coincide, or are not numbers.
    ///
    /// Source: Hartley 1997, In defense of the eight-point algorithm.
    pub(super) fn of(points: impl Iterator<Item = [f64; 2]> + Clone) -> Option<Self> {
        let (mut n, mut sum) = (0.0, [0.0; 2]);
        points.clone().for_each(|[x, y]| (n, sum) = (n + 1.0, [sum[0] + x, sum[1] + y]));
        let centre = [sum[0] / n, sum[1] / n];
        let square = points.map(|[x, y]| (x - centre[0]).powi(2) + (y - centre[1]).powi(2)).sum::<f64>() / n;
        let largest = centre[0].abs().max(centre[1].abs());
        (square > (1e-14 * largest).powi(2) && square.is_finite()).then(|| Self { centre, scale: (2.0 / square).sqrt() })
    }

    pub(super) fn apply(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [(x - self.centre[0]) * self.scale, (y - self.centre[1]) * self.scale]
    }

    /// As a matrix that acts on (x, y, 1).
    pub(super) fn matrix(&self) -> nalgebra::Matrix3<f64> {
        let (s, [x, y]) = (self.scale, self.centre);
        nalgebra::Matrix3::new(s, 0.0, -s * x, 0.0, s, -s * y, 0.0, 0.0, 1.0)
    }

    /// The inverse of [`Self::matrix`].
    pub(super) fn inverse(&self) -> nalgebra::Matrix3<f64> {
        let (s, [x, y]) = (1.0 / self.scale, self.centre);
        nalgebra::Matrix3::new(s, 0.0, x, 0.0, s, y, 0.0, 0.0, 1.0)
    }
}

/// Why a linear solution is none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Undetermined {
    /// The object points span too little.
    Object,
    /// More than one map fits.
    Several,
}

/// The map `P`, 3 x K, that takes homogeneous points `p` to `(u, v)`: the least algebraic distance `|P1 p - u P3 p|^2 + |P2 p - v P3 p|^2` with
/// `|P3| = 1`. The first two rows are eliminated, and an eigenvector of K x K is left of the problem of 3 K unknowns.
///
/// Both sides should be normalised; the sign is that for which `P3 p` is positive on average.
///
/// Source: Abdel-Aziz & Karara 1971; the elimination after Harker & O'Leary 2005, Computation of homographies.
pub(super) fn projective<const K: usize>(
    pairs: impl Iterator<Item = (SVector<f64, K>, [f64; 2])>,
) -> Result<SMatrix<f64, 3, K>, Undetermined> {
    let zeros = SMatrix::<f64, K, K>::zeros();
    let (mut plain, mut by_u, mut by_v, mut by_square) = (zeros, zeros, zeros, zeros);
    let mut mean = SVector::<f64, K>::zeros();
    for (p, [u, v]) in pairs {
        let square = u * u + v * v;
        for j in 0..K {
            for i in j..K {
                let product = p[i] * p[j];
                plain[(i, j)] += product;
                by_u[(i, j)] += product * u;
                by_v[(i, j)] += product * v;
                by_square[(i, j)] += product * square;
            }
        }
        mean += p;
    }
    [&mut plain, &mut by_u, &mut by_v, &mut by_square].into_iter().for_each(mirror);
    let factor = plain.cholesky().ok_or(Undetermined::Object)?;
    let lower = factor.l();
    let pivot = |i: usize| lower[(i, i)] * lower[(i, i)];
    if (0..K).any(|i| pivot(i).is_nan() || pivot(i) <= ZERO * plain.trace()) {
        return Err(Undetermined::Object);
    }
    let (first, second) = (factor.solve(&by_u), factor.solve(&by_v));
    let mut rest = by_square - by_u * first - by_v * second;
    mirror(&mut rest);
    let (values, vectors) = ascending(rest);
    if values[1].is_nan() || values[1] <= ZERO * by_square.trace() {
        return Err(Undetermined::Several);
    }
    let third: SVector<f64, K> = vectors.column(0).into();
    let third = third * if third.dot(&mean) < 0.0 { -1.0 } else { 1.0 };
    Ok(SMatrix::from_rows(&[(first * third).transpose(), (second * third).transpose(), third.transpose()]))
}

/// Copies the lower triangle to the upper.
fn mirror<const K: usize>(matrix: &mut SMatrix<f64, K, K>) {
    matrix.fill_upper_triangle_with_lower_triangle();
}
