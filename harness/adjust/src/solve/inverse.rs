//! Those blocks of the inverse that covariances need: no full inverse of the network's normal equations is ever made.
//!
//! With `Q_kk = S^-1`, of which only the blocks of the reduced matrix's own pattern are kept, and found, if it is sparse: `Q_ee = L^-T (1 + Z Y^T) L^-1` and
//! `Q_ek = -L^-T Z` with `Z = Y Q_kk`.

use nalgebra::Matrix2;

use super::Solved;
use super::elimination_order::{Coupled, Ordered, Plan};
use super::kernel::{Run, runs};
use super::reduced::Reduced;
use super::schur::Coupling;
use super::small_cholesky::backward;

/// Blocks of `Q_kk`.
#[derive(Clone, Debug)]
pub(crate) struct Inverse(Reduced);

/// Of an eliminated block with `D` unknowns: its cofactors, and those with the columns that it is coupled with, D rows of so many.
#[derive(Clone, Debug)]
pub(crate) struct Member<const D: usize> {
    pub(crate) own: [[f64; D]; D],
    /// What it is coupled with, in the order of the columns.
    pub(crate) coupled: Vec<Coupled>,
    cross: Vec<f64>,
    columns: usize,
}

impl<const D: usize> Member<D> {
    /// Cofactors with the coupled columns from `first` on: row `d`.
    pub(crate) fn cross(&self, d: usize, first: usize, width: usize) -> &[f64] {
        &self.cross[d * self.columns + first..][..width]
    }
}

impl Inverse {
    pub(crate) fn of(solved: &Solved, plan: &Plan, blank: &Reduced) -> Self {
        let mut kept = blank.clone();
        solved.factor.inverse(&mut kept);
        // The blocks on the diagonal are whole.
        for block in 0..plan.kept.len() - 1 {
            let (start, stride) = kept.place((block, plan.kept[block]), (block, plan.kept[block]));
            for j in 0..plan.width(block) {
                (0..j).for_each(|i| kept.values[start + j * stride + i] = kept.values[start + i * stride + j]);
            }
        }
        Self(kept)
    }

    /// A block of `Q_kk`, row by row; it must be one of the pattern.
    pub(crate) fn block(&self, plan: &Plan, row: usize, column: usize) -> Vec<f64> {
        let (low, high) = (row.max(column), row.min(column));
        let (start, stride) = self.0.place((low, plan.kept[low]), (high, plan.kept[high]));
        let (height, width) = (plan.width(row), plan.width(column));
        let at = |i: usize, j: usize| if row >= column { (i, j) } else { (j, i) };
        (0..height * width)
            .map(|k| {
                let (i, j) = at(k / width, k % width);
                self.0.values[start + j * stride + i]
            })
            .collect()
    }

    /// `A Q_kk B^T` of two kept blocks, the first not before the second, and the columns of `A` and `B` that belong to them; they must be of the pattern.
    pub(crate) fn between(&self, plan: &Plan, (row, a): (usize, &[[f64; 2]]), (column, b): (usize, &[[f64; 2]])) -> Matrix2<f64> {
        let (start, stride) = self.0.place((row, plan.kept[row]), (column, plan.kept[column]));
        let mut sum = [[0.0; 2]; 2];
        for (j, b) in b.iter().enumerate() {
            let mut product = [0.0; 2];
            for (q, a) in self.0.values[start + j * stride..][..a.len()].iter().zip(a) {
                (product[0], product[1]) = (product[0] + a[0] * q, product[1] + a[1] * q);
            }
            (0..4).for_each(|k| sum[k / 2][k % 2] += product[k / 2] * b[k % 2]);
        }
        Matrix2::new(sum[0][0], sum[0][1], sum[1][0], sum[1][1])
    }

    /// Blocks of `Q_kk`, row by row each, of a camera with itself and later ones, in the pattern or not.
    pub(crate) fn of_cameras(&self, solved: &Solved, plan: &Plan, column: usize, rows: &[usize]) -> Vec<Vec<f64>> {
        if rows.iter().all(|&row| self.0.has(row, column)) {
            return rows.iter().map(|&row| self.block(plan, row, column)).collect();
        }
        let (n, width) = (plan.size(), plan.width(column));
        let mut identity = vec![0.0; n * width];
        (0..width).for_each(|j| identity[j * n + plan.kept[column] + j] = 1.0);
        solved.factor.solve(&mut identity);
        let entry = |row: usize, k: usize| identity[(k % width) * n + plan.kept[row] + k / width];
        rows.iter().map(|&row| (0..plan.width(row) * width).map(|k| entry(row, k)).collect()).collect()
    }

