//! What a fit leaves: noise, or something that the model does not picture.

use crate::lanes::{WIDE, sum};
use crate::parameter::Parameter;

/// The parameter of operators that fit an outline: the root of the covariance of neighbouring residuals, in units of half the contrast, beyond which a window holds
/// something else.
pub(crate) const fn misfit(default: f64) -> Parameter {
    Parameter::real(
        "misfit",
        "rejected where the covariance of neighbouring residuals is beyond its square, in units of half the contrast, and no noise: something else is in the window. \
                2: nothing is rejected",
        [0.0, 2.0],
        default,
    )
}

/// Structure has a covariance of neighbours of so many standard deviations of that of white noise.
const SIGNIFICANT: f64 = 5.0;
/// White noise has fewer, but for one window in a thousand.
const WHITE: f64 = 3.0;

/// A correlation of neighbours beyond it is taken as this.
const STRONGEST: f64 = 0.9;

/// Change of the coverage with the place of what is pictured, 1/px, from which on a pixel tells anything of that: a tenth of what a sharp edge has.
const SHOWS: f32 = 0.05;

/// The residuals of a window, row by row, in units of half the contrast; those that do not count are NaN.
pub(crate) struct Residuals {
    pub(crate) grey: Vec<f32>,
    pub(crate) side: usize,
}

/// Products of residuals with their neighbours to the right and below, and squares, added up.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Structure {
    pub(crate) product: f64,
    pub(crate) pairs: f64,
    pub(crate) square: f64,
    pub(crate) count: f64,
}

impl Structure {
    /// Of residuals where the outline of what is pictured shows: what stands apart from it does not move it. Planes are rows of `stride`, which end with zeros: the change
    /// of the coverage `by` the place along x and y, 1/px; the residuals, which are left in units of `1 / inverse`, a grey value; and memory.
    pub(crate) fn of_outline(by: [&[f32]; 2], residual: &mut [f32], shows: &mut [f32], (stride, inverse): (usize, f64)) -> Self {
        of_outline(by, residual, shows, (stride, inverse as f32))
    }

    /// Of all residuals that count: rows of `stride`, which end with zeros; `ones` is one for each that counts, and zero elsewhere, as the residual there.
    pub(crate) fn of_all(residual: &[f32], ones: &[f32], stride: usize) -> Self {
        of_all(residual, ones, stride)
    }

    /// Of a square of `side` px whose rows of `stride` end with zeros: all its residuals count.
    pub(crate) fn of_whole(residual: &[f32], (side, stride): (usize, usize)) -> Self {
        let (product, square) = of_whole(residual, stride);
        Self { product, square, pairs: (2 * side * (side - 1)) as f64, count: (side * side) as f64 }
    }

    /// Whether there is more than noise has, and than `most`, the root of the covariance of neighbours, in units of half the contrast: a lens, a
    /// print or a light that is not even leave some.
    pub(crate) fn is_no_noise(&self, most: f64) -> bool {
        self.covariance() > most * most && self.significance() > SIGNIFICANT
    }

    /// Whether the residuals are white noise, as far as neighbours tell.
    pub(crate) fn is_white(&self) -> bool {
        self.significance() < WHITE
    }

    /// How much larger than for white noise the variance of what is estimated from many of them is, where their correlation falls by a factor from pixel to pixel along both axes.
    pub(crate) fn spread(&self) -> f64 {
        let correlation = (self.covariance() / (self.square / self.count)).clamp(0.0, STRONGEST);
        ((1.0 + correlation) / (1.0 - correlation)).powi(2)
    }

    /// The covariance of neighbours, in units of half the contrast squared.
    fn covariance(&self) -> f64 {
        self.product / self.pairs
    }

    /// How many standard deviations it has where residuals are white noise.
    fn significance(&self) -> f64 {
        self.covariance() * self.pairs.sqrt() / (self.square / self.count)
    }
}

impl Residuals {
    /// As [`Structure::is_no_noise`].
    pub(crate) fn are_no_noise(&self, most: f64) -> bool {
        self.structure().is_no_noise(most)
    }

    /// Whether they are white noise, as far as neighbours tell.
    pub(crate) fn are_white(&self) -> bool {
        self.structure().is_white()
    }

