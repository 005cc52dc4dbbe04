//! The smallest eigenvalues of a scaled matrix: what the network hardly determines.

use nalgebra::{DMatrix, SymmetricEigen};

use super::factor::Factor;

/// Up to this size all eigenvalues are found.
pub(super) const FULL: usize = 400;
/// What is added to the diagonal of a larger matrix, relative to it, so that it can be decomposed: below every eigenvalue that counts.
pub(super) const SHIFT: f64 = 1e-12;
/// Eigenvalues of a large matrix that are found, and iterations.
const FEW: usize = 12;
const ITERATIONS: usize = 12;

/// An eigenvalue and its vector.
pub(crate) type Pair = (f64, Vec<f64>);

/// All, of a symmetric matrix kept column by column, scaled.
pub(super) fn all(matrix: &[f64], scale: &[f64]) -> Vec<Pair> {
    let n = scale.len();
    if n == 0 {
        return Vec::new();
    }
    sorted(DMatrix::from_fn(n, n, |i, j| matrix[j * n + i] / (scale[i] * scale[j])))
}

/// A few, by inverse iteration on a subspace.
pub(super) fn few(factor: &Factor, scale: &[f64]) -> Vec<Pair> {
    let n = scale.len();
    let mut basis = DMatrix::from_fn(n, FEW, |i, j| (((i + 1) * (j + 1)) as f64 * 0.618_033_988_749).fract() - 0.5);
    let (mut q, mut inner) = (basis.clone(), DMatrix::identity(FEW, FEW));
    for _ in 0..ITERATIONS {
        q = basis.qr().q();
        // The factor undoes its own scale: S'^-1 y = D S^-1 D y.
        let scaled = |matrix: DMatrix<f64>| DMatrix::from_fn(n, FEW, |i, j| matrix[(i, j)] * scale[i]);
        let mut image = scaled(q.clone());
        factor.solve(image.as_mut_slice());
        basis = scaled(image);
        inner = q.tr_mul(&basis);
    }
    // Ritz values of the inverse, the largest first.
    let ritz = sorted((&inner + inner.transpose()) * -0.5);
    let vector = |small: &[f64]| (&q * nalgebra::DVector::from_row_slice(small)).as_slice().to_vec();
    ritz.into_iter().map(|(value, small)| (-1.0 / value, vector(&small))).collect()
}

fn sorted(matrix: DMatrix<f64>) -> Vec<Pair> {
    let eigen = SymmetricEigen::new(matrix);
    let mut pairs: Vec<_> = eigen
        .eigenvalues
        .iter()
        .zip(eigen.eigenvectors.column_iter())
        .map(|(value, vector)| (*value, vector.iter().copied().collect()))
        .collect();
    pairs.sort_by(|a: &Pair, b| a.0.total_cmp(&b.0));
    pairs
}

#[cfg(test)]
mod tests {
    use super::super::reduced::Reduced;
    use super::*;

    #[test]
    fn a_few_are_those_of_all() {
        let n = 120;
        // Three weak directions in a matrix with ones on its diagonal.
        let mut columns = DMatrix::from_fn(400, n, |i, j| ((i * 7 + j * 13) as f64 * 0.754_877).sin() + 0.3 * ((i * j) as f64).cos());
        for (k, size) in [(3, 1e-4), (40, 3e-5), (90, 1e-5)] {
            let close = columns.column(k + 1) + columns.column(k + 5) + columns.column(k) * size;
            columns.set_column(k, &close);
        }
        let matrix = columns.tr_mul(&columns);
        let scale: Vec<f64> = (0..n).map(|i| matrix[(i, i)].sqrt()).collect();
        let all = all(matrix.as_slice(), &scale);
        let reduced = Reduced { size: n, values: matrix.as_slice().to_vec(), sparse: None };
        let few = few(&Factor::of(reduced, scale.clone(), None).unwrap(), &scale);
        for ((a, x), (b, y)) in all.iter().zip(&few).take(3) {
            let along: f64 = x.iter().zip(y).map(|(x, y)| x * y).sum();
            assert!((a / b - 1.0).abs() < 1e-3 && (along.abs() - 1.0).abs() < 1e-3, "{a:e} {b:e} {along}");
        }
    }
}
