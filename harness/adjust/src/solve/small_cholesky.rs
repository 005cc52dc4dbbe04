//! Cholesky's decomposition of small matrices, and how far a pivot may fall.

/// A pivot relative to the diagonal it started from, below which it is rounding.
pub(crate) const LOST: f64 = 1e-13;

/// `L` with `L L^T = N`, row by row; `None` if a pivot is lost.
pub(crate) fn cholesky<const D: usize>(normal: &[[f64; D]; D]) -> Option<[[f64; D]; D]> {
    let mut l = [[0.0; D]; D];
    for i in 0..D {
        for j in 0..=i {
            let known: f64 = l[i][..j].iter().zip(&l[j]).map(|(a, b)| a * b).sum();
            let sum = normal[i][j] - known;
            if i > j {
                l[i][j] = sum / l[j][j];
            } else if sum > LOST * normal[i][i] {
                l[i][i] = sum.sqrt();
            } else {
                return None;
            }
        }
    }
    Some(l)
}

/// `L^-1 x` in place.
pub(crate) fn forward<const D: usize>(l: &[[f64; D]; D], x: &mut [f64; D]) {
    for i in 0..D {
        for k in 0..i {
            x[i] -= l[i][k] * x[k];
        }
        x[i] /= l[i][i];
    }
}

/// `L^-T x` in place.
pub(crate) fn backward<const D: usize>(l: &[[f64; D]; D], x: &mut [f64; D]) {
    for i in (0..D).rev() {
        for k in i + 1..D {
            x[i] -= l[k][i] * x[k];
        }
        x[i] /= l[i][i];
    }
}