    fn structure(&self) -> Structure {
        let (side, r, mut sums) = (self.side, &self.grey, Structure::default());
        for (index, here) in r.iter().map(|here| f64::from(*here)).enumerate().filter(|(_, here)| !here.is_nan()) {
            sums.square += here * here;
            sums.count += 1.0;
            let right = r.get(index + 1).filter(|_| (index + 1) % side != 0);
            for beside in [right, r.get(index + side)].into_iter().flatten().filter(|beside| !beside.is_nan()) {
                sums.product += here * f64::from(*beside);
                sums.pairs += 1.0;
            }
        }
        sums
    }
}

#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn of_outline([by_x, by_y]: [&[f32]; 2], residual: &mut [f32], shows: &mut [f32], (stride, inverse): (usize, f32)) -> Structure {
    for (((r, shows), by_x), by_y) in residual.iter_mut().zip(&mut *shows).zip(by_x).zip(by_y) {
        *shows = if by_x * by_x + by_y * by_y > SHOWS * SHOWS { 1.0 } else { 0.0 };
        *r *= *shows * inverse;
    }
    Structure {
        product: shifted(residual, 1) + shifted(residual, stride),
        pairs: shifted(shows, 1) + shifted(shows, stride),
        square: shifted(residual, 0),
        count: shifted(shows, 0),
    }
}

#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn of_all(residual: &[f32], ones: &[f32], stride: usize) -> Structure {
    Structure {
        product: shifted(residual, 1) + shifted(residual, stride),
        pairs: shifted(ones, 1) + shifted(ones, stride),
        square: shifted(residual, 0),
        count: shifted(ones, 0),
    }
}

#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn of_whole(residual: &[f32], stride: usize) -> (f64, f64) {
    (shifted(residual, 1) + shifted(residual, stride), shifted(residual, 0))
}

/// The sum of the products of values with those `by` further on.
#[inline(always)]
fn shifted(values: &[f32], by: usize) -> f64 {
    let mut sums = [0.0_f32; WIDE];
    for (here, there) in values.chunks_exact(WIDE).zip(values[by..].chunks_exact(WIDE)) {
        for lane in 0..WIDE {
            sums[lane] += here[lane] * there[lane];
        }
    }
    let done = (values.len() - by) / WIDE * WIDE;
    let rest: f32 = values[done..].iter().zip(&values[done + by..]).map(|(here, there)| here * there).sum();
    sum(&sums) + f64::from(rest)
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;

    #[test]
    fn lanes_add_up_what_one_by_one_is_added_up() {
        let mut rng = ChaCha8Rng::seed_from_u64(7);
        for (side, stride) in [(15, 16), (21, 32), (47, 48)] {
            let mut planes = [(); 3].map(|()| vec![0.0_f32; side * stride]);
            for plane in &mut planes {
                plane.chunks_exact_mut(stride).for_each(|row| row[..side].fill_with(|| rng.random_range(-0.08..0.08)));
            }
            let [by_x, by_y, residual] = planes;
            let whole = residual.chunks_exact(stride).flat_map(|row| &row[..side]).copied().collect();
            let (whole, found) = (Residuals { grey: whole, side }.structure(), Structure::of_whole(&residual, (side, stride)));
            assert_eq!((found.pairs, found.count), (whole.pairs, whole.count));
            assert!((found.product - whole.product).abs() < 1e-6 * whole.square && (found.square / whole.square - 1.0).abs() < 1e-6);
            let shows = |at: usize| by_x[at].hypot(by_y[at]) > SHOWS;
            let of = |index: usize| (index / side * stride + index % side, residual[index / side * stride + index % side] * 2.5);
            let grey = (0..side * side).map(of).map(|(at, r)| if shows(at) { r } else { f32::NAN }).collect();
            let one = Residuals { grey, side }.structure();
            let found = Structure::of_outline([&by_x, &by_y], &mut residual.clone(), &mut vec![0.0; side * stride], (stride, 2.5));
            assert_eq!((found.pairs, found.count), (one.pairs, one.count));
            assert!(one.count > 50.0 && one.count < 0.9 * (side * side) as f64, "{one:?}");
            assert!(
                (found.product - one.product).abs() < 1e-6 * one.square && (found.square / one.square - 1.0).abs() < 1e-6,
                "{found:?} {one:?}"
            );
        }
    }
}
