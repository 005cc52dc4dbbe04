//! The analogue-digital converter, and rounding to levels.

use super::Clipped;
use super::electrons::top;

/// A linear map of values to grey values that are rounded to levels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Converter {
    offset: f32,
    gain: f32,
    top: f32,
}

impl Converter {
    /// Value v becomes the level nearest to `black + v * scale`, a fraction of full scale, of 2^`bits` levels.
    pub(super) fn new(bits: u32, black: f64, scale: f64) -> Self {
        let top = top(bits);
        Self { offset: (black * top) as f32, gain: (scale * top) as f32, top: top as f32 }
    }

    /// Converts a row. A pixel whose level lies outside, or that is marked `full`, counts as clipped.
    pub(super) fn convert(&self, row: &mut [f32], full: &[u8]) -> Clipped {
        let (low, high) = levels(*self, row, full);
        Clipped { low: u64::from(low), high: u64::from(high) }
    }

    /// Converts a row in which nothing was full.
    pub(super) fn convert_plain(&self, row: &mut [f32]) -> Clipped {
        const NONE: [u8; 1024] = [0; 1024];
        row.chunks_mut(NONE.len()).map(|part| self.convert(part, &NONE[..part.len()])).sum()
    }
}

#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn levels(converter: Converter, row: &mut [f32], full: &[u8]) -> (u32, u32) {
    // Adding and taking away 1.5 * 2^23 rounds to the nearest whole number, ties to even, of all up to 2^22.
    const ROUND: f32 = 12_582_912.0;
    let Converter { offset, gain, top } = converter;
    let (mut low, mut high) = (0, 0);
    for (value, &full) in row.iter_mut().zip(full) {
        let number = *value * gain + offset;
        low += u32::from(number < -0.5);
        high += u32::from(number > top + 0.5 || full != 0);
        *value = (number.max(0.0).min(top) + ROUND - ROUND) / top;
    }
    (low, high)
}
