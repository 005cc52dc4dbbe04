//! The normal equations of chunks of pixels in single precision.

use nalgebra::{SMatrix, SVector};

use crate::lanes::{WIDE, Wide, add_products, sum};
use crate::marquardt::Normal;

/// The upper triangle, the right-hand side and the squares of the residuals, in lanes.
pub(super) struct Sums<const P: usize> {
    n: [[Wide; P]; P],
    b: [Wide; P],
    omega: Wide,
}

impl<const P: usize> Sums<P> {
    pub(super) fn new() -> Self {
        Self { n: [[[0.0; WIDE]; P]; P], b: [[0.0; WIDE]; P], omega: [0.0; WIDE] }
    }

    /// Adds the rows of one chunk: `j` the derivatives, of which those by unknown `NONE`, if there is such a one, are all zero; `r` the residuals.
    #[inline(always)]
    pub(super) fn add<const NONE: usize>(&mut self, j: &[Wide; P], r: &Wide) {
        const { assert!(P <= 13, "unknowns that are summed") };
        // Each sum for itself: a loop over columns the compiler would work out side by side, by gathers and scatters, which takes twice as long.
        macro_rules! column {
            ($row:literal, $($column:literal)*) => {
                $(if $row <= $column && $column < P && $column != NONE {
                    add_products(&mut self.n[$row][$column], &j[$row], &j[$column]);
                })*
            };
        }
        macro_rules! row {
            ($($row:literal)*) => {
                $(if $row < P && $row != NONE {
                    column!($row, 0 1 2 3 4 5 6 7 8 9 10 11 12);
                    add_products(&mut self.b[$row], &j[$row], r);
                })*
            };
        }
        row!(0 1 2 3 4 5 6 7 8 9 10 11 12);
        add_products(&mut self.omega, r, r);
    }

    /// As [`Self::add`], for rows whose derivatives are all zero but those by the unknowns `i` < `j`.
    #[inline(always)]
    pub(super) fn add_pair(&mut self, [i, j]: [usize; 2], by_i: &Wide, by_j: &Wide, r: &Wide) {
        add_products(&mut self.n[i][i], by_i, by_i);
        add_products(&mut self.n[i][j], by_i, by_j);
        add_products(&mut self.n[j][j], by_j, by_j);
        add_products(&mut self.b[i], by_i, r);
        add_products(&mut self.b[j], by_j, r);
        add_products(&mut self.omega, r, r);
    }

    /// Of all lanes together.
    #[inline(always)]
    pub(super) fn normal(&self) -> Normal<P> {
        let mut normal = Normal { n: SMatrix::zeros(), b: SVector::zeros(), omega: sum(&self.omega) };
        for i in 0..P {
            for j in i..P {
                let product = sum(&self.n[i][j]);
                (normal.n[(i, j)], normal.n[(j, i)]) = (product, product);
            }
            normal.b[i] = sum(&self.b[i]);
        }
        normal
    }
}
