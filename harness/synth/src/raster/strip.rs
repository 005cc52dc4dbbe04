//! A strip of rows in which pieces leave their mark.
//!
//! Green's theorem turns a pixel's integral of an area under the kernel k(x) k(y) into one along the area's outline, of S(x) k(y) dy, with S the integral of
//! k. A point of the outline therefore changes the pixels within the kernel's reach, and, where S has become one, all that lie left of it. Written as
//! differences along the row the second part costs nothing: a running sum makes it.

use super::nodes::{Node, Rules, each_node};
use super::piece::Piece;
use super::sharp;
use crate::optics::{Kernel, Part};

/// Rows that are summed side by side.
const TOGETHER: usize = 4;

/// Differences along rows `top` to `top + rows`.
pub(crate) struct Strip {
    pub top: i64,
    pub rows: usize,
    width: usize,
    pad: usize,
    stride: usize,
    differences: Vec<f64>,
    scratch: Vec<f64>,
}

impl Strip {
    /// For images of `width` px and kernels that reach `reach` px along the row.
    pub fn new(width: usize, rows: usize, reach: f64) -> Self {
        let pad = 2 * reach.ceil() as usize + 16;
        let stride = width + 2 * pad;
        Self { top: 0, rows, width, pad, stride, differences: vec![0.0; stride * rows], scratch: vec![0.0; pad] }
    }

    /// Columns, px.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Makes it the strip of `rows` rows from `top` on, empty.
    pub fn reset(&mut self, top: i64, rows: usize) {
        (self.top, self.rows) = (top, rows);
        self.differences[..self.stride * rows].fill(0.0);
    }

    /// Sums the differences along each row and hands the grey values, which begin with `background`, to `row`.
    pub fn finish(&mut self, background: f64, mut row: impl FnMut(usize, &[f64])) {
        let (pad, width, stride) = (self.pad, self.width, self.stride);
        for (block, rows) in self.differences[..stride * self.rows].chunks_mut(stride * TOGETHER).enumerate() {
            if rows.len() == stride * TOGETHER {
                sum_along::<TOGETHER>(rows, pad, width, background);
            } else {
                rows.chunks_exact_mut(stride).for_each(|row| sum_along::<1>(row, pad, width, background));
            }
            for (y, sums) in rows.chunks_exact(stride).enumerate() {
                row(block * TOGETHER + y, &sums[pad..pad + width]);
            }
        }
    }

    /// As [`Self::finish`], into rows of single precision, in the same pass.
    pub fn finish_into(&self, background: f64, grey: &mut [f32]) {
        let (pad, width, stride) = (self.pad, self.width, self.stride);
        let blocks = self.differences[..stride * self.rows].chunks(stride * TOGETHER).zip(grey.chunks_mut(width * TOGETHER));
        for (rows, grey) in blocks {
            if rows.len() == stride * TOGETHER {
                sum_into::<TOGETHER>(rows, pad, width, background, grey);
            } else {
                let rows = rows.chunks_exact(stride).zip(grey.chunks_exact_mut(width));
                rows.for_each(|(row, grey)| sum_into::<1>(row, pad, width, background, grey));
            }
        }
    }

    /// The row of differences `y`, px from the image's top, if the strip holds it, from `column` on; the first column stands for all that lie left.
    #[inline(always)]
    pub fn row_from(&mut self, y: i64, column: i64) -> Option<&mut [f64]> {
        let row = y - self.top;
        if row < 0 || row >= self.rows as i64 || column >= self.width as i64 {
            return None;
        }
        let start = (column + self.pad as i64).max(0) as usize;
        Some(&mut self.differences[row as usize * self.stride + start..(row as usize + 1) * self.stride])
    }

    /// Adds `pieces`, those that `listed` names, as `kernel` spreads them. `jitter` is the shift of each row of the strip to the right, px.
    pub fn add(&mut self, pieces: &[Piece], listed: &[u32], kernel: &Kernel, rules: &Rules, jitter: Option<&[f64]>) {
        match kernel {
            Kernel::Sharp(aperture) => {
                for &index in listed {
                    sharp::add(self, &pieces[index as usize], *aperture, jitter);
                }
            }
            Kernel::Smooth { sigma, parts } => match jitter {
                None => by_width(*sigma, parts, |sigma, parts| smooth(self, pieces, listed, sigma, parts, rules)),
                Some(jitter) => by_width(*sigma, parts, |sigma, parts| jittered(self, pieces, listed, sigma, parts, rules, jitter)),
            },
        }
    }
}

