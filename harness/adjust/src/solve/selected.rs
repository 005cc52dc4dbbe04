//! Entries of the inverse of a sparse matrix within the pattern of its factor, from the last group of columns to the first: as many operations as twice the
//! decomposition takes.
//!
//! Of a group's columns J with the rows R below it, `Y = L_RJ L_JJ^-1`: `Z_RJ = -Z_RR Y` and `Z_JJ = (L_JJ L_JJ^T)^-1 - Y^T Z_RJ`. All of `Z_RR` belongs to
//! later groups and lies within their pattern.
//!
//! Source: Takahashi, Fagan & Chin 1973; Erisman & Tinney 1975.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::inverse::{inverse, inverse_scratch};
use faer::linalg::matmul::triangular::{BlockStructure, matmul};
use faer::linalg::triangular_solve::solve_upper_triangular_in_place;
use faer::prelude::ReborrowMut;
use faer::sparse::linalg::cholesky::supernodal::{SupernodalLltRef, SymbolicSupernodalCholesky};
use faer::{Accum, MatMut, MatRef, Par};

/// The entries, in the order of the factor's.
pub(super) struct Selected<'s> {
    groups: &'s SymbolicSupernodalCholesky<usize>,
    /// Places in the factor of the unknowns.
    places: Option<&'s [usize]>,
    /// The group of each of the factor's columns.
    group_of: Vec<usize>,
    values: Vec<f64>,
}

/// What one group needs.
#[derive(Default)]
struct Work {
    /// `Z_RR`, the lower triangle, column by column.
    known: Vec<f64>,
    /// `Y`, column by column.
    y: Vec<f64>,
    /// Where rows stand in a later group.
    at: Vec<usize>,
}

impl<'s> Selected<'s> {
    pub(super) fn of(factor: SupernodalLltRef<'s, usize, f64>, places: Option<&'s [usize]>) -> Self {
        let groups = factor.symbolic();
        let mut group_of = vec![0; groups.nrows()];
        for (group, (&first, &end)) in groups.supernode_begin().iter().zip(groups.supernode_end()).enumerate() {
            group_of[first..end].fill(group);
        }
        let mut found = Self { groups, places, group_of, values: vec![0.0; groups.len_val()] };
        let mut work = Work::default();
        (0..groups.n_supernodes()).rev().for_each(|group| found.invert(factor, group, &mut work));
        found
    }

    /// The entries of a group, all later ones being known.
    fn invert(&mut self, factor: SupernodalLltRef<'s, usize, f64>, group: usize, work: &mut Work) {
        let (l, rows) = (factor.supernode(group).val(), factor.supernode(group).pattern());
        let (count, below) = (l.ncols(), rows.len());
        let values = self.groups.col_ptr_for_val();
        self.gather(rows, work);
        let own = MatMut::from_column_major_slice_mut(&mut self.values[values[group]..values[group + 1]], count + below, count);
        let (mut diagonal, mut cross) = own.split_at_row_mut(count);
        let (l, l_below) = l.split_at_row(count);
        let mut memory = MemBuffer::new(inverse_scratch::<f64>(count, Par::Seq));
        inverse(diagonal.rb_mut(), l, Par::Seq, MemStack::new(&mut memory));
        if below == 0 {
            return;
        }
        work.y.resize(below * count, 0.0);
        let mut y = MatMut::from_column_major_slice_mut(&mut work.y[..below * count], below, count);
        y.copy_from(l_below);
        solve_upper_triangular_in_place(l.transpose(), y.rb_mut().transpose_mut(), Par::Seq);
        let (y, known) = (y.as_ref(), MatRef::from_column_major_slice(&work.known[..below * below], below, below));
        let whole = BlockStructure::Rectangular;
        let (lower, upper) = (BlockStructure::TriangularLower, BlockStructure::StrictTriangularUpper);
        matmul(cross.rb_mut(), whole, Accum::Replace, known, lower, y, whole, -1.0, Par::Seq);
        matmul(cross.rb_mut(), whole, Accum::Add, known.transpose(), upper, y, whole, -1.0, Par::Seq);
        matmul(diagonal, lower, Accum::Add, y.transpose(), whole, cross.as_ref(), whole, -1.0, Par::Seq);
    }

    /// Copies the lower triangle of rows and columns of later groups.
    fn gather(&self, rows: &[usize], Work { known, at, .. }: &mut Work) {
        let n = rows.len();
        known.resize(known.len().max(n * n), 0.0);
        let mut i = 0;
        while i < n {
            let (first, end, later, column) = self.group(self.group_of[rows[i]]);
            let own = rows[i..].partition_point(|row| *row < end);
            at.clear();
            at.extend(rows[i..i + own].iter().map(|row| row - first));
            let mut next = 0;
            for row in &rows[i + own..] {
                next += later[next..].iter().take_while(|later| *later < row).count();
                at.push(end - first + next);
            }
            for j in 0..own {
                let from = &self.values[column + at[j] * (end - first + later.len())..];
                let into = &mut known[(i + j) * (n + 1)..(i + j + 1) * n];
                into.iter_mut().zip(&at[j..]).for_each(|(into, at)| *into = from[*at]);
            }
            i += own;
        }
    }

