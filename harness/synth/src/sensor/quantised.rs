//! What JPEG with given tables leaves of grey values: blocks of cosines, rounded.

use std::f64::consts::PI;
use std::sync::OnceLock;

use calibench_model::Image;
use rayon::prelude::*;

/// Side of a block, px.
const SIDE: usize = 8;
/// A block, row by row.
type Block = [f64; 64];

/// The image of 8 bits that is left of `image` after its blocks of 8 x 8 were quantised as JPEG does, by a table row by row, each number 1 to 255. Blocks at the right and
/// lower borders are filled with the last column and row. Coefficients are not rounded before they are divided, and the inverse is exact up to the rounding of grey values.
///
/// Source: ITU-T T.81, A.3.
pub fn through_tables(mut image: Image<'static>, table: &[u8; 64]) -> Image<'static> {
    let (width, height) = (image.width(), image.height());
    let levels = image.to_u8();
    let at = |x: usize, y: usize| f64::from(levels[y.min(height - 1) * width + x.min(width - 1)]) - 128.0;
    let rows = image.grey_mut().par_chunks_mut(SIDE * width.max(1)).enumerate();
    rows.for_each(|(top, rows)| {
        for left in (0..width).step_by(SIDE) {
            let mut block: Block = std::array::from_fn(|k| at(left + k % SIDE, top * SIDE + k / SIDE));
            transform(&mut block, false);
            block.iter_mut().zip(table).for_each(|(value, step)| *value = (*value / f64::from(*step)).round() * f64::from(*step));
            transform(&mut block, true);
            for (y, row) in rows.chunks_mut(width).enumerate() {
                for (x, grey) in row[left..(left + SIDE).min(width)].iter_mut().enumerate() {
                    *grey = ((block[y * SIDE + x] + 128.0).round().clamp(0.0, 255.0) / 255.0) as f32;
                }
            }
        }
    });
    image
}

/// Cosines by frequency, orthonormal.
fn cosines() -> &'static [[f64; SIDE]; SIDE] {
    static COSINES: OnceLock<[[f64; SIDE]; SIDE]> = OnceLock::new();
    COSINES.get_or_init(|| {
        std::array::from_fn(|u| {
            let norm = if u == 0 { 0.125_f64.sqrt() } else { 0.5 };
            std::array::from_fn(|x| norm * ((2 * x + 1) as f64 * u as f64 * PI / 16.0).cos())
        })
    })
}

/// The two-dimensional cosine transform, or its inverse.
fn transform(block: &mut Block, inverse: bool) {
    let cosines = cosines();
    let weight = |u: usize, x: usize| if inverse { cosines[x][u] } else { cosines[u][x] };
    let along: Block = std::array::from_fn(|k| (0..SIDE).map(|x| weight(k % SIDE, x) * block[k / SIDE * SIDE + x]).sum());
    *block = std::array::from_fn(|k| (0..SIDE).map(|y| weight(k / SIDE, y) * along[y * SIDE + k % SIDE]).sum());
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensor::through_jpeg;

    /// Something with edges and slopes.
    fn image(width: usize, height: usize) -> Image<'static> {
        Image::from_fn(width, height, |x, y| {
            let step = if (x + 2 * y) % 23 < 11 { 0.55 } else { 0.2 };
            (step + 0.2 * (x as f32 / 40.0) + 0.1 * ((x * 7 + y * 13) % 5) as f32 / 5.0).clamp(0.0, 1.0)
        })
    }

    #[test]
    fn a_table_of_ones_leaves_grey_levels_within_a_step() {
        let before = image(43, 29);
        let after = through_tables(before.clone(), &[1; 64]);
        assert!(before.to_u8().iter().zip(after.to_u8()).all(|(a, b)| a.abs_diff(b) <= 2));
    }

    #[test]
    fn what_the_transform_does_its_inverse_undoes_and_lengths_stay() {
        let before: Block = std::array::from_fn(|k| ((k * 37) % 101) as f64 - 50.0);
        let mut block = before;
        transform(&mut block, false);
        let length = |block: &Block| block.iter().map(|value| value * value).sum::<f64>();
        assert!((length(&block) / length(&before) - 1.0).abs() < 1e-12);
        assert!((block[0] - before.iter().sum::<f64>() / 8.0).abs() < 1e-9);
        transform(&mut block, true);
        assert!(block.iter().zip(before).all(|(a, b)| (a - b).abs() < 1e-9));
    }

    /// An encoder and a decoder of others, at the table of quality 50: the same but for how they round.
    #[test]
    fn it_is_what_a_codec_does_with_the_same_table() {
        const STANDARD: [u8; 64] = [
            16, 11, 10, 16, 24, 40, 51, 61, 12, 12, 14, 19, 26, 58, 60, 55, 14, 13, 16, 24, 40, 57, 69, 56, 14, 17, 22, 29, 51, 87, 80, 62,
            18, 22, 37, 56, 68, 109, 103, 77, 24, 35, 55, 64, 81, 104, 113, 92, 49, 64, 78, 87, 103, 121, 120, 101, 72, 92, 95, 98, 112,
            100, 103, 99,
        ];
        let before = image(64, 48);
        let (ours, theirs) = (through_tables(before.clone(), &STANDARD).to_u8(), through_jpeg(before.clone(), 50).unwrap().to_u8());
        let apart = |a: &[u8], b: &[u8]| {
            (a.iter().zip(b).map(|(a, b)| (f64::from(*a) - f64::from(*b)).powi(2)).sum::<f64>() / a.len() as f64).sqrt()
        };
        let (codec, loss) = (apart(&ours, &theirs), apart(&ours, &before.to_u8()));
        assert!(loss > 4.0 && codec < 0.25 * loss, "{codec} {loss}");
    }
}
