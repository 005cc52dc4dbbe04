//! Sums of products of columns, over many observations at once.

/// Points side by side in a block of rows; a column of a block holds as many x, then as many y.
pub(crate) const LANES: usize = 8;
/// Numbers of a column in a block.
pub(crate) const BLOCK: usize = 2 * LANES;

/// Sums of two columns with two others, lane by lane.
pub(crate) type Tile = [[f64; LANES]; 4];

/// `G = R^T R` of `columns` (an even number) columns kept in blocks: row by row, lower triangle and the 2 x 2 blocks on the diagonal. `tiles` is memory
/// that is used again.
///
/// No fused operations: any machine gives the same bits.
pub(crate) fn gram(rows: &[f64], columns: usize, tiles: &mut Vec<Tile>, products: &mut [f64]) {
    let across = columns / 2;
    tiles.resize(across * (across + 1) / 2, Tile::default());
    by_lanes(rows, across, tiles);
    across_lanes(tiles, columns, products);
}

#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn by_lanes(rows: &[f64], across: usize, tiles: &mut [Tile]) {
    let (pairs, _) = rows.as_chunks::<{ 2 * BLOCK }>();
    let mut tiles = tiles.iter_mut();
    for i in 0..across {
        for (j, tile) in (0..=i).zip(&mut tiles) {
            let mut sums = Tile::default();
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
            *tile = sums;
        }
    }
}

/// Apart, so that the loops above keep their lanes in order: compiled together, sums were shuffled at every step.
#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn across_lanes(tiles: &[Tile], columns: usize, products: &mut [f64]) {
    let mut tiles = tiles.iter();
    for (i, rows) in products.chunks_exact_mut(2 * columns).enumerate() {
        let (first, second) = rows.split_at_mut(columns);
        let ((first, _), (second, _)) = (first.as_chunks_mut::<2>(), second.as_chunks_mut::<2>());
        for ((first, second), tile) in first.iter_mut().zip(second).take(i + 1).zip(&mut tiles) {
            let half = tile.map(|s| [s[0] + s[4], s[1] + s[5], s[2] + s[6], s[3] + s[7]]);
            let [p, q, r, s] = half.map(|h| (h[0] + h[1]) + (h[2] + h[3]));
            (*first, *second) = ([p, q], [r, s]);
        }
    }
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
        gram(&rows, columns, &mut Vec::new(), &mut products);
        let at = |block: usize, column: usize, k: usize| rows[(block * columns + column) * BLOCK + k];
        for i in 0..columns {
            for j in 0..=i {
                let sum: f64 = (0..blocks * BLOCK).map(|k| at(k / BLOCK, i, k % BLOCK) * at(k / BLOCK, j, k % BLOCK)).sum();
                assert!((products[i * columns + j] - sum).abs() < 1e-13, "{i} {j}");
            }
        }
    }
}