/// The parts of the core, whose Gaussian has `sigma` px, and those of a tail: a wider one needs fewer nodes.
fn by_width(sigma: f64, parts: &[Part], mut each: impl FnMut(f64, &[Part])) {
    let core = parts.iter().take_while(|part| part.profiles[1].sigma == sigma).count();
    let (core, tail) = parts.split_at(core);
    each(sigma, core);
    if let Some(first) = tail.first() {
        each(first.profiles[1].sigma, tail);
    }
}

/// Running sums of `N` rows in place, over `width` px from column `pad` on; they begin with `background` and with what stands in the columns before.
/// Each sum waits for the one before: those of other rows fill the time.
fn sum_along<const N: usize>(rows: &mut [f64], pad: usize, width: usize, background: f64) {
    let stride = rows.len() / N;
    let mut sums: [f64; N] = beginnings(rows, pad, background);
    for x in pad..pad + width {
        for (i, sum) in sums.iter_mut().enumerate() {
            *sum += rows[i * stride + x];
            rows[i * stride + x] = *sum;
        }
    }
}

/// As [`sum_along`], into rows of `width` px.
fn sum_into<const N: usize>(rows: &[f64], pad: usize, width: usize, background: f64, grey: &mut [f32]) {
    let stride = rows.len() / N;
    let mut sums: [f64; N] = beginnings(rows, pad, background);
    let rows: [&[f64]; N] = std::array::from_fn(|i| &rows[i * stride + pad..][..width]);
    let mut all = grey.chunks_exact_mut(width);
    let grey: [&mut [f32]; N] = std::array::from_fn(|_| &mut all.next().unwrap_or_default()[..width]);
    for x in 0..width {
        for i in 0..N {
            sums[i] += rows[i][x];
            grey[i][x] = sums[i] as f32;
        }
    }
}

/// What stands left of the first column of each row.
fn beginnings<const N: usize>(rows: &[f64], pad: usize, background: f64) -> [f64; N] {
    let stride = rows.len() / N;
    std::array::from_fn(|i| background + rows[i * stride..][..pad].iter().sum::<f64>())
}

// The first target that the machine has is taken.
#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn smooth(strip: &mut Strip, pieces: &[Piece], listed: &[u32], sigma: f64, parts: &[Part], rules: &Rules) {
    let bounds = [strip.top as f64, (strip.top + strip.rows as i64 - 1) as f64];
    for &index in listed {
        each_node(&pieces[index as usize], sigma, bounds, parts, rules, |part, node| mark(strip, part, node.at, node.along[1]));
    }
}

fn jittered(strip: &mut Strip, pieces: &[Piece], listed: &[u32], sigma: f64, parts: &[Part], rules: &Rules, jitter: &[f64]) {
    let bounds = [strip.top as f64, (strip.top + strip.rows as i64 - 1) as f64];
    for &index in listed {
        each_node(&pieces[index as usize], sigma, bounds, parts, rules, |part, Node { at: [x, y], along: [_, weight] }| {
            let (first, low, high, share) = part.down.around(y);
            for (row, (low, high)) in (first..).zip(low.iter().zip(high)) {
                let Some(shift) = usize::try_from(row - strip.top).ok().and_then(|row| jitter.get(row)) else { continue };
                let down = weight * (low + share * (high - low));
                let (column, low, high, share) = part.along.around(x + shift + 0.5);
                let Some(differences) = strip.row_from(row, column) else { continue };
                for ((difference, low), high) in differences.iter_mut().zip(low).zip(high) {
                    *difference -= down * (low + share * (high - low));
                }
            }
        });
    }
}

/// What a point of an outline changes.
#[inline(always)]
fn mark(strip: &mut Strip, part: &Part, at: [f64; 2], weight: f64) {
    match part.along.taps {
        4 => mark_taps::<4>(strip, part, at, weight),
        8 => mark_taps::<8>(strip, part, at, weight),
        12 => mark_taps::<12>(strip, part, at, weight),
        16 => mark_taps::<16>(strip, part, at, weight),
        20 => mark_taps::<20>(strip, part, at, weight),
        _ => mark_wide(strip, part, at, weight),
    }
}

