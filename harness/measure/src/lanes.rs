//! Eight numbers side by side, and the functions of a blurred edge on them.
//!
//! Fixed lanes and no fused multiply-add: every instruction set gives the same bits.

/// Numbers that are worked on side by side.
pub(crate) const LANES: usize = 8;

/// [`LANES`] numbers.
pub(crate) type Lanes = [f64; LANES];

/// 1 / sqrt(2 pi).
pub(crate) const DENSITY: f64 = 0.398_942_280_401_432_7;

/// Chebyshev fit of `(1 + 2 z) exp(z^2) erfc(z)` for z from 0 to 6, as a polynomial in `(z - 2.2) / (z + 2.2)`.
///
/// The form is that of Shepherd & Laframboise 1981; the coefficients are fitted anew, to an error of erfc of 2e-11.
const ERFCX: [f64; 12] = [
    1.272_202_003_803_465_6,
    -0.107_240_134_171_330_16,
    -0.137_584_168_067_677_3,
    0.165_864_660_722_670_25,
    -0.078_075_001_148_982_94,
    0.007_246_483_845_188_968,
    0.008_801_242_128_272_933,
    -0.001_929_610_698_811_309_6,
    -0.001_404_860_254_400_953_4,
    0.000_235_981_215_064_303_46,
    0.000_300_129_978_811_988_1,
    6.196_591_499_427_724e-5,
];
const KNEE: f64 = 2.2;

/// Taylor's coefficients of the exponential: enough for 1e-11 within half of log 2.
const EXP: [f64; 10] =
    [1.0, 1.0, 0.5, 1.0 / 6.0, 1.0 / 24.0, 1.0 / 120.0, 1.0 / 720.0, 1.0 / 5040.0, 1.0 / 40320.0, 1.0 / 362_880.0];

/// Adding it leaves a whole number in the lowest bits.
const ROUND: f64 = 6_755_399_441_055_744.0;

/// `exp(-y)` for y >= 0, error 1e-11.
#[inline(always)]
pub(crate) fn exp_minus(y: &Lanes) -> Lanes {
    let mut result = [0.0; LANES];
    for i in 0..LANES {
        // Below the smallest normal number nothing is left that matters.
        let x = -(if y[i] < 700.0 { y[i] } else { 700.0 });
        let shifted = x * std::f64::consts::LOG2_E + ROUND;
        let whole = shifted - ROUND;
        let r = (x - whole * 0.693_147_180_369_123_8) - whole * 1.908_214_929_270_587_7e-10;
        let mut p = EXP[9];
        for c in EXP[..9].iter().rev() {
            p = p * r + c;
        }
        result[i] = p * f64::from_bits(shifted.to_bits().wrapping_add(1023) << 52);
    }
    result
}

/// For x in units of the blur: the blurred unit step `2 Phi(x) - 1` (from -1 to 1) and `exp(-x^2 / 2)`.
#[inline(always)]
pub(crate) fn step(x: &Lanes) -> (Lanes, Lanes) {
    let mut half = [0.0; LANES];
    for i in 0..LANES {
        half[i] = 0.5 * x[i] * x[i];
    }
    let bell = exp_minus(&half);
    let mut edge = [0.0; LANES];
    for i in 0..LANES {
        let z = x[i].abs() * std::f64::consts::FRAC_1_SQRT_2;
        // One division for both quotients.
        let (above, beyond) = (z + KNEE, 1.0 + 2.0 * z);
        let inverse = 1.0 / (above * beyond);
        let q = (z - KNEE) * beyond * inverse;
        let mut p = ERFCX[11];
        for c in ERFCX[..11].iter().rev() {
            p = p * q + c;
        }
        edge[i] = (1.0 - bell[i] * p * above * inverse).copysign(x[i]);
    }
    (edge, bell)
}

#[cfg(test)]
mod tests {
    use super::*;
    use statrs::function::erf::erf;

    #[test]
    fn functions_agree_with_another_library() {
        for index in -4000..4000 {
            let x = f64::from(index) * 0.011_3;
            let (edge, bell) = step(&[x; LANES]);
            assert!((edge[3] - erf(x * std::f64::consts::FRAC_1_SQRT_2)).abs() < 5e-11, "{x}");
            assert!((bell[5] - (-0.5 * x * x).exp()).abs() < 2e-11, "{x}");
        }
        assert!(exp_minus(&[1e9; LANES])[0] < 1e-300 && exp_minus(&[0.0; LANES])[0] == 1.0);
    }
}
