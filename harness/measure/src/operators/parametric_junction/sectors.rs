//! The directions of arms and the grey values between them, to begin with: the grey values around a point, cut where that leaves least.

use std::f32::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};

use calibench_model::Image;

use super::arms::MOST;

/// Directions that are told apart: of 9 degrees each.
const BINS: usize = 40;
const HALF: usize = BINS / 2;
/// The widest window, px.
const MOST_COLUMNS: usize = 41;
/// Nearer to the point blur hides the sectors, px.
const HIDDEN: f32 = 1.0;

/// The start: where arms meet (px, in the image), their directions (rad, in order), the sectors' grey values, and the sum of squares that they leave.
#[derive(Clone, Copy, Debug)]
pub(super) struct Guess {
    pub(super) position: [f64; 2],
    pub(super) directions: [f64; MOST],
    pub(super) grey: [f64; MOST],
    pub(super) left: f32,
}

/// Number and sum of the grey values before each direction, twice around.
struct Circle {
    count: [f32; 2 * BINS + 1],
    sum: [f32; 2 * BINS + 1],
    all: f32,
}

impl Circle {
    /// Of the pixels around `pixel`, `half` px along each axis, as seen from `position`; of grey values above `zero`.
    fn new(image: &Image, pixel: (i64, i64), half: i64, position: [f64; 2], zero: f32) -> Option<Self> {
        let side = 2 * half as usize + 1;
        let mut bins = [[0.0; 2]; BINS];
        let mut all = 0.0;
        let mut directions = [0.0; MOST_COLUMNS];
        let left = (pixel.0 as f64 - half as f64 - position[0]) as f32;
        for (row, line) in image.rows_around(pixel.0, pixel.1, half)?.enumerate() {
            let y = (pixel.1 as f64 - half as f64 + row as f64 - position[1]) as f32;
            bins_of_row(left, y, &mut directions[..side]);
            for (direction, grey) in directions.iter().zip(line) {
                let grey = grey - zero;
                // Too near to the point there is no direction.
                let Some(bin) = bins.get_mut(*direction as usize) else { continue };
                bin[0] += 1.0;
                bin[1] += grey;
                all += grey * grey;
            }
        }
        let (mut count, mut sum) = ([0.0; 2 * BINS + 1], [0.0; 2 * BINS + 1]);
        for i in 0..2 * BINS {
            count[i + 1] = count[i] + bins[i % BINS][0];
            sum[i + 1] = sum[i] + bins[i % BINS][1];
        }
        Some(Self { count, sum, all })
    }

    /// The cuts that leave least, and what the means of the sectors between them take of the sum of squares.
    fn cut(&self, arms: usize) -> ([usize; MOST], f32) {
        if arms == 2 {
            let ([first, second], most) = cut_in_two(&self.count, &self.sum);
            return ([first, second, 0, 0], most);
        }
        let mut taken = [[0.0; BINS]; BINS];
        fill_taken(&self.count, &self.sum, &mut taken);
        cut(&taken, arms)
    }
}

/// What the mean of a sector takes of the sum of squares, by how many directions it holds, and its first.
type Taken = [[f32; BINS]; BINS];

#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn fill_taken(count: &[f32; 2 * BINS + 1], sum: &[f32; 2 * BINS + 1], taken: &mut Taken) {
    for (width, taken) in taken.iter_mut().enumerate() {
        for (first, taken) in taken.iter_mut().enumerate() {
            let (n, s) = (count[first + width] - count[first], sum[first + width] - sum[first]);
            *taken = s * s / if n > 1.0 { n } else { 1.0 };
        }
    }
}

