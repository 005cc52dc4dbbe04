//! The loops of the elimination, for several instruction sets. No fused operations: any machine gives the same bits.

use super::elimination_order::Coupled;
use super::reduced::Reduced;

/// Rows of a member's products that stand one after the other in a column of the reduced matrix.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Run {
    /// Their first column in `Y`.
    pub(crate) from: usize,
    /// The value of the first, in the first column of the block.
    pub(crate) start: usize,
    pub(crate) length: usize,
}

/// The rows at and below the diagonal in the columns of `coupled[i]`, which begin at column `from` of `Y`; returns the distance of columns.
pub(crate) fn runs(coupled: &[Coupled], i: usize, mut from: usize, into: &Reduced, runs: &mut Vec<Run>) -> usize {
    let (column, mut distance) = (&coupled[i], 0);
    runs.clear();
    for row in &coupled[i..] {
        let (start, stride) = into.place((row.block, row.offset), (column.block, column.offset));
        distance = stride;
        match runs.last_mut() {
            Some(last) if last.start + last.length == start => last.length += row.width,
            _ => runs.push(Run { from, start, length: row.width }),
        }
        from += row.width;
    }
    distance
}

macro_rules! subtract {
    ($($name:ident: $depth:expr;)*) => {
        $(#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
        pub(crate) fn $name(y: &[f64], columns: usize, own: (usize, usize), runs: &[Run], stride: usize, values: &mut [f64]) {
            subtract_columns::<$depth>(y, columns, own, runs, stride, values);
        })*
    };
}

subtract! {
    subtract_3: 3;
    subtract_6: 6;
}

#[inline(always)]
fn subtract_columns<const D: usize>(
    y: &[f64],
    columns: usize,
    (first, width): (usize, usize),
    runs: &[Run],
    stride: usize,
    values: &mut [f64],
) {
    for j in 0..width {
        let factor: [f64; D] = std::array::from_fn(|d| y[d * columns + first + j]);
        for run in runs {
            let target = &mut values[run.start + j * stride..][..run.length];
            let rows: [&[f64]; D] = std::array::from_fn(|d| &y[d * columns + run.from..][..run.length]);
            for (i, target) in target.iter_mut().enumerate() {
                let mut sum = rows[0][i] * factor[0];
                for d in 1..D {
                    sum += rows[d][i] * factor[d];
                }
                *target -= sum;
            }
        }
    }
}
