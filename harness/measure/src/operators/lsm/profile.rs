//! What a blurred pixel sees of a point and of a half-plane, along one axis.

use crate::blurred_step::{DENSITY, step};
use crate::lanes::{self, Lanes, side_by_side};

/// Fractions of a px at which the profile is tabulated; between them it is a Taylor series.
const STEPS: usize = 16;
/// Pixels that are sampled side by side. Fixed, so that every instruction set gives the same bits.
pub(super) const LANES: usize = 16;
/// Adding it leaves a whole number in the lowest bits.
const ROUND: f64 = 6_755_399_441_055_744.0;
/// W, k and the first four derivatives of k.
const DERIVATIVES: usize = 6;
/// The most pixels that see a point, for a blur of 5 px.
const WIDEST: usize = 48;
/// How far the Gaussian reaches, in standard deviations: less than 4e-6 of it is left beyond.
const REACH: f64 = 4.5;

/// The profile of a pixel one px wide under a Gaussian, and its integral, at all pixels around a point.
///
/// With `phi` the normal density, `Phi` its integral and `u = (t -+ 1/2) / sigma`, the profile at distance `t` is `k(t) = Phi(u+) - Phi(u-)` and
/// its integral `W(t) = sigma (G(u+) - G(u-))`, `G(u) = u Phi(u) + phi(u)`: a pixel at `x` sees `W(p - x)` of everything left of `p`.
/// The pixels lie at whole distances, so that they share the fraction of a px and with it one row of the table.
#[derive(Clone, Debug)]
pub(super) struct Profile {
    sigma: f64,
    half: usize,
    /// For each fraction, for each of the [`DERIVATIVES`], for each pixel, with margins for [`LANES`] pixels that do not see the point. In single precision: 1e-7 of a grey value is far below its noise.
    table: Vec<f32>,
}

impl Profile {
    /// With a Gaussian of standard deviation `sigma` px, more than 0.
    pub(super) fn new(sigma: f64) -> Self {
        let mut profile = Self { sigma: 0.0, half: 0, table: Vec::with_capacity(STEPS * DERIVATIVES * 3 * LANES) };
        profile.set(sigma);
        profile
    }

    /// Changes the standard deviation; the table's memory is used again.
    pub(super) fn set(&mut self, sigma: f64) {
        if sigma == self.sigma {
            return;
        }
        let before = self.stride();
        (self.sigma, self.half) = (sigma, (0.5 + REACH * sigma).ceil() as usize);
        let (stride, width) = (self.stride(), self.width());
        // As wide as before, the margins stay as they are.
        if stride != before || self.table.is_empty() {
            self.table.clear();
            self.table.resize(STEPS * DERIVATIVES * stride, 0.0);
        }
        tabulate(&mut self.table, stride, width, self.half as f64, sigma);
    }

    /// From one derivative to the next in the table.
    fn stride(&self) -> usize {
        LANES + self.width() + LANES
    }

    /// Its standard deviation, px.
    pub(super) fn sigma(&self) -> f64 {
        self.sigma
    }

    /// Pixels that see a point.
    pub(super) fn width(&self) -> usize {
        2 * self.half + 2
    }

    /// How far from a point they lie at most, px.
    pub(super) fn reach(&self) -> f64 {
        self.half as f64 + 1.0
    }

    /// The profile around a point.
    #[inline(always)]
    pub(super) fn around(&self, at: f64) -> Around<'_> {
        // The fraction that is tabulated next to it, counted from zero; without a conversion, whose limits would have to be checked.
        let scaled = at * STEPS as f64 - 0.5;
        let shifted = scaled + ROUND;
        let place = shifted.to_bits() as i32;
        let (whole, step) = (place >> STEPS.trailing_zeros(), place as usize % STEPS);
        let d = ((scaled - (shifted - ROUND)) * (1.0 / STEPS as f64)) as f32;
        let stride = self.stride();
        let row = &self.table[step * DERIVATIVES * stride..(step + 1) * DERIVATIVES * stride];
        Around { row, stride, first: whole - self.half as i32, width: self.width() as i32, d }
    }
}

/// The profile around a point, ready to be sampled at pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Around<'a> {
    /// The table for the point's fraction of a px.
    row: &'a [f32],
    stride: usize,
    /// The first pixel that sees the point, and how many do.
    first: i32,
    width: i32,
    /// From the tabulated fraction to the point, px.
    d: f32,
}

impl<'a> Around<'a> {
    /// From which to which of a row of `pixels` the point is seen.
    #[inline(always)]
    pub(super) fn seen(&self, pixels: usize) -> (usize, usize) {
        let inside = |pixel: i32| pixel.clamp(0, pixels as i32) as usize;
        (inside(self.first), inside(self.first + self.width))
    }

    /// Whether it lies so far before the first pixel that no pixel sees anything to its left.
    #[inline(always)]
    pub(super) fn is_before(&self) -> bool {
        self.first + self.width <= 0
    }