/// The directions of the pixels of a row, the first of which lies at (`left`, `y`), in bins; those of pixels that are too near are beyond the last.
#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn bins_of_row(left: f32, y: f32, into: &mut [f32]) {
    for (column, into) in into.iter_mut().enumerate() {
        let x = left + column as f32;
        let (a, b) = (x.abs(), y.abs());
        let (high, low) = if a > b { (a, b) } else { (b, a) };
        let slope = low / if high > 1e-6 { high } else { 1e-6 };
        // The arc tangent within 0.0038 rad.
        let first = slope * (FRAC_PI_4 + 0.273 * (1.0 - slope));
        let quarter = if b > a { FRAC_PI_2 - first } else { first };
        let half = if x < 0.0 { PI - quarter } else { quarter };
        let angle = if y < 0.0 { TAU - half } else { half };
        let bin = angle * (BINS as f32 / TAU);
        let inside = if bin < BINS as f32 { bin } else { 0.0 };
        *into = if x * x + y * y < HIDDEN * HIDDEN { BINS as f32 } else { inside };
    }
}

/// The two cuts that leave least, and what they take of the sum of squares.
///
/// Both sectors are told by the narrower: of every width all first directions are seen side by side.
#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn cut_in_two(count: &[f32; 2 * BINS + 1], sum: &[f32; 2 * BINS + 1]) -> ([usize; 2], f32) {
    let (of_all, sum_of_all) = (count[BINS], sum[BINS]);
    let (mut most, mut widths) = ([f32::NEG_INFINITY; BINS], [0.0; BINS]);
    for width in 1..=HALF {
        for first in 0..BINS {
            let (n, s) = (count[first + width] - count[first], sum[first + width] - sum[first]);
            let (rest, sum_of_rest) = (of_all - n, sum_of_all - s);
            let value = s * s / if n > 1.0 { n } else { 1.0 } + sum_of_rest * sum_of_rest / if rest > 1.0 { rest } else { 1.0 };
            let more = value > most[first];
            most[first] = if more { value } else { most[first] };
            widths[first] = if more { width as f32 } else { widths[first] };
        }
    }
    let best = (1..BINS).fold(0, |best, first| if most[first] > most[best] { first } else { best });
    let other = (best + widths[best] as usize) % BINS;
    ([best.min(other), best.max(other)], most[best])
}

/// The cuts that leave least.
fn cut(taken: &Taken, arms: usize) -> ([usize; MOST], f32) {
    let (mut most, mut best) = (f32::NEG_INFINITY, [0; MOST]);
    let mut see = |value: f32, cuts: &[usize]| {
        if value > most {
            most = value;
            best[..cuts.len()].copy_from_slice(cuts);
        }
    };
    for i in 0..BINS {
        for j in i + 1..BINS {
            let first = taken[j - i][i];
            match arms {
                3 => (j + 1..BINS).for_each(|k| see(first + taken[k - j][j] + taken[BINS + i - k][k], &[i, j, k])),
                _ if j < HALF => {
                    let (width, rest) = (j - i, HALF + i - j);
                    let value = first + taken[rest][j] + taken[width][i + HALF] + taken[rest][j + HALF];
                    see(value, &[i, j, i + HALF, j + HALF]);
                }
                _ => {}
            }
        }
    }
    (best, most)
}

/// The best sectors of `arms` arms around a position, in the window of `half` px around a pixel. Four arms are two lines. `None` where a sector has no pixel.
pub(super) fn sectors(image: &Image, pixel: (i64, i64), half: i64, position: [f64; 2], arms: usize) -> Option<Guess> {
    let zero = image.row(pixel.1 as usize)[pixel.0 as usize];
    let circle = Circle::new(image, pixel, half, position, zero)?;
    let (cuts, taken) = circle.cut(arms);
    let mut guess = Guess { position, directions: [0.0; MOST], grey: [0.0; MOST], left: circle.all - taken };
    for k in 0..arms {
        let to = if k + 1 < arms { cuts[k + 1] } else { cuts[0] + BINS };
        let (count, sum) = (circle.count[to] - circle.count[cuts[k]], circle.sum[to] - circle.sum[cuts[k]]);
        guess.grey[k] = f64::from(zero) + f64::from(sum / count);
        guess.directions[k] = cuts[k] as f64 * (std::f64::consts::TAU / BINS as f64);
    }
    guess.grey.iter().all(|grey| grey.is_finite()).then_some(guess)
}
