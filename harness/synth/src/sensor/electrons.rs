//! Light to electrons, in the terms of EMVA 1288: photon noise, dark signal, read noise and the patterns of the camera.
//!
//! The number of electrons is Poisson's. Where a pixel expects at least [`COUNTED`] of them, it is drawn as a normal number bent so that mean, variance
//! and skewness are Poisson's (Cornish and Fisher's expansion of the quantile), one number for the sum of shot and read noise unless the well may be
//! full; below, electrons are counted. At [`COUNTED`] the fourth cumulant is off by a third of its 1/100: beyond what 10^7 pixels show.
//! Where single electrons can be told apart in the output (read noise below half an electron and steps below four electrons), all are counted.
//!
//! Source: EMVA Standard 1288, release 4.0, section 2; Cornish & Fisher 1938, Moments and cumulants in the specification of distributions.

use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use super::poisson::poisson;
use super::{SensorError, check};

/// Expected electrons below which they are counted one by one.
pub(super) const COUNTED: f32 = 100.0;
/// A well is surely full, or surely not, this many standard deviations of its shot noise away from its brim.
const SURE: f64 = 7.0;

/// What a sensor does to light, per pixel; e- are electrons, DN the numbers of its converter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Electrons {
    /// Saturation capacity mu_e.sat, e-: more are not kept.
    pub full_well: f64,
    /// Electrons that an even grey value of 1 after exposure and filter collects, e-: quantum efficiency times photons.
    pub at_white: f64,
    /// Photo response non-uniformity PRNU1288: standard deviation of the response, as a fraction.
    pub prnu: f64,
    /// Mean dark signal mu_d: dark current times exposure time, e-. It has shot noise.
    pub dark: f64,
    /// Dark signal non-uniformity DSNU1288: standard deviation of an offset of the pixel, e-. It has none.
    pub dsnu: f64,
    /// Read noise sigma_d0, e-.
    pub read: f64,
    /// Standard deviation of what is common to a row of one image, e-.
    pub row: f64,
    /// System gain K, DN/e-; `None` takes a full well to the top of the converter.
    pub gain: Option<f64>,
    /// Black level mu_y.dark without the dark signal, DN.
    pub black_level: f64,
}

impl Electrons {
    /// A perfect sensor that has shot noise alone: `full_well` electrons at grey value 1.
    pub fn of_well(full_well: f64) -> Self {
        Self { full_well, at_white: full_well, prnu: 0.0, dark: 0.0, dsnu: 0.0, read: 0.0, row: 0.0, gain: None, black_level: 0.0 }
    }

    pub(super) fn check(&self, bits: Option<u32>) -> Result<(), SensorError> {
        check("the full well", self.full_well, 1.0, 1e9)?;
        check("the electrons at white", self.at_white, 1e-3, 1e9)?;
        check("PRNU", self.prnu, 0.0, 1.0)?;
        let of_electrons =
            [("the dark signal", self.dark), ("DSNU", self.dsnu), ("the read noise", self.read), ("the row noise", self.row)];
        of_electrons.into_iter().try_for_each(|(what, value)| check(what, value, 0.0, 1e6))?;
        match bits {
            None if self.gain.is_some() || self.black_level != 0.0 => Err(SensorError::NoConverter),
            None => Ok(()),
            Some(bits) => {
                check("the gain", self.gain.unwrap_or(1.0), 1e-9, 1e9)?;
                check("the black level", self.black_level, 0.0, top(bits) / 2.0)
            }
        }
    }

    /// Grey value of no electron and grey value per electron, fractions of full scale.
    pub(super) fn scale(&self, bits: Option<u32>) -> (f64, f64) {
        let Some(top) = bits.map(top) else { return (0.0, 1.0 / self.full_well) };
        let gain = self.gain.unwrap_or((top - self.black_level) / self.full_well);
        (self.black_level / top, gain / top)
    }

