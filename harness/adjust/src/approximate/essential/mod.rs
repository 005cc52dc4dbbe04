//! The five-point problem: essential matrices from five pairs of rays.

use nalgebra::{Matrix3, SMatrix, Vector3};

use super::roots::real_roots;

/// Exponents of x, y and z of the monomials, in Nistér's order: the first ten are eliminated.
const MONOMIALS: [[usize; 3]; 20] = [
    [3, 0, 0],
    [0, 3, 0],
    [2, 1, 0],
    [1, 2, 0],
    [2, 0, 1],
    [2, 0, 0],
    [0, 2, 1],
    [0, 2, 0],
    [1, 1, 1],
    [1, 1, 0],
    [1, 0, 2],
    [1, 0, 1],
    [1, 0, 0],
    [0, 1, 2],
    [0, 1, 1],
    [0, 1, 0],
    [0, 0, 3],
    [0, 0, 2],
    [0, 0, 1],
    [0, 0, 0],
];

/// The place of each monomial times x, y, z and 1; 20 above the third degree.
const TIMES: [[usize; 4]; 20] = times();

const fn times() -> [[usize; 4]; 20] {
    let mut table = [[20; 4]; 20];
    let mut i = 0;
    while i < 20 {
        let mut by = 0;
        while by < 4 {
            let mut wanted = MONOMIALS[i];
            if by < 3 {
                wanted[by] += 1;
            }
            let mut j = 0;
            while j < 20 {
                let m = MONOMIALS[j];
                if m[0] == wanted[0] && m[1] == wanted[1] && m[2] == wanted[2] {
                    table[i][by] = j;
                }
                j += 1;
            }
            by += 1;
        }
        i += 1;
    }
    table
}

type Polynomial = [f64; 20];
/// Coefficients of x, y, z and 1.
type Linear = [f64; 4];

/// `sum += sign p l`; `p` is of the second degree at most.
fn add_product(sum: &mut Polynomial, sign: f64, p: &Polynomial, l: &Linear) {
    for (places, value) in TIMES.iter().zip(p) {
        if *value != 0.0 {
            places.iter().zip(l).filter(|(place, _)| **place < 20).for_each(|(&place, factor)| sum[place] += sign * value * factor);
        }
    }
}

fn raised(l: &Linear) -> Polynomial {
    let mut p = [0.0; 20];
    (p[12], p[15], p[18], p[19]) = (l[0], l[1], l[2], l[3]);
    p
}

/// The essential matrices `E` with `second' E first = 0` for five pairs of rays: up to ten. None for rays that leave more than four dimensions.
/// Nearly double solutions may be missed: the true one in about 1 of 4000 random samples, which a search over samples does not mind.
///
/// Source: Nistér 2004, An efficient solution to the five-point relative pose problem.
pub(super) fn essential_matrices(first: &[Vector3<f64>; 5], second: &[Vector3<f64>; 5]) -> Vec<Matrix3<f64>> {
    let Some(basis) = null_space(first, second) else { return Vec::new() };
    let Some(rest) = eliminated(&constraints(&basis)) else { return Vec::new() };
    // x and y times polynomials in z, and one more, vanish together: three rows of x, y, 1.
    let rows: [[Vec<f64>; 3]; 3] = [4, 6, 8].map(|row| {
        let part = |start: usize, length: usize| {
            let mut p = vec![0.0; length + 1];
            for k in 0..length {
                p[length - 1 - k] += rest[(row, start + k)];
                p[length - k] -= rest[(row + 1, start + k)];
            }
            p
        };
        [part(0, 3), part(3, 3), part(6, 4)]
    });
    let of_root = |z: f64| {
        let at = Matrix3::from_fn(|i, j| rows[i][j].iter().rev().fold(0.0, |sum, c| sum * z + c));
        let lines = [0, 1, 2].map(|i| at.row(i).transpose().normalize());
        let cross = [lines[0].cross(&lines[1]), lines[0].cross(&lines[2]), lines[1].cross(&lines[2])];
        let best = cross.into_iter().max_by(|a, b| a.norm().total_cmp(&b.norm()))?;
        let [x, y] = [best.x / best.z, best.y / best.z];
        let matrix = basis[0] * x + basis[1] * y + basis[2] * z + basis[3];
        let norm = matrix.norm();
        (norm.is_finite() && norm > 0.0).then(|| matrix / norm)
    };
    real_roots(&determinant(&rows)).into_iter().filter_map(of_root).collect()
}

/// Four matrices that span what five coplanarity conditions leave.
fn null_space(first: &[Vector3<f64>; 5], second: &[Vector3<f64>; 5]) -> Option<[Matrix3<f64>; 4]> {
    let mut padded = SMatrix::<f64, 9, 9>::zeros();
    for (column, (a, b)) in first.iter().zip(second).enumerate() {
        let products = b.normalize() * a.normalize().transpose();
        padded.column_mut(column).copy_from_slice(products.as_slice());
    }
    let qr = padded.qr();
    let r = qr.r();
    if (0..5).any(|i| r[(i, i)].is_nan() || r[(i, i)].abs() < 1e-12) {
        return None;
    }
    let q = qr.q();
    Some([5, 6, 7, 8].map(|column| Matrix3::from_column_slice(q.column(column).as_slice())))
}

