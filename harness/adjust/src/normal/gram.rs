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
    let (pairs, _) = rows.as_chunks::<{ 2 * BLOCK }>();
    let across = columns / 2;
    for i in 0..across {
        for j in 0..=i {
            let mut sums = [[0.0; LANES]; 4];
            for block in pairs.chunks_exact(across) {
                let ((a, _), (b, _)) = (block[i].as_chunks::<LANES>(), block[j].as_chunks::<LANES>());
                let ([a0x, a0y, a1x, a1y], [b0x, b0y, b1x, b1y]) = (a, b) else { continue };
                add(&mut sums[0], a0x, b0x);
                add(&mut sums[1], a0x, b1x);
                add(&mut sums[2], a1x, b0x);
                add(&mut sums[3], a1x, b1x);
                add(&mut sums[0], a0y, b0y);
                add(&mut sums[1], a0y, b1y);
                add(&mut sums[2], a1y, b0y);
                add(&mut sums[3], a1y, b1y);
            }
            let [p, q, r, s] = across_lanes(&sums);
            (products[2 * i * columns + 2 * j], products[2 * i * columns + 2 * j + 1]) = (p, q);
            (products[(2 * i + 1) * columns + 2 * j], products[(2 * i + 1) * columns + 2 * j + 1]) = (r, s);
        }
    }
}

/// Apart, so that the loops above keep their lanes in order: compiled together, sums were shuffled at every step.
#[inline(never)]
fn across_lanes(sums: &[[f64; LANES]; 4]) -> [f64; 4] {
    sums.map(|s| ((s[0] + s[4]) + (s[1] + s[5])) + ((s[2] + s[6]) + (s[3] + s[7])))
}

#[inline(always)]
fn add(sum: &mut [f64; LANES], a: &[f64; LANES], b: &[f64; LANES]) {
    for lane in 0..LANES {
        sum[lane] += a[lane] * b[lane];
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
