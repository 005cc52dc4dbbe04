//! What tells two images apart without having both.

use std::fmt;
use std::str::FromStr;

use calibench_model::Image;
use calibench_model::image::level;
use rayon::prelude::*;

/// How many sums are kept.
const SUMS: usize = 8;
/// Pixels that are taken together,
const WIDE: usize = 512;
/// and those of a part, whose sums 32 bits hold.
const PART: usize = 1 << 16;
/// RMS difference of two renders of one image, fraction of full scale: other machines round a few grey values the other way.
const SAME: f64 = 0.1 / 255.0;

/// The size of an image and eight sums over its grey values as its file holds them, each pixel added or taken away by a fixed rule.
///
/// The mean square of the differences of such sums is, on average, the sum of the squares of the differences of the images.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fingerprint {
    width: usize,
    height: usize,
    /// Bits of a grey value in the file: 8 or 16.
    bits: u8,
    /// In units of 1/65535 of full scale.
    sums: [i64; SUMS],
}

impl Fingerprint {
    /// That of an image whose file has 8 or 16 bits.
    pub fn of(image: &Image, sixteen_bits: bool) -> Self {
        let (top, unit) = if sixteen_bits { (u16::MAX, 1) } else { (255, 257) };
        let parts = image.grey().par_chunks(PART).enumerate().map(|(part, greys)| signed_sums(greys, part * PART, top));
        let sums = parts.reduce(|| [0; SUMS], |a, b| std::array::from_fn(|bit| a[bit] + b[bit]));
        let bits = if sixteen_bits { 16 } else { 8 };
        Self { width: image.width(), height: image.height(), bits, sums: sums.map(|sum| sum * unit) }
    }

    /// Whether the file has 16 bits.
    pub fn is_deep(&self) -> bool {
        self.bits == 16
    }

    /// Whether `image` is the one of which this is the fingerprint: of the same size, and no more than a tenth of one of 255 grey levels (RMS) from it.
    pub fn is_of(&self, image: &Image) -> bool {
        let other = Self::of(image, self.is_deep());
        let square = |(a, b): (&i64, &i64)| ((a - b) as f64 / 65535.0).powi(2);
        let sum: f64 = self.sums.iter().zip(&other.sums).map(square).sum();
        let pixels = (self.width * self.height) as f64;
        (self.width, self.height) == (other.width, other.height) && sum / SUMS as f64 <= SAME * SAME * pixels
    }
}

/// The sums of the levels of a part of an image that begins with pixel `first`, of at most [`PART`] pixels.
#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2")))]
#[expect(clippy::needless_range_loop, reason = "arrays side by side, in loops that every instruction set compiles for itself")]
fn signed_sums(greys: &[f32], first: usize, top: u16) -> [i64; SUMS] {
    let (mut added, mut all) = ([0_u32; SUMS], 0_u32);
    let (mut levels, mut signs) = ([0_u32; WIDE], [0_u32; WIDE]);
    for (chunk, greys) in greys.chunks(WIDE).enumerate() {
        for i in 0..greys.len() {
            levels[i] = u32::from(level(greys[i], top));
        }
        levels[greys.len()..].fill(0);
        for i in 0..WIDE {
            signs[i] = mixed((first + chunk * WIDE + i) as u64) as u32;
        }
        // Sum after sum: so each is one plain loop over what stands in the fastest memory.
        for (bit, added) in added.iter_mut().enumerate() {
            let mut sum = 0;
            for i in 0..WIDE {
                sum += levels[i] & 0_u32.wrapping_sub(signs[i] >> bit & 1);
            }
            *added += sum;
        }
        for i in 0..WIDE {
            all += levels[i];
        }
    }
    // Those that were not added are taken away.
    let signed = |added: u32| 2 * i64::from(added) - i64::from(all);
    added.map(signed)
}

