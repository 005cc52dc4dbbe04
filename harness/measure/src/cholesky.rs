//! Small symmetric positive definite systems, without allocation.

/// At or below this fraction of its diagonal element a pivot counts as zero.
pub(crate) const SINGULAR: f64 = 1e-12;

/// The triangular factor L of the first rows and columns of a matrix. Sums are worked out by columns, so that none waits for itself.
pub(crate) struct Factor<const N: usize> {
    /// L below its diagonal, and its transpose above.
    both: [[f64; N]; N],
    /// One over the diagonal.
    inverse: [f64; N],
    count: usize,
}

/// Factors the first `count` rows and columns of `matrix`; `None` if these are singular, with a pivot of no more than `singular` of its diagonal element, or hold
/// a number that is none.
#[inline(always)]
pub(crate) fn factor<const N: usize>(matrix: &[[f64; N]; N], count: usize, singular: f64) -> Option<Factor<N>> {
    let (mut both, mut inverse) = (*matrix, [0.0; N]);
    for k in 0..count {
        let pivot = both[k][k];
        if !(pivot > singular * matrix[k][k] && pivot.is_finite() && pivot > 0.0) {
            return None;
        }
        inverse[k] = 1.0 / pivot.sqrt();
        let column: [f64; N] = std::array::from_fn(|i| both[k][i] * inverse[k]);
        for row in k + 1..count {
            for i in 0..N {
                both[row][i] -= if i > k { column[row] * column[i] } else { 0.0 };
            }
            both[row][k] = column[row];
        }
        both[k][k + 1..].copy_from_slice(&column[k + 1..]);
    }
    Some(Factor { both, inverse, count })
}

impl<const N: usize> Factor<N> {
    /// The solution for a right-hand side; zero beyond the factored rows.
    #[inline(always)]
    pub(crate) fn solve(&self, right: &[f64; N]) -> [f64; N] {
        let mut x = self.halfway(right);
        for i in (0..self.count).rev() {
            x[i] *= self.inverse[i];
            for k in 0..i {
                x[k] -= self.both[i][k] * x[i];
            }
        }
        x
    }

    /// The first `M` rows and columns of the inverse matrix.
    #[inline(always)]
    pub(crate) fn inverse<const M: usize>(&self) -> [[f64; M]; M] {
        let halves: [[f64; N]; M] = std::array::from_fn(|i| self.halfway(&std::array::from_fn(|k| if k == i { 1.0 } else { 0.0 })));
        let product = |i: usize, j: usize| halves[i].iter().zip(&halves[j]).map(|(a, b)| a * b).sum();
        std::array::from_fn(|i| std::array::from_fn(|j| product(i, j)))
    }

    /// `L^-1` times a right-hand side; zero beyond the factored rows. The products of two of them are those with the inverse matrix between.
    #[inline(always)]
    pub(crate) fn halfway(&self, right: &[f64; N]) -> [f64; N] {
        let mut x = [0.0; N];
        x[..self.count].copy_from_slice(&right[..self.count]);
        for k in 0..self.count {
            x[k] *= self.inverse[k];
            for i in k + 1..self.count {
                x[i] -= self.both[k][i] * x[k];
            }
        }
        x
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solves_what_it_factored() {
        let matrix = [[4.0, 1.0, -0.5], [1.0, 3.0, 0.2], [-0.5, 0.2, 2.0]];
        let x = factor(&matrix, 3, SINGULAR).unwrap().solve(&[1.0, -2.0, 0.5]);
        for (row, right) in matrix.iter().zip([1.0, -2.0, 0.5]) {
            assert!((row.iter().zip(&x).map(|(a, x)| a * x).sum::<f64>() - right).abs() < 1e-14);
        }
        let x = factor(&matrix, 2, SINGULAR).unwrap().solve(&[1.0, -2.0, 7.0]);
        assert!((4.0 * x[0] + x[1] - 1.0).abs() < 1e-14 && x[2] == 0.0);
    }

    #[test]
    fn singular_matrices_have_no_factor() {
        assert!(factor(&[[1.0, 1.0], [1.0, 1.0]], 2, SINGULAR).is_none());
        assert!(factor(&[[0.0, 0.0], [0.0, 1.0]], 2, SINGULAR).is_none());
        assert!(factor(&[[f64::NAN, 0.0], [0.0, 1.0]], 2, SINGULAR).is_none());
    }
}