    /// The [`LANES`] pixels from `from` on. Pixels that do not see the point have a value of zero and an integral of one (before the point) or
    /// zero (after it).
    #[inline(always)]
    pub(super) fn block(&self, from: usize) -> Block<'a> {
        // Far from the point all lanes come from the table's margins.
        let place = (LANES as i32 + from as i32 - self.first).clamp(0, LANES as i32 + self.width) as usize;
        let entry = |i: usize| side_by_side(self.row, i * self.stride + place);
        Block { entries: [entry(0), entry(1), entry(2), entry(3), entry(4), entry(5)], d: self.d }
    }
}

/// The profile at [`LANES`] pixels: W, k and its derivatives at the tabulated fraction, and how far from there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Block<'a> {
    entries: [&'a [f32; LANES]; DERIVATIVES],
    d: f32,
}

impl Block<'_> {
    /// `W`.
    #[inline(always)]
    pub(super) fn integral(&self) -> [f32; LANES] {
        let [w, k, k1, k2, k3, _] = self.entries;
        series([w, k, k1, k2, k3], self.d)
    }

    /// `k`.
    #[inline(always)]
    pub(super) fn value(&self) -> [f32; LANES] {
        let [_, k, k1, k2, k3, k4] = self.entries;
        series([k, k1, k2, k3, k4], self.d)
    }

    /// `dk/dt`.
    #[inline(always)]
    pub(super) fn slope(&self) -> [f32; LANES] {
        let [_, _, k1, k2, k3, k4] = self.entries;
        let (d, second, third) = (self.d, self.d * self.d * 0.5, self.d * (1.0 / 3.0));
        let mut sums = [0.0; LANES];
        for i in 0..LANES {
            sums[i] = (k1[i] + d * k2[i]) + second * (k3[i] + third * k4[i]);
        }
        sums
    }
}

/// Taylor's series of the fourth order, in pairs of terms: side by side they take less time than one in the other.
#[inline(always)]
fn series([f, f1, f2, f3, f4]: [&[f32; LANES]; 5], d: f32) -> [f32; LANES] {
    let (third, second, fourth) = (d * (1.0 / 3.0), d * d * 0.5, d * d * d * d * (1.0 / 24.0));
    let mut sums = [0.0; LANES];
    for i in 0..LANES {
        sums[i] = ((f[i] + d * f1[i]) + fourth * f4[i]) + second * (f2[i] + third * f3[i]);
    }
    sums
}

/// What borders of pixels give to `W`, `k` and its derivatives, with room for whole lanes on both sides.
type Borders = [[f64; lanes::LANES + (WIDEST + 1).next_multiple_of(lanes::LANES) + lanes::LANES]; DERIVATIVES];

/// Fills a table whose rows of derivatives are `stride` apart, for `width` pixels.
#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn tabulate(table: &mut [f32], stride: usize, width: usize, half: f64, sigma: f64) {
    let [mut borders, mut mirrored]: [Borders; 2] = [[[0.0; _]; DERIVATIVES]; 2];
    let (lower, upper) = table.split_at_mut(STEPS / 2 * DERIVATIVES * stride);
    let rows = lower.chunks_exact_mut(DERIVATIVES * stride).zip(upper.rchunks_exact_mut(DERIVATIVES * stride));
    for (step_index, (row, opposite)) in rows.enumerate() {
        let fraction = (step_index as f64 + 0.5) / STEPS as f64;
        for first in (0..=width).step_by(lanes::LANES) {
            let mut u = [0.0; lanes::LANES];
            for (lane, u) in u.iter_mut().enumerate() {
                *u = (fraction + half + 0.5 - (first + lane) as f64) / sigma;
            }
            let (edge, bell) = step(&u);
            put(&mut borders, lanes::LANES + first, &boundary(&u, &edge, &bell, sigma));
            // At one less this fraction all lies the other way round, to the last bit: the Gaussian is even, its integral odd.
            let (u, edge, bell) = (reversed(&u, -1.0), reversed(&edge, -1.0), reversed(&bell, 1.0));
            put(&mut mirrored, width + 1 - first, &boundary(&u, &edge, &bell, sigma));
        }
        fill(row, stride, width, &borders);
        fill(opposite, stride, width, &mirrored);
    }
}

#[inline(always)]
fn put(borders: &mut Borders, first: usize, values: &[Lanes; DERIVATIVES]) {
    for (border, values) in borders.iter_mut().zip(values) {
        border[first..first + lanes::LANES].copy_from_slice(values);
    }
}

/// Times `sign`, the last first.
#[inline(always)]
fn reversed(values: &Lanes, sign: f64) -> Lanes {
    let mut reversed = [0.0; lanes::LANES];
    for lane in 0..lanes::LANES {
        reversed[lane] = sign * values[lanes::LANES - 1 - lane];
    }
    reversed
}

