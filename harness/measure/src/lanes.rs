//! Eight numbers side by side, and the functions of a blurred edge on them.
//!
//! Fixed lanes and no fused multiply-add: every instruction set gives the same bits.

/// Numbers that are worked on side by side.
pub(crate) const LANES: usize = 8;

/// [`LANES`] numbers.
pub(crate) type Lanes = [f64; LANES];

/// 1 / sqrt(2 pi).
pub(crate) const DENSITY: f64 = 0.398_942_280_401_432_7;

/// Chebyshev fit of `(1 + 2 z) exp(z^2) erfc(z)` for z from 0 to 6, as a polynomial in `(z - 3.4) / (z + 3.4)`.
///
/// The form is that of Shepherd & Laframboise 1981; the coefficients are fitted anew, to an error of erfc of 6e-10.
pub(crate) const ERFCX: [f64; 10] = [
    1.244_375_846_053_946_7,
    -0.139_610_989_764_242,
    -0.016_960_689_947_235_83,
    0.103_848_136_867_238_26,
    -0.116_987_945_056_996_36,
    0.085_362_955_825_145_44,
    -0.044_232_776_189_734_15,
    0.015_094_192_289_025_36,
    -0.003_423_261_916_757_26,
    -0.001_923_122_359_961_13,
];
pub(crate) const KNEE: f64 = 3.4;

/// Taylor's coefficients of the exponential: enough for 3e-10 within half of log 2.
const EXP: [f64; 9] = [1.0, 1.0, 0.5, 1.0 / 6.0, 1.0 / 24.0, 1.0 / 120.0, 1.0 / 720.0, 1.0 / 5040.0, 1.0 / 40320.0];

/// Adding it leaves a whole number in the lowest bits.
const ROUND: f64 = 6_755_399_441_055_744.0;

/// `exp(-y)` for y >= 0, error 3e-10.
#[inline(always)]
pub(crate) fn exp_minus(y: &Lanes) -> Lanes {
    let mut result = [0.0; LANES];
    for i in 0..LANES {
        // Below the smallest normal number nothing is left that matters.
        let x = -(if y[i] < 700.0 { y[i] } else { 700.0 });
        let shifted = x * std::f64::consts::LOG2_E + ROUND;
        let whole = shifted - ROUND;
        let r = (x - whole * 0.693_147_180_369_123_8) - whole * 1.908_214_929_270_587_7e-10;
        let mut p = EXP[8];
        for c in EXP[..8].iter().rev() {
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
        let mut p = ERFCX[9];
        for c in ERFCX[..9].iter().rev() {
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
            assert!((edge[3] - erf(x * std::f64::consts::FRAC_1_SQRT_2)).abs() < 1e-9, "{x}");
            assert!((bell[5] - (-0.5 * x * x).exp()).abs() < 3e-10, "{x}");
        }
        assert!(exp_minus(&[1e9; LANES])[0] < 1e-300 && exp_minus(&[0.0; LANES])[0] == 1.0);
    }
}
