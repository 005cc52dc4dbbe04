//! Interpolation kernels, and their weights.

use std::fmt;
use std::str::FromStr;

use crate::cell::parted;

/// Steps of a table of weights between two pixels; within a step weights are interpolated by parabolas, which is right to 1e-7.
const STEPS: usize = 128;

/// How a grey value between pixels is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kernel {
    /// Of the 2 x 2 pixels around, linearly.
    Linear,
    /// Of 4 x 4 pixels, by Keys's cubic with slope -1/2 at one pixel, which is exact for parabolas.
    Cubic,
    /// Of 6 x 6 pixels, by a sinc under a wider sinc, made to sum up to one.
    Lanczos3,
    /// The same of 8 x 8 pixels.
    Lanczos4,
    /// Where the picture shrinks the mean over the area of a pixel, elsewhere linearly.
    Area,
    /// The quintic spline through all pixels: ramps, and polynomials up to the fifth degree, are exact.
    Spline,
}

impl Kernel {
    /// All, in the order of lists.
    pub const ALL: [Self; 6] = [Self::Linear, Self::Cubic, Self::Lanczos3, Self::Lanczos4, Self::Area, Self::Spline];

    /// Its name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Linear => "linear",
            Self::Cubic => "cubic",
            Self::Lanczos3 => "lanczos3",
            Self::Lanczos4 => "lanczos4",
            Self::Area => "area",
            Self::Spline => "spline",
        }
    }

    /// Rows, and columns, of pixels that take part.
    pub const fn taps(self) -> usize {
        match self {
            Self::Linear | Self::Area => 2,
            Self::Cubic => 4,
            Self::Lanczos3 | Self::Spline => 6,
            Self::Lanczos4 => 8,
        }
    }

    /// The weight of a pixel at a distance from the place, px; those of a Lanczos kernel are still to be divided by their sum.
    fn at(self, distance: f64) -> f64 {
        let x = distance.abs();
        match self {
            Self::Linear | Self::Area => (1.0 - x).max(0.0),
            Self::Cubic if x <= 1.0 => 1.0 + x * x * (1.5 * x - 2.5),
            Self::Cubic if x < 2.0 => 2.0 + x * (-4.0 + x * (2.5 - 0.5 * x)),
            Self::Cubic => 0.0,
            Self::Lanczos3 => windowed_sinc(x, 3.0),
            Self::Lanczos4 => windowed_sinc(x, 4.0),
            Self::Spline => quintic(x),
        }
    }

    /// The weights of the pixels around a place `fraction` (0 to 1) behind a pixel, which is number `taps / 2 - 1` of them.
    pub fn weights(self, fraction: f64) -> Vec<f64> {
        let before = (self.taps() / 2 - 1) as f64;
        let mut weights: Vec<f64> = (0..self.taps()).map(|tap| self.at(tap as f64 - before - fraction)).collect();
        if matches!(self, Self::Lanczos3 | Self::Lanczos4) {
            let sum: f64 = weights.iter().sum();
            weights.iter_mut().for_each(|weight| *weight /= sum);
        }
        weights
    }
}

impl fmt::Display for Kernel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Kernel {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let known = || Self::ALL.map(Self::name).join(", ");
        Self::ALL.into_iter().find(|kernel| kernel.name() == name).ok_or_else(|| format!("no kernel `{name}`; expected one of {}", known()))
    }
}

fn sinc(x: f64) -> f64 {
    let angle = std::f64::consts::PI * x;
    if angle.abs() < 1e-8 { 1.0 } else { angle.sin() / angle }
}

fn windowed_sinc(x: f64, reach: f64) -> f64 {
    if x < reach { sinc(x) * sinc(x / reach) } else { 0.0 }
}

/// The B-spline of the fifth degree.
fn quintic(x: f64) -> f64 {
    // Sum over k of (-1)^k (6 over k) (x + 3 - k)^5 / 5!, of what is positive.
    let binomial = [1.0, 6.0, 15.0, 20.0, 15.0, 6.0];
    // On the falling side fewer terms are there, and nothing cancels.
    let positive = |k: usize| (3.0 - x - k as f64).max(0.0);
    let terms = binomial.iter().enumerate().map(|(k, many)| if k % 2 == 0 { *many } else { -many } * positive(k).powi(5));
    terms.sum::<f64>() / 120.0
}

/// The weights of a kernel in [`STEPS`] steps between two pixels, as parabolas about the middle of each: `lanes` of them, of which the first
/// [`Kernel::taps`] times `repeated` are not zero, each for `repeated` channels.
pub(crate) struct Table(Vec<f32>);