/// The rows of a fraction: each pixel is the difference of its two borders. Whole lanes at a time, of which the last may reach into the margin.
#[inline(always)]
fn fill(row: &mut [f32], stride: usize, width: usize, borders: &Borders) {
    row[..LANES].fill(1.0);
    for (line, border) in row.chunks_exact_mut(stride).zip(borders) {
        for first in (0..width).step_by(lanes::LANES) {
            let [from, to]: [&Lanes; 2] = [side_by_side(border, lanes::LANES + first), side_by_side(border, lanes::LANES + first + 1)];
            let mut pixels = [0.0; lanes::LANES];
            for lane in 0..lanes::LANES {
                pixels[lane] = (from[lane] - to[lane]) as f32;
            }
            line[LANES + first..LANES + first + lanes::LANES].copy_from_slice(&pixels);
        }
        line[LANES + width..LANES + width + lanes::LANES].fill(0.0);
    }
}

/// What borders of pixels give to `W`, `k` and the derivatives of `k`, at `u` standard deviations, where the step and the Gaussian are `edge` and `bell`.
#[inline(always)]
fn boundary(u: &Lanes, edge: &Lanes, bell: &Lanes, sigma: f64) -> [Lanes; DERIVATIVES] {
    let mut values = [[0.0; lanes::LANES]; DERIVATIVES];
    let s = 1.0 / sigma;
    for i in 0..lanes::LANES {
        let (u, density, below) = (u[i], bell[i] * DENSITY, 0.5 + 0.5 * edge[i]);
        values[0][i] = sigma * (u * below + density);
        values[1][i] = below;
        values[2][i] = density * s;
        values[3][i] = -u * density * (s * s);
        values[4][i] = (u * u - 1.0) * density * (s * s * s);
        values[5][i] = (3.0 - u * u) * u * density * (s * s * s * s);
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `k` at `t` by adding up the Gaussian over the pixel.
    fn by_midpoints(t: f64, sigma: f64) -> f64 {
        let n = 4000;
        let gauss = |u: f64| (-0.5 * u * u).exp() / (2.0 * std::f64::consts::PI).sqrt() / sigma;
        (0..n).map(|i| gauss((t - 0.5 + (f64::from(i) + 0.5) / f64::from(n)) / sigma)).sum::<f64>() / f64::from(n)
    }

    struct Sampled {
        low: usize,
        high: usize,
        integral: Vec<f32>,
        value: Vec<f32>,
        slope: Vec<f32>,
    }

    fn samples(profile: &Profile, at: f64) -> Sampled {
        let around = profile.around(at);
        let blocks = [0, 16, 32].map(|from| around.block(from));
        let (integral, value) = (blocks.map(|b| b.integral()).concat(), blocks.map(|b| b.value()).concat());
        let (slope, (low, high)) = (blocks.map(|b| b.slope()).concat(), around.seen(48));
        Sampled { low, high, integral, value, slope }
    }

    #[test]
    fn samples_are_those_of_a_pixel_under_a_gaussian() {
        for sigma in [0.3, 0.7, 2.0] {
            let profile = Profile::new(sigma);
            for at in [13.0, 13.031, 23.49, -2.77, 0.999, 7.55, 20.81, 38.2, 70.0] {
                let axis = samples(&profile, at);
                for (pixel, value) in axis.value[..40].iter().enumerate() {
                    let t = at - pixel as f64;
                    assert!((f64::from(*value) - by_midpoints(t, sigma)).abs() < 1e-6, "{sigma} {t}: {value}");
                }
            }
        }
    }

    #[test]
    fn each_is_the_derivative_of_the_one_before() {
        for sigma in [0.4, 1.3] {
            let profile = Profile::new(sigma);
            // Differences of the fourth order: with a shorter h the rounding of single precision would show.
            let (h, at) = (0.03, 15.33);
            let [far_low, low, here, high, far_high] = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|steps| samples(&profile, at + steps * h));
            for i in 0..40 {
                let slope = |of: &dyn Fn(&Sampled) -> f32| {
                    let [a, b, c, d] = [&far_low, &low, &high, &far_high].map(|sampled| f64::from(of(sampled)));
                    (8.0 * (c - b) - (d - a)) / (12.0 * h)
                };
                let (first, second) = (slope(&|s| s.integral[i]), slope(&|s| s.value[i]));
                let off = [f64::from(here.value[i]) - first, f64::from(here.slope[i]) - second];
                assert!(off[0].abs() < 1e-5 && off[1].abs() < 2e-5, "{i}: {off:?}");
            }
        }
    }

    #[test]
    fn the_integral_goes_from_one_to_nothing() {
        let profile = Profile::new(0.9);
        let axis = samples(&profile, 17.2);
        let (low, high) = (axis.low, axis.high);
        assert!(low > 0 && (axis.integral[low - 1], axis.integral[high]) == (1.0, 0.0));
        assert!((axis.integral[low] - 1.0).abs() < 1e-6 && axis.integral[high - 1].abs() < 1e-6);
        for (at, expected) in [(-60.0, 0.0), (90.0, 1.0)] {
            assert!(samples(&profile, at).integral[..40].iter().all(|&w| w == expected), "{at}");
        }
    }
}