    pub(super) fn wells(&self, bits: Option<u32>) -> Wells {
        let (black, per_electron) = self.scale(bits);
        // The converter is at its top before the well is full: its brim does not show.
        let step = bits.map_or(0.0, |bits| 1.0 / top(bits));
        let brim = self.full_well;
        let darkest_brim = black + per_electron * (brim - SURE * (self.read + self.row + self.dsnu));
        let hidden = bits.is_some() && darkest_brim > 1.0 + step;
        let shot = SURE * (brim + SURE * SURE).sqrt();
        let told_apart = self.read < 0.5 && step < 4.0 * per_electron;
        let (below, above) = if hidden { (f32::INFINITY, f32::INFINITY) } else { ((brim - shot) as f32, (brim + shot) as f32) };
        Wells { read: self.read as f32, brim: brim as f32, below, above, counted: if told_apart { f32::INFINITY } else { COUNTED } }
    }
}

/// The highest number of a converter of `bits`.
pub(super) fn top(bits: u32) -> f64 {
    ((1_u64 << bits) - 1) as f64
}

/// The photosites of a row, ready to be filled.
#[derive(Clone, Copy)]
pub(super) struct Wells {
    read: f32,
    brim: f32,
    /// Expected electrons up to which the well is surely not full, and from which it surely is.
    below: f32,
    above: f32,
    /// Expected electrons below which Poisson's distribution is not to be approximated.
    counted: f32,
}

impl Wells {
    /// Expected electrons to electrons read out. `normals` are used once each; `full` becomes 1 where the well was full.
    pub(super) fn fill(&self, expected: &mut [f32], normals: &[f32], full: &mut [u8], counter: &mut ChaCha8Rng, read_out: &mut [f32]) {
        if draw(*self, expected, normals, full, read_out) {
            for i in 0..expected.len() {
                if self.is_counted(expected[i]) {
                    let electrons = self.electrons(expected[i], counter);
                    full[i] = u8::from(electrons > self.brim);
                    read_out[i] = electrons.min(self.brim) + self.read * normals[i];
                }
            }
        }
        expected.copy_from_slice(read_out);
    }

    /// How many electrons there are.
    fn electrons(&self, expected: f32, rng: &mut ChaCha8Rng) -> f32 {
        if expected < self.counted { poisson(expected, rng) } else { bent(expected, 0.0, StandardNormal.sample(rng)) }
    }

    /// Whether the number of electrons must be known by itself.
    #[inline(always)]
    fn is_counted(&self, expected: f32) -> bool {
        expected > 0.0 && expected < self.above && (expected < self.counted || expected > self.below)
    }
}

/// The sum of `expected` Poisson's electrons and of normal noise of variance `read2`, of the standard normal number `z`.
#[inline(always)]
fn bent(expected: f32, read2: f32, z: f32) -> f32 {
    let variance = (expected + read2).max(f32::MIN_POSITIVE);
    // The third cumulant is the shot noise's alone: skewness times standard deviation is expected / variance.
    let skew = expected / variance;
    // What the bend adds to the variance is taken away before.
    let sigma = (variance - skew * skew * (1.0 / 18.0)).max(0.0).sqrt();
    expected + sigma * z + skew * (z * z - 1.0) * (1.0 / 6.0)
}

/// Shot and read noise as one number in each pixel; returns whether there are pixels to be counted instead.
#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn draw(wells: Wells, expected: &[f32], normals: &[f32], full: &mut [u8], read_out: &mut [f32]) -> bool {
    let n = expected.len();
    let (normals, full, read_out) = (&normals[..n], &mut full[..n], &mut read_out[..n]);
    let read2 = wells.read * wells.read;
    let mut counted = 0;
    for i in 0..n {
        let (mean, z) = (expected[i], normals[i]);
        let brimming = mean >= wells.above;
        let drawn = bent(if brimming { 0.0 } else { mean }, read2, z);
        read_out[i] = if brimming { wells.brim + drawn } else { drawn };
        full[i] = u8::from(brimming);
        counted |= u32::from(wells.is_counted(mean));
    }
    counted != 0
}
