//! Cholesky's decomposition of a sparse matrix, by groups of columns that have one pattern.

use std::sync::Arc;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::supernodal::SupernodalLltRef;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side, Spec};

use super::reduced::Reduced;
use super::selected::Selected;

/// The structure of a sparse matrix, found once.
#[derive(Clone, Debug)]
pub(crate) struct Structure {
    pointers: Vec<usize>,
    indices: Vec<usize>,
    symbolic: Arc<SymbolicCholesky<usize>>,
}

/// A decomposition.
#[derive(Clone, Debug)]
pub(super) struct SparseFactor {
    symbolic: Arc<SymbolicCholesky<usize>>,
    values: Vec<f64>,
}

impl Structure {
    /// `None` for a dense matrix, or if memory does not suffice.
    pub(crate) fn of(reduced: &Reduced) -> Option<Self> {
        let (pointers, indices) = reduced.sparse.as_ref()?.columns();
        let matrix = SymbolicSparseColMatRef::new_checked(reduced.size, reduced.size, &pointers, None, &indices);
        // Groups even where a library's loop by single columns would do: the blocks are groups.
        let params = CholeskySymbolicParams { supernodal_flop_ratio_threshold: SupernodalThreshold(-1.0), ..Default::default() };
        let symbolic = factorize_symbolic_cholesky(matrix, Side::Lower, SymmetricOrdering::Amd, params).ok()?;
        Some(Self { symbolic: Arc::new(symbolic), pointers, indices })
    }

    /// Rows of the values of a column.
    pub(super) fn rows(&self, column: usize) -> impl Iterator<Item = (usize, usize)> + '_ {
        (self.pointers[column]..self.pointers[column + 1]).map(|k| (k, self.indices[k]))
    }
}

impl SparseFactor {
    /// `None` if the matrix is not positive definite.
    pub(super) fn of(reduced: &Reduced, structure: &Structure) -> Option<Self> {
        let (n, symbolic) = (reduced.size, Arc::clone(&structure.symbolic));
        let pattern = SymbolicSparseColMatRef::new_checked(n, n, &structure.pointers, None, &structure.indices);
        let matrix = SparseColMatRef::new(pattern, &reduced.values);
        let mut values = vec![0.0; symbolic.len_val()];
        let mut memory = MemBuffer::new(symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Spec::default()));
        let stack = MemStack::new(&mut memory);
        symbolic
            .factorize_numeric_llt(&mut values, matrix, Side::Lower, LltRegularization::default(), Par::Seq, stack, Spec::default())
            .ok()?;
        Some(Self { symbolic, values })
    }

    pub(super) fn solve(&self, x: MatMut<'_, f64>) {
        let mut memory = MemBuffer::new(self.symbolic.solve_in_place_scratch::<f64>(x.ncols(), Par::Seq));
        LltRef::new(&self.symbolic, &self.values).solve_in_place_with_conj(Conj::No, x, Par::Seq, MemStack::new(&mut memory));
    }

    /// Those entries of the inverse that lie within the pattern of the factor.
    pub(super) fn selected(&self) -> Selected<'_> {
        match self.symbolic.raw() {
            SymbolicCholeskyRaw::Supernodal(groups) => {
                let places = self.symbolic.perm().map(|order| order.arrays().1);
                Selected::of(SupernodalLltRef::new(groups, &self.values), places)
            }
            SymbolicCholeskyRaw::Simplicial(_) => unreachable!("the structure is one of groups"),
        }
    }
}