/// As [`mark_wide`], of a kernel of `TAPS` pixels along the row: their weights stay in registers while row after row is changed.
#[inline(always)]
fn mark_taps<const TAPS: usize>(strip: &mut Strip, part: &Part, [x, y]: [f64; 2], weight: f64) {
    let (column, low, high, share) = part.along.around(x + 0.5);
    if column >= strip.width as i64 {
        return;
    }
    let (Some(low), Some(high)) = (low.first_chunk::<TAPS>(), high.first_chunk::<TAPS>()) else { return };
    let mut along = [0.0; TAPS];
    for tap in 0..TAPS {
        along[tap] = low[tap] + share * (high[tap] - low[tap]);
    }
    let (first, low, high, share) = part.down.around(y);
    let row = first - strip.top;
    let rows = (-row).max(0) as usize..((strip.rows as i64 - row).max(0) as usize).min(part.down.reached);
    let mut at = (row + rows.start as i64) as usize * strip.stride + (column + strip.pad as i64).max(0) as usize;
    for tap in rows {
        let down = weight * (low[tap] + share * (high[tap] - low[tap]));
        let Some(differences) = strip.differences[at..].first_chunk_mut::<TAPS>() else { return };
        for tap in 0..TAPS {
            differences[tap] -= down * along[tap];
        }
        at += strip.stride;
    }
}

/// What a point of an outline changes, under a kernel of any width.
#[inline(always)]
fn mark_wide(strip: &mut Strip, part: &Part, [x, y]: [f64; 2], weight: f64) {
    let (column, low, high, share) = part.along.around(x + 0.5);
    if column >= strip.width as i64 {
        return;
    }
    let taps = part.along.taps;
    let mut scratch = std::mem::take(&mut strip.scratch);
    for ((value, low), high) in scratch[..taps].iter_mut().zip(low).zip(high) {
        *value = low + share * (high - low);
    }
    let (first, low, high, share) = part.down.around(y);
    for (row, (low, high)) in (first..).zip(low.iter().zip(high)) {
        let down = weight * (low + share * (high - low));
        if let Some(differences) = strip.row_from(row, column) {
            for (difference, along) in differences[..taps].iter_mut().zip(&scratch[..taps]) {
                *difference -= down * along;
            }
        }
    }
    strip.scratch = scratch;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::Optics;

    const WIDTH: usize = 40;
    const ROWS: usize = 48;

    /// The grey values of a piece in strips of so many rows.
    fn in_strips(piece: &Piece, rows: usize) -> Vec<f64> {
        let optics = Optics { aperture: 1.0, ..Optics::default() };
        let kernel = Kernel::new(&optics, 0.6);
        let (mut strip, mut grey) = (Strip::new(WIDTH, rows, kernel.reach()[0]), Vec::new());
        for top in (0..ROWS).step_by(rows) {
            strip.reset(top as i64, rows);
            strip.add(std::slice::from_ref(piece), &[0], &kernel, Rules::all(), None);
            let mut kept = vec![0.0; WIDTH * rows];
            strip.finish_into(0.25, &mut kept);
            let mut sums = Vec::new();
            strip.finish(0.25, |y, row| {
                assert_eq!(y * WIDTH, sums.len());
                sums.extend_from_slice(row);
            });
            assert_eq!(kept, sums.iter().map(|sum| *sum as f32).collect::<Vec<f32>>(), "in strips of {rows}");
            grey.extend(sums.iter().map(|sum| sum - 0.25));
        }
        grey
    }

    #[test]
    fn a_strip_leaves_out_nothing_of_a_long_piece() {
        // Straight; an arc whose ends lie above all rows that its middle touches; one that swings to both sides.
        let swings: [fn(f64) -> f64; 3] =
            [|t| 60.0 * t - 6.0, |t| 160.0 * t * (1.0 - t) - 2.0, |t| 24.0 + 300.0 * t * (t - 0.5) * (t - 1.0)];
        for (which, y) in swings.into_iter().enumerate() {
            let at = |i: usize| 0.25 * i as f64;
            let piece = Piece { points: std::array::from_fn(|i| [4.0 + 30.0 * at(i), y(at(i))]), contrast: 1.0 };
            let whole = in_strips(&piece, ROWS);
            assert!(whole.iter().filter(|grey| grey.abs() > 0.01).count() > ROWS, "piece {which}");
            for rows in [1, 4, 6, 16] {
                assert_eq!(in_strips(&piece, rows), whole, "piece {which} in strips of {rows}");
            }
        }
    }
}
