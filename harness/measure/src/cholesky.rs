//! Small symmetric positive definite systems, without allocation.

/// At or below this fraction of its diagonal element a pivot counts as zero.
const SINGULAR: f64 = 1e-12;

/// The triangular factor of the first rows and columns of a matrix.
pub(crate) struct Factor<const N: usize> {
    lower: [[f64; N]; N],
    count: usize,
}

/// Factors the first `count` rows and columns of `matrix`; `None` if these are singular or hold a number that is none.
pub(crate) fn factor<const N: usize>(matrix: &[[f64; N]; N], count: usize) -> Option<Factor<N>> {
    let mut lower = [[0.0; N]; N];
    for i in 0..count {
        for j in 0..=i {
            let sum = matrix[i][j] - (0..j).map(|k| lower[i][k] * lower[j][k]).sum::<f64>();
            if i != j {
                lower[i][j] = sum / lower[j][j];
            } else if sum > SINGULAR * matrix[i][i] && sum.is_finite() && sum > 0.0 {
                lower[i][i] = sum.sqrt();
            } else {
                return None;
            }
        }
    }
    Some(Factor { lower, count })
}

impl<const N: usize> Factor<N> {
    /// The solution for a right-hand side; zero beyond the factored rows.
    pub(crate) fn solve(&self, right: &[f64; N]) -> [f64; N] {
        let mut x = [0.0; N];
        for i in 0..self.count {
            x[i] = (right[i] - (0..i).map(|k| self.lower[i][k] * x[k]).sum::<f64>()) / self.lower[i][i];
        }
        for i in (0..self.count).rev() {
            x[i] = (x[i] - (i + 1..self.count).map(|k| self.lower[k][i] * x[k]).sum::<f64>()) / self.lower[i][i];
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
        let x = factor(&matrix, 3).unwrap().solve(&[1.0, -2.0, 0.5]);
        for (row, right) in matrix.iter().zip([1.0, -2.0, 0.5]) {
            assert!((row.iter().zip(&x).map(|(a, x)| a * x).sum::<f64>() - right).abs() < 1e-14);
        }
        let x = factor(&matrix, 2).unwrap().solve(&[1.0, -2.0, 7.0]);
        assert!((4.0 * x[0] + x[1] - 1.0).abs() < 1e-14 && x[2] == 0.0);
    }

    #[test]
    fn singular_matrices_have_no_factor() {
        assert!(factor(&[[1.0, 1.0], [1.0, 1.0]], 2).is_none());
        assert!(factor(&[[0.0, 0.0], [0.0, 1.0]], 2).is_none());
        assert!(factor(&[[f64::NAN, 0.0], [0.0, 1.0]], 2).is_none());
    }
}
