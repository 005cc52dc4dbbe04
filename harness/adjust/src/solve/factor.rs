//! Cholesky's decomposition of the reduced matrix, its unknowns scaled to ones on the diagonal of the normal equations.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::inverse::{inverse, inverse_scratch};
use faer::linalg::solvers::{Llt, SolveCore};
use faer::{Conj, Mat, MatMut, MatRef, Par, Side};

use super::reduced::Reduced;
use super::small_cholesky::LOST;
use super::sparse_factor::{SparseFactor, Structure};

/// Up to this size a plain loop is faster than a library's set-up.
const SMALL: usize = 48;

/// A decomposition.
#[derive(Clone, Debug)]
pub(crate) struct Factor {
    scale: Vec<f64>,
    kind: Kind,
    /// The smallest pivot: one means that the other unknowns do not matter, zero that they take all.
    pub(crate) smallest_pivot: f64,
}

#[derive(Clone, Debug)]
enum Kind {
    Small(Vec<f64>),
    Dense(Llt<f64>),
    Sparse(SparseFactor),
}

impl Factor {
    /// Decomposes; `scale` holds the roots of the normal equations' own diagonal. `None` if a pivot is lost.
    pub(crate) fn of(mut reduced: Reduced, scale: Vec<f64>, structure: Option<&Structure>) -> Option<Self> {
        let n = reduced.size;
        if let (Some(_), Some(structure)) = (&reduced.sparse, structure) {
            for column in 0..n {
                for (k, row) in structure.rows(column) {
                    reduced.values[k] /= scale[row] * scale[column];
                }
            }
            return Self::sparse(&reduced, scale, structure);
        }
        for column in 0..n {
            for row in column..n {
                reduced.values[column * n + row] /= scale[row] * scale[column];
            }
        }
        if n <= SMALL {
            let smallest_pivot = small(&mut reduced.values, n)?;
            return Some(Self { scale, kind: Kind::Small(reduced.values), smallest_pivot });
        }
        let llt = Llt::new(MatRef::from_column_major_slice(&reduced.values, n, n), Side::Lower).ok()?;
        let smallest_pivot = (0..n).map(|i| llt.L()[(i, i)].powi(2)).fold(f64::INFINITY, f64::min);
        (smallest_pivot > LOST).then_some(Self { scale, kind: Kind::Dense(llt), smallest_pivot })
    }

    fn sparse(reduced: &Reduced, scale: Vec<f64>, structure: &Structure) -> Option<Self> {
        let kind = Kind::Sparse(SparseFactor::of(reduced, structure)?);
        let mut factor = Self { scale, kind, smallest_pivot: 0.0 };
        factor.smallest_pivot = factor.weakest();
        (factor.smallest_pivot > LOST).then_some(factor)
    }

    /// The largest eigenvalue of the inverse, inverted, by a few iterations of von Mises: a pivot's stand-in where the library hides them.
    fn weakest(&self) -> f64 {
        let n = self.scale.len();
        let mut x = Mat::from_fn(n, 1, |i, _| 1.0 + (i as f64 * 0.618_033_988_749).fract());
        let mut growth = 1.0;
        for _ in 0..6 {
            let length = x.norm_l2();
            x = Mat::from_fn(n, 1, |i, _| x[(i, 0)] / length);
            self.solve_scaled(x.as_mut());
            growth = x.norm_l2();
        }
        1.0 / growth
    }

    /// Unknowns.
    pub(crate) fn size(&self) -> usize {
        self.scale.len()
    }

    /// `S^-1 x`, in place.
    pub(crate) fn solve(&self, x: &mut [f64]) {
        let n = self.size();
        let columns = x.len().checked_div(n).unwrap_or(0);
        for column in x.chunks_exact_mut(n.max(1)) {
            column.iter_mut().zip(&self.scale).for_each(|(x, scale)| *x /= scale);
        }
        if n > 0 {
            self.solve_scaled(MatMut::from_column_major_slice_mut(x, n, columns));
        }
        for column in x.chunks_exact_mut(n.max(1)) {
            column.iter_mut().zip(&self.scale).for_each(|(x, scale)| *x /= scale);
        }
    }

    fn solve_scaled(&self, mut x: MatMut<'_, f64>) {
        match &self.kind {
            Kind::Small(l) => {
                for column in 0..x.ncols() {
                    solve_small(l, self.size(), &mut x.as_mut().col_mut(column));
                }
            }
            Kind::Dense(llt) => llt.solve_in_place_with_conj(Conj::No, x),
            Kind::Sparse(factor) => factor.solve(x),
        }
    }

    /// The lower triangle of `S^-1`, of a sparse matrix within the pattern that `into` has.
    pub(crate) fn inverse(&self, into: &mut Reduced) {
        let n = self.size();
        if let Kind::Sparse(factor) = &self.kind {
            let selected = factor.selected();
            into.fill(|row, column| selected.entry(row, column) / (self.scale[row] * self.scale[column]));
            return;
        }
        into.values.fill(0.0);
        match &self.kind {
            Kind::Dense(llt) => {
                let mut memory = MemBuffer::new(inverse_scratch::<f64>(n, Par::Seq));
                let values = MatMut::from_column_major_slice_mut(&mut into.values, n, n);
                inverse(values, llt.L(), Par::Seq, MemStack::new(&mut memory));
            }
            _ => {
                (0..n).for_each(|i| into.values[i * (n + 1)] = 1.0);
                if n > 0 {
                    self.solve_scaled(MatMut::from_column_major_slice_mut(&mut into.values, n, n));
                }
            }
        }
        for (column, values) in into.values.chunks_exact_mut(n.max(1)).enumerate() {
            values.iter_mut().zip(&self.scale).skip(column).for_each(|(value, scale)| *value /= scale * self.scale[column]);
        }
    }
}

/// In place, column by column; the smallest pivot, or `None` if one is lost.
fn small(l: &mut [f64], n: usize) -> Option<f64> {
    let mut smallest = f64::INFINITY;
    for j in 0..n {
        let (done, rest) = l.split_at_mut(j * n);
        let column = &mut rest[..n];
        for k in 0..j {
            let factor = done[k * n + j];
            column[j..].iter_mut().zip(&done[k * n + j..(k + 1) * n]).for_each(|(c, d)| *c -= factor * d);
        }
        let pivot = column[j];
        smallest = smallest.min(pivot);
        if pivot.is_nan() || pivot <= LOST {
            return None;
        }
        let root = pivot.sqrt();
        column[j..].iter_mut().for_each(|c| *c /= root);
    }
    Some(smallest)
}

fn solve_small(l: &[f64], n: usize, x: &mut faer::ColMut<'_, f64>) {
    for i in 0..n {
        x[i] /= l[i * n + i];
        let known = x[i];
        (i + 1..n).for_each(|k| x[k] -= l[i * n + k] * known);
    }
    for i in (0..n).rev() {
        let sum: f64 = (i + 1..n).map(|k| l[i * n + k] * x[k]).sum();
        x[i] = (x[i] - sum) / l[i * n + i];
    }
}
