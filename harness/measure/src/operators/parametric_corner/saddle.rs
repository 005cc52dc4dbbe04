//! Where a chess corner is, to begin with: the saddle of the smoothed grey values.

use calibench_model::Image;

use crate::lanes::{LANES, Lanes, side_by_side};

/// Half the widest kernel, px.
const WIDEST: usize = 5;
/// Half the widest field of places, px.
const FIELD: usize = 12;
/// Places of the widest field side by side, in whole lanes.
const PLACES: usize = (2 * FIELD + 1).next_multiple_of(LANES);
/// Pixels side by side that these see.
const PIXELS: usize = (PLACES + 2 * WIDEST).next_multiple_of(LANES);
/// Rows of pixels that a field sees.
const ROWS: usize = 2 * (FIELD + WIDEST) + 1;

/// Strengths of saddles, row by row.
type Field = [[f64; PLACES]; 2 * FIELD + 1];

/// Gaussian derivatives of order 0, 1 and 2, sampled.
struct Kernels {
    reach: usize,
    taps: [[f64; 2 * WIDEST + 1]; 3],
}

impl Kernels {
    /// With a standard deviation of `reach / 2.5` px.
    fn new(reach: usize) -> Self {
        let sigma = reach as f64 / 2.5;
        let mut taps = [[0.0; 2 * WIDEST + 1]; 3];
        let [value, slope, bend] = &mut taps;
        for i in 0..=2 * reach {
            let t = (i as f64 - reach as f64) / sigma;
            let bell = (-0.5 * t * t).exp();
            (value[i], slope[i], bend[i]) = (bell, t * bell, (t * t - 1.0) * bell);
        }
        // Truncated and sampled, the second derivative must still not see a constant.
        let excess = bend.iter().sum::<f64>() / value.iter().sum::<f64>();
        for (bend, value) in bend.iter_mut().zip(value) {
            *bend -= excess * *value;
        }
        Self { reach, taps }
    }
}

/// Of the saddles within `search` px of a pixel along each axis the nearest that is at least half as strong as the strongest, refined by a parabola an axis. `reach` is half the kernel.
///
/// Its strength is minus the determinant of the second derivatives: positive on saddles alone, zero along straight edges. `None` when
/// there is no saddle. The image holds `reach` px around the pixel; places nearer to its border are left out.
pub(super) fn saddle(image: &Image, (x, y): (i64, i64), search: usize, reach: usize) -> Option<[f64; 2]> {
    let kernels = Kernels::new(reach.min(WIDEST));
    let side = 2 * search + 1;
    let [left, top] = [x, y].map(|c| c - search as i64);
    let patch = Patch::of(image, (left, top), side, kernels.reach);
    let mut strengths: Field = [[0.0; PLACES]; 2 * FIELD + 1];
    fill(&mut strengths, &patch, &kernels, side);
    let (mut best, mut at) = (0.0, None);
    for (row, line) in strengths.iter().take(side).enumerate() {
        for (column, strength) in line.iter().take(side).enumerate() {
            if *strength > best {
                (best, at) = (*strength, Some((column, row)));
            }
        }
    }
    let (column, row) = nearest(&strengths, side, best, at?);
    let best = strengths[row][column];
    let peak = |low: f64, high: f64| {
        let (slope, bend) = (0.5 * (high - low), 2.0 * best - low - high);
        if bend > 0.0 && low > 0.0 && high > 0.0 { (slope / bend).clamp(-0.5, 0.5) } else { 0.0 }
    };
    let value = |c: usize, r: usize| if c < side && r < side { strengths[r][c] } else { 0.0 };
    let dx = peak(value(column.wrapping_sub(1), row), value(column + 1, row));
    let dy = peak(value(column, row.wrapping_sub(1)), value(column, row + 1));
    Some([left as f64 + column as f64 + dx, top as f64 + row as f64 + dy])
}

/// Of the maxima of half of the strength `best` or more the one nearest to the middle: on a board of small squares the next corner may be the stronger.
fn nearest(strengths: &Field, side: usize, best: f64, strongest: (usize, usize)) -> (usize, usize) {
    let is_maximum = |column: usize, row: usize| {
        let around = |place: usize| place.saturating_sub(1)..(place + 2).min(side);
        around(row).all(|r| around(column).all(|c| strengths[r][c] <= strengths[row][column]))
    };
    let off = |(column, row): (usize, usize)| [column, row].map(|place| (place as i64 - side as i64 / 2).pow(2)).iter().sum::<i64>();
    let places = (0..side).flat_map(|row| (0..side).map(move |column| (column, row)));
    let strong = places.filter(|&(column, row)| strengths[row][column] >= 0.5 * best && is_maximum(column, row));
    strong.chain([strongest]).min_by_key(|place| off(*place)).unwrap_or(strongest)
}

/// The pixels that a field of places sees.
struct Patch {
    grey: [[f32; PIXELS]; ROWS],
    /// The places, from the first to before the last along x and along y, whose kernels are inside the image.
    inside: [(usize, usize); 2],
}

