//! Rows and columns that are off as a whole: what a printer's feed and its head do.

use nalgebra::{Point3, Vector3};

use crate::raster::{distinct, nearest};

/// The part of whole rows and columns in the deviations in the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Printer {
    /// Its share of what halves of the photographs have in common, a number about 0 to 1.
    pub share: f64,
    /// The share that whole rows and columns have of deviations which are independent from corner to corner.
    pub by_chance: f64,
}

/// Sums of products of two halves.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sums {
    rows_and_columns: f64,
    all: f64,
    by_chance: f64,
}

impl Sums {
    /// The same with two halves more; `None` where corners in both are no raster of rows and columns along the axes.
    pub(super) fn add(self, nominal: &[Point3<f64>], first: &[Option<Vector3<f64>>], second: &[Option<Vector3<f64>>]) -> Option<Self> {
        let both: Vec<(usize, Vector3<f64>, Vector3<f64>)> =
            first.iter().zip(second).enumerate().filter_map(|(k, (a, b))| Some((k, (*a)?, (*b)?))).collect();
        let at = [0, 1].map(|axis| distinct(both.iter().map(|(k, ..)| nominal[*k][axis]).collect()));
        let (columns, rows) = (at[0].len(), at[1].len());
        if columns < 3 || rows < 3 || columns * rows != both.len() {
            return None;
        }
        let place = |k: usize| [0, 1].map(|axis| nearest(&at[axis], nominal[k][axis]));
        let places: Vec<[usize; 2]> = both.iter().map(|(k, ..)| place(*k)).collect();
        let mut sums = self;
        for axis in 0..2 {
            let (a, b): (Vec<f64>, Vec<f64>) = both.iter().map(|(_, a, b)| (a[axis], b[axis])).unzip();
            let (of_a, of_b) = (additive(&a, &places, [columns, rows]), additive(&b, &places, [columns, rows]));
            sums.all += a.iter().zip(&b).map(|(a, b)| a * b).sum::<f64>();
            sums.rows_and_columns += of_a.iter().zip(&of_b).map(|(a, b)| a * b).sum::<f64>();
        }
        sums.by_chance = (columns + rows - 1) as f64 / both.len() as f64;
        Some(sums)
    }

    pub(super) fn printer(self) -> Option<Printer> {
        (self.all > 0.0).then(|| Printer { share: self.rows_and_columns / self.all, by_chance: self.by_chance })
    }
}

/// The nearest sum of a number for each column and one for each row, by least squares on a whole raster.
fn additive(values: &[f64], places: &[[usize; 2]], [columns, rows]: [usize; 2]) -> Vec<f64> {
    let (mut of_column, mut of_row, mut all) = (vec![0.0; columns], vec![0.0; rows], 0.0);
    for (value, [column, row]) in values.iter().zip(places) {
        of_column[*column] += value / rows as f64;
        of_row[*row] += value / columns as f64;
        all += value / (rows * columns) as f64;
    }
    places.iter().map(|[column, row]| of_column[*column] + of_row[*row] - all).collect()
}