    /// Cofactors of a member.
    pub(crate) fn member<const D: usize>(&self, solved: &Solved, of: Ordered, place: usize, coupling: &mut Coupling) -> Member<D> {
        let l = solved.schur.factor::<D>(place);
        coupling.make(of, place, &l);
        let (coupled, y, columns) = (&coupling.coupled, &coupling.y, coupling.columns);
        let (mut z, mut found, mut down) = (vec![0.0; D * columns], Vec::new(), 0);
        for (i, column) in coupled.iter().enumerate() {
            let stride = runs(coupled, i, down, &self.0, &mut found);
            let own = Own { first: down, width: column.width };
            if D == 3 {
                multiply_3(y, columns, own, &found, stride, &self.0.values, &mut z);
            } else {
                multiply_6(y, columns, own, &found, stride, &self.0.values, &mut z);
            }
            down += column.width;
        }
        let mut own = [[0.0; D]; D];
        for i in 0..D {
            for j in 0..D {
                let sum: f64 = z[i * columns..(i + 1) * columns].iter().zip(&y[j * columns..]).map(|(z, y)| z * y).sum();
                own[i][j] = sum + if i == j { 1.0 } else { 0.0 };
            }
        }
        let cofactors = both_sides(&l, own);
        // Q_ek = -L^-T Z, from the last row up.
        for d in (0..D).rev() {
            for k in d + 1..D {
                for column in 0..columns {
                    z[d * columns + column] -= l[k][d] * z[k * columns + column];
                }
            }
            z[d * columns..(d + 1) * columns].iter_mut().for_each(|z| *z /= l[d][d]);
        }
        z.iter_mut().for_each(|z| *z = -*z);
        Member { own: cofactors, coupled: coupled.clone(), cross: z, columns }
    }
}

/// `L^-T A L^-1` of a symmetric `A`.
fn both_sides<const D: usize>(l: &[[f64; D]; D], mut a: [[f64; D]; D]) -> [[f64; D]; D] {
    for row in &mut a {
        backward(l, row);
    }
    let mut turned: [[f64; D]; D] = std::array::from_fn(|i| std::array::from_fn(|j| a[j][i]));
    for row in &mut turned {
        backward(l, row);
    }
    std::array::from_fn(|i| std::array::from_fn(|j| 0.5 * (turned[i][j] + turned[j][i])))
}

/// Columns of `Y` that belong to a kept block.
#[derive(Clone, Copy)]
struct Own {
    first: usize,
    width: usize,
}

macro_rules! multiply {
    ($($name:ident: $depth:expr;)*) => {
        $(#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
        fn $name(y: &[f64], columns: usize, own: Own, runs: &[Run], stride: usize, values: &[f64], z: &mut [f64]) {
            multiply::<$depth>(y, columns, own, runs, stride, values, z);
        })*
    };
}

multiply! {
    multiply_3: 3;
    multiply_6: 6;
}

/// Adds what the lower triangle's columns of one block give to `Y Q`: to their own columns, and to those below by symmetry.
#[inline(always)]
fn multiply<const D: usize>(y: &[f64], columns: usize, own: Own, runs: &[Run], stride: usize, values: &[f64], z: &mut [f64]) {
    for j in 0..own.width {
        let factor: [f64; D] = std::array::from_fn(|d| y[d * columns + own.first + j]);
        for (k, run) in runs.iter().enumerate() {
            let q = &values[run.start + j * stride..][..run.length];
            let diagonal = if k == 0 { own.width } else { 0 };
            for d in 0..D {
                let from = &y[d * columns + run.from..][..run.length];
                z[d * columns + own.first + j] += dot(from, q);
                let below = &mut z[d * columns + run.from + diagonal..][..run.length - diagonal];
                below.iter_mut().zip(&q[diagonal..]).for_each(|(z, q)| *z += factor[d] * q);
            }
        }
    }
}

/// In eight sums, whatever the machine.
#[inline(always)]
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let ((a, ra), (b, rb)) = (a.as_chunks::<8>(), b.as_chunks::<8>());
    let mut sums = [0.0; 8];
    for (a, b) in a.iter().zip(b) {
        for lane in 0..8 {
            sums[lane] += a[lane] * b[lane];
        }
    }
    let rest: f64 = ra.iter().zip(rb).map(|(a, b)| a * b).sum();
    ((sums[0] + sums[4]) + (sums[1] + sums[5])) + ((sums[2] + sums[6]) + (sums[3] + sums[7])) + rest
}