impl Patch {
    /// For a field of `side` x `side` places from (`left`, `top`) on.
    fn of(image: &Image, (left, top): (i64, i64), side: usize, reach: usize) -> Self {
        let within = |first: i64, pixels: usize| {
            let reach = reach as i64;
            let (begin, end) = ((reach - first).max(0), (pixels as i64 - reach - first).min(side as i64));
            if begin < end { (begin as usize, end as usize) } else { (0, 0) }
        };
        let inside = [within(left, image.width()), within(top, image.height())];
        let mut patch = Self { grey: [[0.0; PIXELS]; ROWS], inside };
        let [columns, rows] = inside.map(|(begin, end)| if begin < end { begin..end + 2 * reach } else { 0..0 });
        let pixel = |first: i64, place: usize| (first - reach as i64 + place as i64) as usize;
        for row in rows.filter(|_| !columns.is_empty()) {
            let from = &image.row(pixel(top, row))[pixel(left, columns.start)..][..columns.len()];
            patch.grey[row][columns.clone()].copy_from_slice(from);
        }
        patch
    }
}

/// The strengths of all places inside: rows are filtered downwards by each kernel, then across.
#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn fill(strengths: &mut Field, patch: &Patch, kernels: &Kernels, side: usize) {
    let [(begin, end), (first, last)] = patch.inside;
    let (taps, seen) = (2 * kernels.reach + 1, (side + 2 * kernels.reach).next_multiple_of(LANES));
    for (row, line) in strengths.iter_mut().enumerate().take(last).skip(first) {
        let mut down = [[0.0; PIXELS]; 3];
        for start in (0..seen).step_by(LANES) {
            let mut sums = [[0.0; LANES]; 3];
            for tap in 0..taps {
                let grey: &[f32; LANES] = side_by_side(&patch.grey[row + tap], start);
                for (sum, kernel) in sums.iter_mut().zip(&kernels.taps) {
                    for i in 0..LANES {
                        sum[i] += kernel[tap] * f64::from(grey[i]);
                    }
                }
            }
            for (down, sum) in down.iter_mut().zip(&sums) {
                down[start..start + LANES].copy_from_slice(sum);
            }
        }
        for start in (0..side).step_by(LANES) {
            let (mut xx, mut xy, mut yy) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
            for tap in 0..taps {
                let filtered = |kernel: usize| -> &Lanes { side_by_side(&down[kernel], start + tap) };
                let [value, slope, bend] = [filtered(0), filtered(1), filtered(2)];
                for i in 0..LANES {
                    xx[i] += kernels.taps[2][tap] * value[i];
                    xy[i] += kernels.taps[1][tap] * slope[i];
                    yy[i] += kernels.taps[0][tap] * bend[i];
                }
            }
            for i in 0..LANES {
                let inside = begin <= start + i && start + i < end;
                line[start + i] = if inside { xy[i] * xy[i] - xx[i] * yy[i] } else { 0.0 };
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The strength of one place from sums over its pixels, without rows before columns.
    fn directly(image: &Image, kernels: &Kernels, (x, y): (i64, i64)) -> f64 {
        let reach = kernels.reach as i64;
        if !image.holds(x, y, reach) {
            return 0.0;
        }
        let sum = |across: usize, down: usize| -> f64 {
            let pixels = (-reach..=reach).flat_map(|v| (-reach..=reach).map(move |u| (u, v)));
            let tap = |order: usize, at: i64| kernels.taps[order][(at + reach) as usize];
            pixels.map(|(u, v)| tap(across, u) * tap(down, v) * f64::from(image.row((y + v) as usize)[(x + u) as usize])).sum()
        };
        sum(1, 1).powi(2) - sum(2, 0) * sum(0, 2)
    }

    #[test]
    fn strengths_are_those_of_sums_over_pixels_up_to_the_border() {
        let image = Image::from_fn(33, 27, |x, y| ((x * 37 + y * 61 + x * y * 13) % 101) as f32 / 100.0);
        for (x, y, search, reach) in [(16, 13, 5, 5), (5, 5, 5, 5), (27, 21, 5, 5), (5, 21, 12, 5), (29, 3, 7, 3), (16, 13, 12, 4)] {
            let (kernels, side, [left, top]) = (Kernels::new(reach), 2 * search + 1, [x - search as i64, y - search as i64]);
            let mut strengths: Field = [[0.0; PLACES]; 2 * FIELD + 1];
            fill(&mut strengths, &Patch::of(&image, (left, top), side, reach), &kernels, side);
            let (mut none, mut some) = (0, 0);
            for (row, column) in (0..side).flat_map(|row| (0..side).map(move |column| (row, column))) {
                let expected = directly(&image, &kernels, (left + column as i64, top + row as i64));
                *(if expected == 0.0 { &mut none } else { &mut some }) += 1;
                assert!((strengths[row][column] - expected).abs() < 1e-9 * (1.0 + expected.abs()), "({x}, {y}): {column}, {row}");
            }
            assert!(some > 0 && (none > 0) != image.holds(x, y, (search + reach) as i64), "({x}, {y}): {none}, {some}");
        }
    }
}
