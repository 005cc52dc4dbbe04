//! The normal equations of chunks of pixels in single precision, of any number of unknowns.

use nalgebra::{SMatrix, SVector};

use super::unknowns::WIDEST;
use crate::lanes::{WIDE, Wide, add_products, sum};
use crate::marquardt::Normal;

/// The derivatives of a chunk of pixels.
pub(super) type Columns = [Wide; WIDEST];

/// The upper triangle row by row, the right-hand side and the squares of the residuals, in lanes.
pub(super) struct Gram {
    products: [Wide; WIDEST * (WIDEST + 1) / 2],
    b: Columns,
    omega: Wide,
}

impl Gram {
    pub(super) fn new() -> Self {
        Self { products: [[0.0; WIDE]; WIDEST * (WIDEST + 1) / 2], b: [[0.0; WIDE]; WIDEST], omega: [0.0; WIDE] }
    }

    /// Of nothing yet, for so many unknowns.
    #[inline(always)]
    pub(super) fn clear(&mut self, count: usize) {
        self.products[..count * (count + 1) / 2].fill([0.0; WIDE]);
        self.b[..count].fill([0.0; WIDE]);
        self.omega = [0.0; WIDE];
    }

    /// Adds the rows of one chunk: `j` the derivatives by `count` unknowns, `r` the residuals.
    #[inline(always)]
    pub(super) fn add(&mut self, j: &Columns, r: &Wide, count: usize) {
        if count == 7 {
            return self.add_seven(j, r);
        }
        for row in 0..count {
            let start = row * count - row * (row + 1) / 2;
            for column in row..count {
                add_products(&mut self.products[start + column], &j[row], &j[column]);
            }
            add_products(&mut self.b[row], &j[row], r);
        }
        add_products(&mut self.omega, r, r);
    }

    /// The same of seven unknowns, without any loop.
    #[inline(always)]
    fn add_seven(&mut self, j: &Columns, r: &Wide) {
        self.add_row::<0, 7>(j, r);
        self.add_row::<1, 7>(j, r);
        self.add_row::<2, 7>(j, r);
        self.add_row::<3, 7>(j, r);
        self.add_row::<4, 7>(j, r);
        self.add_row::<5, 7>(j, r);
        self.add_row::<6, 7>(j, r);
        add_products(&mut self.omega, r, r);
    }

    #[inline(always)]
    fn add_row<const ROW: usize, const COUNT: usize>(&mut self, j: &Columns, r: &Wide) {
        for column in ROW..COUNT {
            add_products(&mut self.products[ROW * COUNT - ROW * (ROW + 1) / 2 + column], &j[ROW], &j[column]);
        }
        add_products(&mut self.b[ROW], &j[ROW], r);
    }

    pub(super) fn normal<const P: usize>(&self) -> Normal<P> {
        let mut normal = Normal { n: SMatrix::zeros(), b: SVector::from_fn(|i, _| sum(&self.b[i])), omega: sum(&self.omega) };
        for row in 0..P {
            for column in row..P {
                let product = sum(&self.products[row * P - row * (row + 1) / 2 + column]);
                (normal.n[(row, column)], normal.n[(column, row)]) = (product, product);
            }
        }
        normal
    }
}
