//! Standard normal numbers by the row.
//!
//! Box and Muller's transform, written so that it runs in lanes: several times as fast as one number at a time, and the same bits on every
//! width of lanes. The radius comes of 31 bits, so that the tails end at 6.7 standard deviations.
//!
//! Source: Box & Muller 1958, A note on the generation of random normal deviates, Ann. Math. Stat. 29(2).

use std::f32::consts::{FRAC_PI_4, LN_2};

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::Rng;

const CHUNK: usize = 256;
const HALF: usize = CHUNK / 2;

/// Fills `normals` with independent standard normal numbers. A longer row begins with the numbers of a shorter one.
pub(super) fn fill_normal(rng: &mut ChaCha8Rng, normals: &mut [f32]) {
    let mut bytes = [0; 4 * CHUNK];
    let (chunks, rest) = normals.as_chunks_mut::<CHUNK>();
    for chunk in chunks {
        rng.fill_bytes(&mut bytes);
        transform(&bytes, chunk);
    }
    if !rest.is_empty() {
        let mut chunk = [0.0; CHUNK];
        rng.fill_bytes(&mut bytes);
        transform(&bytes, &mut chunk);
        rest.copy_from_slice(&chunk[..rest.len()]);
    }
}

#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn transform(bytes: &[u8; 4 * CHUNK], normals: &mut [f32; CHUNK]) {
    box_muller(bytes, normals);
}

#[inline(always)]
fn box_muller(bytes: &[u8; 4 * CHUNK], normals: &mut [f32; CHUNK]) {
    let (words, _) = bytes.as_chunks::<4>();
    let (radii, directions) = words.split_at(HALF);
    let (cosines, sines) = normals.split_at_mut(HALF);
    for i in 0..HALF {
        let r = radius(u32::from_le_bytes(radii[i]));
        let (cosine, sine) = direction(u32::from_le_bytes(directions[i]));
        cosines[i] = r * cosine;
        sines[i] = r * sine;
    }
}

/// sqrt(-2 ln u) of the uniform u in (0, 1] that `word` stands for.
#[inline(always)]
fn radius(word: u32) -> f32 {
    const TO_UNIT: f32 = 1.0 / (1_u32 << 31) as f32;
    let u = ((word >> 1) as i32 as f32 + 0.5) * TO_UNIT;
    (-2.0 * ln(u)).max(0.0).sqrt()
}

/// Natural logarithm of a positive normal number: ln(2^e m) with m from sqrt(1/2) to sqrt(2), whose logarithm is 2 artanh((m - 1) / (m + 1)).
#[inline(always)]
fn ln(u: f32) -> f32 {
    const BITS_OF_SQRT_HALF: i32 = std::f32::consts::FRAC_1_SQRT_2.to_bits() as i32;
    let bits = u.to_bits() as i32;
    let exponent = (bits - BITS_OF_SQRT_HALF) >> 23;
    let m = f32::from_bits((bits - (exponent << 23)) as u32);
    let s = (m - 1.0) / (m + 1.0);
    let z = s * s;
    let series = 1.0 + z * (1.0 / 3.0 + z * (1.0 / 5.0 + z * (1.0 / 7.0 + z * (1.0 / 9.0))));
    exponent as f32 * LN_2 + 2.0 * s * series
}

/// Cosine and sine of a uniform direction: an angle of the first octant of 29 bits, and three bits that say which octant it is mirrored to.
#[inline(always)]
fn direction(word: u32) -> (f32, f32) {
    const TO_OCTANT: f32 = FRAC_PI_4 / (1_u32 << 29) as f32;
    let angle = ((word >> 3) as i32 as f32 + 0.5) * TO_OCTANT;
    let z = angle * angle;
    let sine = angle * (1.0 - z / 6.0 * (1.0 - z / 20.0 * (1.0 - z / 42.0 * (1.0 - z / 72.0))));
    let cosine = 1.0 - z / 2.0 * (1.0 - z / 12.0 * (1.0 - z / 30.0 * (1.0 - z / 56.0 * (1.0 - z / 90.0))));
    let (x, y) = if word & 1 == 0 { (cosine, sine) } else { (sine, cosine) };
    let signed = |value: f32, bit: u32| f32::from_bits(value.to_bits() ^ (word >> bit << 31));
    (signed(x, 1), signed(y, 2))
}

