//! PNG's filters: what a byte is more than those beside and above let expect.
//!
//! Source: PNG specification (third edition), Sect. 9 and 12.7.

use multiversion::multiversion;

/// The filters by number.
const SUB: u8 = 1;
const UP: u8 = 2;
const AVERAGE: u8 = 3;
const PAETH: u8 = 4;
/// Paeth's must be better by this part: it is the slowest to undo, byte by byte.
const DEAR: u64 = 8;
/// So many absolute values of a byte sum up in 16 bits.
const PART: usize = 256;

/// Appends a row as the best filter makes it, behind that filter's number: the one whose differences have the least sum of absolute values.
///
/// `above` is the row above, zeros for the first; `pixel` is how many bytes a pixel has; `tried` is room for a row.
// The first target that the machine has is taken.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512vl", "x86_64+avx2"))]
pub(super) fn append_filtered(row: &[u8], above: &[u8], pixel: usize, tried: &mut [u8], output: &mut Vec<u8>) {
    let start = output.len();
    output.resize(start + 1 + row.len(), 0);
    let (number, best) = output[start..].split_at_mut(1);
    let mut least = filtered::<SUB>(row, above, pixel, best);
    number[0] = SUB;
    let mut keep = |candidate: u8, sum: u64, tried: &[u8]| {
        if sum < least {
            (least, number[0]) = (sum, candidate);
            best.copy_from_slice(tried);
        }
    };
    keep(UP, filtered::<UP>(row, above, pixel, tried), tried);
    keep(AVERAGE, filtered::<AVERAGE>(row, above, pixel, tried), tried);
    let sum = filtered::<PAETH>(row, above, pixel, tried);
    keep(PAETH, sum + sum / DEAR, tried);
}

/// Writes the row as filter `F` makes it; the sum of its absolute values, bytes as signed.
#[inline(always)]
fn filtered<const F: u8>(row: &[u8], above: &[u8], pixel: usize, output: &mut [u8]) -> u64 {
    let pixel = pixel.min(row.len());
    for i in 0..pixel {
        output[i] = row[i].wrapping_sub(expected::<F>(0, above[i], 0));
    }
    let n = row.len() - pixel;
    let (to, from, left) = (&mut output[pixel..][..n], &row[pixel..][..n], &row[..n]);
    let (up, corner) = (&above[pixel..][..n], &above[..n]);
    for i in 0..n {
        to[i] = from[i].wrapping_sub(expected::<F>(left[i], up[i], corner[i]));
    }
    output.chunks(PART).map(|part| u64::from(part.iter().map(|&byte| u16::from((byte as i8).unsigned_abs())).sum::<u16>())).sum()
}

/// What filter `F` expects of a byte from the one of the pixel to the left, the one above, and the one above that to the left.
#[inline(always)]
fn expected<const F: u8>(left: u8, up: u8, corner: u8) -> u8 {
    match F {
        SUB => left,
        UP => up,
        AVERAGE => ((u16::from(left) + u16::from(up)) / 2) as u8,
        _ => paeth(left, up, corner),
    }
}

/// The nearest of the three to left + up - corner, in this order.
#[inline(always)]
fn paeth(left: u8, up: u8, corner: u8) -> u8 {
    let [a, b, c] = [left, up, corner].map(i16::from);
    let [from_left, from_up, from_corner] = [(b - c).abs(), (a - c).abs(), (a + b - 2 * c).abs()];
    let other = if from_up <= from_corner { up } else { corner };
    if from_left <= from_up && from_left <= from_corner { left } else { other }
}
