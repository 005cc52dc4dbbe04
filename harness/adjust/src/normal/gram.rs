//! Sums of products of columns, over many observations at once.

use multiversion::multiversion;

/// Points side by side in a block of rows; a column of a block holds as many x, then as many y.
pub(crate) const LANES: usize = 8;
/// Numbers of a column in a block.
pub(crate) const BLOCK: usize = 2 * LANES;

/// `G = R^T R` of `columns` (an even number) columns kept in blocks: row by row, lower triangle and the 2 x 2 blocks on the diagonal.
///
/// No fused operations: any machine gives the same bits.
#[multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2"))]
pub(crate) fn gram(rows: &[f64], columns: usize, products: &mut [f64]) {
    let (blocks, _) = rows.as_chunks::<LANES>();
    for i in (0..columns).step_by(2) {
        for j in (0..=i).step_by(2) {
            let mut sums = [[0.0; LANES]; 4];
            for block in blocks.chunks_exact(2 * columns) {
                for half in 0..2 {
                    let (a0, a1) = (&block[2 * i + half], &block[2 * i + 2 + half]);
                    let (b0, b1) = (&block[2 * j + half], &block[2 * j + 2 + half]);
                    for lane in 0..LANES {
                        sums[0][lane] += a0[lane] * b0[lane];
                        sums[1][lane] += a0[lane] * b1[lane];
                        sums[2][lane] += a1[lane] * b0[lane];
                        sums[3][lane] += a1[lane] * b1[lane];
                    }
                }
            }
            let [p, q, r, s] = sums.map(|s| ((s[0] + s[4]) + (s[1] + s[5])) + ((s[2] + s[6]) + (s[3] + s[7])));
            (products[i * columns + j], products[i * columns + j + 1]) = (p, q);
            (products[(i + 1) * columns + j], products[(i + 1) * columns + j + 1]) = (r, s);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_are_those_of_the_columns() {
        let (columns, blocks) = (6, 3);
        let rows: Vec<f64> = (0..columns * blocks * BLOCK).map(|i| (i as f64 * 0.37).sin()).collect();
        let mut products = vec![0.0; columns * columns];
        gram(&rows, columns, &mut products);
        let at = |block: usize, column: usize, k: usize| rows[(block * columns + column) * BLOCK + k];
        for i in 0..columns {
            for j in 0..=i {
                let sum: f64 = (0..blocks * BLOCK).map(|k| at(k / BLOCK, i, k % BLOCK) * at(k / BLOCK, j, k % BLOCK)).sum();
                assert!((products[i * columns + j] - sum).abs() < 1e-13, "{i} {j}");
            }
        }
    }
}