/// Bits of a number that look like chance (the finaliser of `SplitMix64`).
#[inline(always)]
fn mixed(number: u64) -> u64 {
    let z = number.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

impl fmt::Display for Fingerprint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}x{}x{}", self.width, self.height, self.bits)?;
        self.sums.iter().try_for_each(|sum| write!(f, " {sum}"))
    }
}

/// What is no fingerprint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NoFingerprint;

impl FromStr for Fingerprint {
    type Err = NoFingerprint;

    fn from_str(text: &str) -> Result<Self, NoFingerprint> {
        let mut words = text.split(' ');
        let size: Vec<usize> = words.next().into_iter().flat_map(|size| size.split('x')).filter_map(|side| side.parse().ok()).collect();
        let sums: Vec<i64> = words.map(str::parse).collect::<Result<_, _>>().map_err(|_| NoFingerprint)?;
        match (<[usize; 3]>::try_from(size), <[i64; SUMS]>::try_from(sums)) {
            (Ok([width, height, bits @ (8 | 16)]), Ok(sums)) => Ok(Self { width, height, bits: bits as u8, sums }),
            _ => Err(NoFingerprint),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noisy(seed: u64, noise: f32) -> Image<'static> {
        let chance = |x, y| (mixed(seed << 32 | (y * 200 + x) as u64) as f32 / u64::MAX as f32 - 0.5) * 3.46;
        Image::from_fn(200, 150, |x, y| 0.2 + 0.5 * f32::from(x > 90) + noise * chance(x, y))
    }

    #[test]
    fn an_image_is_known_again_and_no_other_is_taken_for_it() {
        for deep in [false, true] {
            let image = noisy(1, 0.01);
            let print = Fingerprint::of(&image, deep);
            assert_eq!((print.to_string().parse(), print.is_deep()), (Ok(print.clone()), deep));
            assert!(print.is_of(&image));
            // As written and read again.
            let top = if deep { 65535.0 } else { 255.0 };
            let mut read = image.clone();
            read.grey_mut().iter_mut().for_each(|grey| *grey = (*grey * top).round() / top);
            assert!(print.is_of(&read));
            // Another machine rounds a value in a thousand the other way.
            read.grey_mut().iter_mut().step_by(1000).for_each(|grey| *grey += 1.0 / 255.0);
            assert!(print.is_of(&read));
            assert!(!print.is_of(&noisy(2, 0.01)), "other noise");
            let mut moved = image.clone();
            moved.grey_mut().rotate_left(1);
            assert!(!print.is_of(&moved), "a shift");
            let mut brighter = image.clone();
            brighter.grey_mut().iter_mut().for_each(|grey| *grey += 1.5 / 255.0);
            assert!(!print.is_of(&brighter));
            assert!(!print.is_of(&Image::new(150, 200, image.grey().to_vec())), "another size");
        }
    }

    /// One pixel after the other, in more than one part and with a chunk that is not full.
    #[test]
    fn sums_are_those_of_single_pixels() {
        let image = Image::from_fn(701, 409, |x, y| (mixed((y * 701 + x) as u64) >> 40) as f32 / 1.6e7 - 0.02);
        assert!(image.grey().len() > PART);
        for (deep, top, unit) in [(false, 255, 257), (true, 65535, 1)] {
            let sum = |bit: usize| -> i64 {
                let signed = |(place, grey): (usize, &f32)| {
                    let value = i64::from(level(*grey, top)) * unit;
                    if mixed(place as u64) >> bit & 1 == 1 { value } else { -value }
                };
                image.grey().iter().enumerate().map(signed).sum()
            };
            assert_eq!(Fingerprint::of(&image, deep).sums, std::array::from_fn(sum));
        }
    }

    #[test]
    fn a_text_of_another_form_is_none() {
        for bad in ["", "1x2x8", "1x2x9 0 0 0 0 0 0 0 0", "1x2x8 0 0 0 0 0 0 0", "1x2x8 0 0 0 0 0 0 0 x", "1x8 0 0 0 0 0 0 0 0"] {
            assert_eq!(bad.parse::<Fingerprint>(), Err(NoFingerprint), "{bad}");
        }
    }
}