impl Table {
    pub(crate) fn new(kernel: Kernel, repeated: usize, lanes: usize) -> Self {
        let mut table = Vec::with_capacity(STEPS * 3 * lanes);
        for step in 0..STEPS {
            let [begin, middle, end] = [0.0, 0.5, 1.0].map(|part| kernel.weights((step as f64 + part) / STEPS as f64));
            let parabola = |power: usize, lane: usize| {
                let of = |weights: &[f64]| weights.get(lane / repeated).copied().unwrap_or(0.0);
                let (a, b, c) = (of(&begin), of(&middle), of(&end));
                [b, c - a, 2.0 * (a + c) - 4.0 * b][power] as f32
            };
            table.extend((0..3 * lanes).map(|i| parabola(i / lanes, i % lanes)));
        }
        Self(table)
    }

    /// The table for its number of lanes.
    #[inline(always)]
    pub(crate) fn of<const N: usize>(&self) -> Lanes<'_, N> {
        Lanes(self.0.as_chunks::<N>().0.as_chunks::<3>().0)
    }
}

/// A table of `N` lanes.
#[derive(Clone, Copy)]
pub(crate) struct Lanes<'t, const N: usize>(&'t [[[f32; N]; 3]]);

impl<const N: usize> Lanes<'_, N> {
    /// The weights within a step, `off` its middle.
    #[inline(always)]
    pub(crate) fn at(self, (step, off): (u32, f32)) -> [f32; N] {
        let mut weights = [0.0; N];
        if let Some([a, b, c]) = self.0.get(step as usize) {
            for lane in 0..N {
                weights[lane] = a[lane] + off * (b[lane] + off * c[lane]);
            }
        }
        weights
    }
}

/// The step of a fraction from 0 to 1, and how far it is off its middle.
#[inline(always)]
pub(crate) fn step(fraction: f32) -> (u32, f32) {
    let (whole, part) = parted(fraction * STEPS as f32);
    // A whole pixel is the end of the last step.
    if whole as u32 >= STEPS as u32 { (STEPS as u32 - 1, 0.5) } else { (whole as u32, part - 0.5) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The moments of weights about the place: 1, 0, 0, ... up to the degree that a kernel is exact for.
    fn moment(kernel: Kernel, fraction: f64, power: i32) -> f64 {
        let before = (kernel.taps() / 2 - 1) as f64;
        kernel.weights(fraction).iter().enumerate().map(|(tap, weight)| weight * (tap as f64 - before - fraction).powi(power)).sum()
    }

    #[test]
    fn weights_sum_up_to_one_and_place_what_they_can() {
        for kernel in Kernel::ALL {
            for fraction in [0.0, 0.13, 0.5, 0.77, 1.0] {
                assert!((moment(kernel, fraction, 0) - 1.0).abs() < 1e-14, "{kernel} {fraction}");
                let exact = match kernel {
                    // The spline's own moments are those of its smoothing, symmetric to the fifth.
                    Kernel::Linear | Kernel::Area | Kernel::Spline => 1,
                    Kernel::Cubic => 2,
                    // Interpolates sines, not ramps.
                    Kernel::Lanczos3 | Kernel::Lanczos4 => 0,
                };
                for power in 1..=exact {
                    assert!(moment(kernel, fraction, power).abs() < 1e-14, "{kernel} {fraction} {power}");
                }
            }
        }
        let off = moment(Kernel::Lanczos3, 0.25, 1).abs();
        assert!(off > 1e-3 && off < 0.05, "{off}");
    }

    #[test]
    fn those_that_interpolate_keep_pixels() {
        for kernel in Kernel::ALL.into_iter().filter(|kernel| *kernel != Kernel::Spline) {
            let weights = kernel.weights(0.0);
            let middle = kernel.taps() / 2 - 1;
            for (tap, weight) in weights.iter().enumerate() {
                assert!((weight - f64::from(u8::from(tap == middle))).abs() < 1e-15, "{kernel}: {weights:?}");
            }
        }
        // 66, 26 and 1 of 120.
        let found = Kernel::Spline.weights(0.0);
        for (weight, expected) in found.iter().zip([1.0, 26.0, 66.0, 26.0, 1.0, 0.0]) {
            assert!((120.0 * weight - expected).abs() < 1e-12, "{found:?}");
        }
    }

    #[test]
    fn a_table_is_as_good_as_the_formula() {
        for kernel in Kernel::ALL {
            let table = Table::new(kernel, 1, 8);
            for i in 0..=5000_u16 {
                let fraction = f32::from(i) / 5000.0;
                let expected = kernel.weights(f64::from(fraction));
                let found = table.of::<8>().at(step(fraction));
                for (tap, weight) in found.iter().enumerate() {
                    let expected = expected.get(tap).copied().unwrap_or(0.0);
                    assert!((f64::from(*weight) - expected).abs() < 3e-7, "{kernel} at {fraction}: {weight} {expected}");
                }
            }
        }
    }

    #[test]
    fn names_lead_to_kernels() {
        assert!(Kernel::ALL.into_iter().all(|kernel| kernel.name().parse() == Ok(kernel)));
        assert!("lanczos".parse::<Kernel>().unwrap_err().contains("lanczos3"));
    }
}
