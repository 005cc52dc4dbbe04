//! The normal equations of chunks of pixels in single precision, of any number of unknowns.

use nalgebra::{SMatrix, SVector};

use super::unknowns::WIDEST;
use crate::lanes::{WIDE, Wide, add_products, sum};
use crate::marquardt::Normal;

/// The derivatives of a chunk of pixels.
pub(super) type Columns = [Wide; WIDEST];

/// The upper triangle row by row, the right-hand side and the squares of the residuals, in lanes.
pub(super) struct Gram {
    count: usize,
    products: [Wide; WIDEST * (WIDEST + 1) / 2],
    b: Columns,
    omega: Wide,
}

impl Gram {
    /// Of `count` unknowns.
    pub(super) fn new(count: usize) -> Self {
        Self { count, products: [[0.0; WIDE]; WIDEST * (WIDEST + 1) / 2], b: [[0.0; WIDE]; WIDEST], omega: [0.0; WIDE] }
    }

    /// Adds the rows of one chunk: `j` the derivatives, those by unknowns before `first` all zero, `r` the residuals.
    #[inline(always)]
    pub(super) fn add(&mut self, j: &Columns, r: &Wide, first: usize) {
        let n = self.count;
        for row in first..n {
            let start = row * n - row * (row + 1) / 2;
            for column in row..n {
                add_products(&mut self.products[start + column], &j[row], &j[column]);
            }
            add_products(&mut self.b[row], &j[row], r);
        }
        add_products(&mut self.omega, r, r);
    }

    pub(super) fn normal<const P: usize>(&self) -> Normal<P> {
        let at = |i: usize, j: usize| i * P - i * (i + 1) / 2 + j;
        Normal {
            n: SMatrix::from_fn(|i, j| sum(&self.products[at(i.min(j), i.max(j))])),
            b: SVector::from_fn(|i, _| sum(&self.b[i])),
            omega: sum(&self.omega),
        }
    }
}