#[cfg(test)]
mod tests {
    use rand_chacha::rand_core::SeedableRng;
    use statrs::distribution::{ContinuousCDF, Normal};

    use super::*;

    #[test]
    fn logarithm_and_direction_agree_with_the_library() {
        for word in (0..u32::MAX).step_by(65_537) {
            let u = (f64::from(word >> 1) + 0.5) / 2_f64.powi(31);
            let expected = (-2.0 * u.ln()).max(0.0).sqrt();
            assert!((f64::from(radius(word)) - expected).abs() < 3e-4, "{u}");
            let (x, y) = direction(word);
            assert!((f64::from(x).hypot(f64::from(y)) - 1.0).abs() < 3e-7);
            let angle = (f64::from(word >> 3) + 0.5) * std::f64::consts::FRAC_PI_4 / 2_f64.powi(29);
            let least = f64::from(x.abs().min(y.abs()));
            assert!((least - angle.sin()).abs() < 2e-7, "{angle}");
        }
    }

    #[test]
    fn ten_million_numbers_are_normal() {
        let mut normals = vec![0.0; 10_000_000];
        fill_normal(&mut ChaCha8Rng::seed_from_u64(3), &mut normals);
        let n = normals.len() as f64;
        let moment = |k: i32| normals.iter().map(|&z| f64::from(z).powi(k)).sum::<f64>() / n;
        // Moments of the normal distribution: variance of the k-th is (2k - 1)!! minus the square of the moment. Five standard errors.
        for (k, expected, variance) in [(1, 0.0, 1.0), (2, 1.0, 2.0), (3, 0.0, 15.0), (4, 3.0, 96.0), (6, 15.0, 10_170.0)] {
            let error = (moment(k) - expected).abs();
            assert!(error < 5.0 * f64::sqrt(variance / n), "moment {k}: {error}");
        }
        // Counts in bins against the distribution function, tails to 5 sigma: chi-square of 100 degrees of freedom.
        let normal = Normal::standard();
        let edges: Vec<f64> = (-50..=50).map(|i| f64::from(i) / 10.0).collect();
        let mut counts = vec![0_u64; edges.len() + 1];
        normals.iter().for_each(|&z| counts[((f64::from(z) * 10.0).ceil() as i64 + 50).clamp(0, 101) as usize] += 1);
        let cdf = |i: usize| if i == 0 { 0.0 } else { edges.get(i - 1).map_or(1.0, |&edge| normal.cdf(edge)) };
        let chi2: f64 = counts
            .iter()
            .enumerate()
            .map(|(i, &count)| {
                let expected = n * (cdf(i + 1) - cdf(i));
                (count as f64 - expected).powi(2) / expected
            })
            .sum();
        assert!(chi2 < 101.0 + 5.0 * 202_f64.sqrt(), "{chi2}");
    }

    #[test]
    fn lanes_of_any_width_give_the_same_bits() {
        let mut rng = ChaCha8Rng::seed_from_u64(9);
        for _ in 0..1000 {
            let (mut bytes, mut wide, mut plain) = ([0; 4 * CHUNK], [0.0; CHUNK], [0.0; CHUNK]);
            rng.fill_bytes(&mut bytes);
            transform(&bytes, &mut wide);
            box_muller(&bytes, &mut plain);
            assert_eq!(wide.map(f32::to_bits), plain.map(f32::to_bits));
        }
    }

    #[test]
    fn a_longer_row_begins_with_a_shorter_one() {
        let (mut short, mut long) = (vec![0.0; 300], vec![0.0; 1000]);
        fill_normal(&mut ChaCha8Rng::seed_from_u64(1), &mut short);
        fill_normal(&mut ChaCha8Rng::seed_from_u64(1), &mut long);
        assert_eq!(short, long[..300]);
    }
}