/// The coefficients of `2 E E' E - tr(E E') E = 0` and `det E = 0`.
fn constraints(basis: &[Matrix3<f64>; 4]) -> SMatrix<f64, 10, 20> {
    let e: [[Linear; 3]; 3] = std::array::from_fn(|i| std::array::from_fn(|j| std::array::from_fn(|k| basis[k][(i, j)])));
    let mut square = [[[0.0; 20]; 3]; 3];
    for i in 0..3 {
        for j in 0..=i {
            (0..3).for_each(|k| add_product(&mut square[i][j], 1.0, &raised(&e[i][k]), &e[j][k]));
            square[j][i] = square[i][j];
        }
    }
    let half: Polynomial = std::array::from_fn(|m| 0.5 * (square[0][0][m] + square[1][1][m] + square[2][2][m]));
    (0..3).for_each(|i| (0..20).for_each(|m| square[i][i][m] -= half[m]));
    let mut rows = SMatrix::zeros();
    let mut put = |row: usize, p: &Polynomial| (0..20).for_each(|m| rows[(row, m)] = p[m]);
    for (row, (i, j)) in (0..9).map(|row| (row, (row / 3, row % 3))) {
        let mut sum = [0.0; 20];
        (0..3).for_each(|k| add_product(&mut sum, 1.0, &square[i][k], &e[k][j]));
        put(row, &sum);
    }
    let mut sum = [0.0; 20];
    for (a, b, c) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
        let mut minor = [0.0; 20];
        add_product(&mut minor, 1.0, &raised(&e[1][b]), &e[2][c]);
        add_product(&mut minor, -1.0, &raised(&e[1][c]), &e[2][b]);
        add_product(&mut sum, 1.0, &minor, &e[0][a]);
    }
    put(9, &sum);
    rows
}

/// The first ten monomials in the others: row i says `m_i + sum r_ij m_(10 + j) = 0`.
fn eliminated(rows: &SMatrix<f64, 10, 20>) -> Option<SMatrix<f64, 10, 10>> {
    let left = rows.fixed_columns::<10>(0).into_owned();
    let rest = left.full_piv_lu().solve(&rows.fixed_columns::<10>(10).into_owned())?;
    rest.iter().all(|value| value.is_finite()).then_some(rest)
}

fn determinant(rows: &[[Vec<f64>; 3]; 3]) -> Vec<f64> {
    let mut sum = vec![0.0; 11];
    for (a, b, c, sign) in [(0, 1, 2, 1.0), (1, 2, 0, 1.0), (2, 0, 1, 1.0), (0, 2, 1, -1.0), (1, 0, 2, -1.0), (2, 1, 0, -1.0)] {
        let product = times_polynomial(&times_polynomial(&rows[0][a], &rows[1][b]), &rows[2][c]);
        sum.iter_mut().zip(&product).for_each(|(sum, term)| *sum += sign * term);
    }
    sum
}

fn times_polynomial(p: &[f64], q: &[f64]) -> Vec<f64> {
    let mut product = vec![0.0; p.len() + q.len() - 1];
    for (i, a) in p.iter().enumerate() {
        q.iter().enumerate().for_each(|(j, b)| product[i + j] += a * b);
    }
    product
}

/// The rotation `R` and the direction `t` of the four motions `X2 = R X1 + t` of an essential matrix that has most points before both cameras.
///
/// Source: Hartley & Zisserman 2004, section 9.6.2.
pub(super) fn motion<'a>(
    essential: &Matrix3<f64>,
    pairs: &(impl Iterator<Item = (&'a Vector3<f64>, &'a Vector3<f64>)> + Clone),
) -> Option<(Matrix3<f64>, Vector3<f64>)> {
    let svd = essential.svd(true, true);
    let (u, v) = (svd.u?, svd.v_t?);
    let w = Matrix3::new(0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0);
    let proper = |m: Matrix3<f64>| m * m.determinant().signum();
    let (first, second, t) = (proper(u * w * v), proper(u * w.transpose() * v), u.column(2).into_owned());
    let motions = [(first, t), (first, -t), (second, t), (second, -t)];
    let before = |(rotation, t): &(Matrix3<f64>, Vector3<f64>)| {
        pairs.clone().filter(|(a, b)| distances(&(rotation * *a), b, t).is_some_and(|[s, r]| s > 0.0 && r > 0.0)).count()
    };
    let best = motions.into_iter().max_by_key(before)?;
    (before(&best) > 0).then_some(best)
}

/// `s` and `r` with `r b = s a + t` as nearly as can be; `None` for parallel rays.
pub(super) fn distances(a: &Vector3<f64>, b: &Vector3<f64>, t: &Vector3<f64>) -> Option<[f64; 2]> {
    let across = a.cross(b);
    let square = across.norm_squared();
    let [s, r] = [-t.cross(b).dot(&across) / square, -t.cross(a).dot(&across) / square];
    (s.is_finite() && r.is_finite()).then_some([s, r])
}

#[cfg(test)]
mod tests;