    /// Of a group: its first column, that after it, the rows below, and where its values begin.
    fn group(&self, group: usize) -> (usize, usize, &[usize], usize) {
        let (first, end) = (self.groups.supernode_begin()[group], self.groups.supernode_end()[group]);
        (first, end, self.groups.supernode(group).pattern(), self.groups.col_ptr_for_val()[group])
    }

    /// The entry of two unknowns; they must be coupled.
    pub(super) fn entry(&self, row: usize, column: usize) -> f64 {
        let place = |unknown: usize| self.places.map_or(unknown, |places| places[unknown]);
        let (low, high) = (place(row).max(place(column)), place(row).min(place(column)));
        let (first, end, later, values) = self.group(self.group_of[high]);
        let down = if low < end { low - first } else { end - first + later.partition_point(|later| *later < low) };
        self.values[values + (high - first) * (end - first + later.len()) + down]
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use nalgebra::DMatrix;
    use rand::{RngExt, SeedableRng};

    use super::super::factor::Factor;
    use super::super::reduced::Reduced;
    use super::super::sparse_factor::Structure;

    /// A positive definite matrix whose blocks of rows `coupled` names, and what it is of the form that the elimination leaves.
    fn matrix(kept: &[usize], coupled: &BTreeSet<(usize, usize)>, random: &mut rand_chacha::ChaCha8Rng) -> (DMatrix<f64>, Reduced) {
        let size = kept[kept.len() - 1];
        let mut reduced = Reduced::new(kept, || {
            let rows = |column| coupled.iter().filter(|block| block.1 == column).map(|block| block.0).collect();
            (0..kept.len() - 1).map(rows).collect()
        });
        assert!(reduced.sparse.is_some());
        let mut full = DMatrix::zeros(size, size);
        for &(row, column) in coupled {
            for j in kept[column]..kept[column + 1] {
                for i in kept[row].max(j + 1)..kept[row + 1] {
                    let value = random.random::<f64>() - 0.5;
                    (full[(i, j)], full[(j, i)]) = (value, value);
                }
            }
        }
        for i in 0..size {
            full[(i, i)] = 1.01 * full.row(i).iter().map(|value: &f64| value.abs()).sum::<f64>() + 0.01;
        }
        reduced.fill(|i, j| full[(i, j)]);
        (full, reduced)
    }

    /// A band, blocks coupled at random and a border of blocks that are coupled with all: of one row to seven.
    #[test]
    fn entries_are_those_of_the_whole_inverse() {
        for seed in 0..6 {
            let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
            let blocks = 180;
            let mut kept = vec![0];
            (0..blocks).for_each(|i| kept.push(kept[i] + if seed % 2 == 0 { 6 } else { random.random_range(1..8) }));
            let mut coupled: BTreeSet<_> = (0..blocks).map(|i| (i, i)).collect();
            for i in 0..blocks {
                coupled.extend((1..5).filter(|_| seed != 5).filter_map(|by| Some((i, i.checked_sub(by)?))));
                if seed > 1 && i % 7 == 0 {
                    let other = random.random_range(0..blocks);
                    coupled.insert((i.max(other), i.min(other)));
                }
                if seed == 3 {
                    coupled.extend([(i, 0), (i.max(90), i.min(90))]);
                }
            }
            let (full, reduced) = matrix(&kept, &coupled, &mut random);
            let scale: Vec<f64> = full.diagonal().iter().map(|value| value.sqrt()).collect();
            let mut found = reduced.clone();
            let structure = Structure::of(&reduced);
            Factor::of(reduced, scale, structure.as_ref()).unwrap().inverse(&mut found);
            let inverse = full.cholesky().unwrap().inverse();
            for &(row, column) in &coupled {
                let (start, stride) = found.place((row, kept[row]), (column, kept[column]));
                for (j, at) in (kept[column]..kept[column + 1]).enumerate() {
                    for (i, down) in (kept[row]..kept[row + 1]).enumerate() {
                        let (value, expected) = (found.values[start + j * stride + i], inverse[(down, at)]);
                        let bound = 1e-12 * (inverse[(down, down)] * inverse[(at, at)]).sqrt();
                        assert!((value - expected).abs() < bound, "{seed}: {down} {at}: {value:e} {expected:e}");
                    }
                }
            }
        }
    }
}
