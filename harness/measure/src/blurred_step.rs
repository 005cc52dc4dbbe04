//! The step of an edge under a Gaussian blur, and the Gaussian itself, for numbers side by side.

use std::f64::consts::{FRAC_1_SQRT_2, LOG2_E};

use crate::lanes::Real;

/// 1 / sqrt(2 pi).
pub(crate) const DENSITY: f64 = 0.398_942_280_401_432_7;

/// Chebyshev fit of `(1 + 2 z) exp(z^2) erfc(z)` for z from 0 to 6, as a polynomial in `(z - 3.4) / (z + 3.4)`.
///
/// The form is that of Shepherd & Laframboise 1981; the coefficients are fitted anew, to an error of erfc of 6e-10.
const ERFCX: [f64; 10] = [
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
const KNEE: f64 = 3.4;

/// Fit of `erf(x / sqrt 2) / x` for x up to [`END`], numerator and denominator by powers of `x^2`: of the least greatest error of [`edge`], 2e-9.
const ERF: [[f64; 7]; 2] = [
    [
        0.797_884_574_184_388_7,
        0.066_085_915_400_243_08,
        0.009_694_983_310_280_497,
        0.000_350_090_568_836_792,
        1.750_979_584_336_507_4e-5,
        1.221_513_058_024_661_6e-7,
        -1.126_620_550_120_312_2e-10,
    ],
    [
        1.0,
        0.249_493_210_380_245_55,
        0.028_732_762_700_889_85,
        0.001_966_739_597_128_683_6,
        8.441_854_356_487_078e-5,
        2.121_709_762_466_304_8e-6,
        1.237_637_404_508_428e-9,
    ],
];
/// From here on the step is over but for 6e-10.
const END: f64 = 6.2;

/// Taylor's coefficients of the exponential.
const EXP: [f64; 9] = [1.0, 1.0, 0.5, 1.0 / 6.0, 1.0 / 24.0, 1.0 / 120.0, 1.0 / 720.0, 1.0 / 5040.0, 1.0 / 40320.0];

/// `exp(-y)` for y >= 0: error 2e-7 in single precision, 3e-10 in double.
#[inline(always)]
pub(crate) fn exp_minus<T: Real, const N: usize>(y: &[T; N]) -> [T; N] {
    let mut result = [T::of(0.0); N];
    for i in 0..N {
        let x = -(if y[i] < T::LARGEST { y[i] } else { T::LARGEST });
        let shifted = x * T::of(LOG2_E) + T::ROUND;
        let whole = shifted - T::ROUND;
        let [high, low] = T::LOG_2;
        let r = (x - whole * high) - whole * low;
        let mut p = T::of(EXP[T::DEGREE]);
        for c in EXP[..T::DEGREE].iter().rev() {
            p = p * r + T::of(*c);
        }
        result[i] = p * T::power_of_two(shifted);
    }
    result
}

/// For x in units of the blur: the blurred unit step `2 Phi(x) - 1` (from -1 to 1) and `exp(-x^2 / 2)`.
///
/// Errors: 5e-7 and 2e-7 in single precision, 1e-9 and 3e-10 in double.
#[inline(always)]
pub(crate) fn step<T: Real, const N: usize>(x: &[T; N]) -> ([T; N], [T; N]) {
    let mut half = [T::of(0.0); N];
    for i in 0..N {
        half[i] = T::of(0.5) * x[i] * x[i];
    }
    let bell = exp_minus(&half);
    let mut edge = [T::of(0.0); N];
    for i in 0..N {
        let z = x[i].magnitude() * T::of(FRAC_1_SQRT_2);
        // One division for both quotients.
        let (above, beyond) = (z + T::of(KNEE), T::of(1.0) + T::of(2.0) * z);
        let inverse = T::of(1.0) / (above * beyond);
        let q = (z - T::of(KNEE)) * beyond * inverse;
        let mut p = T::of(ERFCX[9]);
        for c in ERFCX[..9].iter().rev() {
            p = p * q + T::of(*c);
        }
        edge[i] = (T::of(1.0) - bell[i] * p * above * inverse).signed_as(x[i]);
    }
    (edge, bell)
}

/// As [`step`] the step alone, in half the time.
///
/// Errors: 5e-7 in single precision, 3e-9 in double.
#[inline(always)]
pub(crate) fn edge<T: Real, const N: usize>(x: &[T; N]) -> [T; N] {
    let mut edge = [T::of(0.0); N];
    for i in 0..N {
        let [above, below] = quotient(x[i]);
        edge[i] = above / below;
    }
    edge
}

/// The product of two steps, with one division.
#[inline(always)]
pub(crate) fn edges<T: Real, const N: usize>(x: &[T; N], y: &[T; N]) -> [T; N] {
    let mut edges = [T::of(0.0); N];
    for i in 0..N {
        let ([above, below], [over, under]) = (quotient(x[i]), quotient(y[i]));
        edges[i] = (above * over) / (below * under);
    }
    edges
}

/// The step as a quotient.
#[inline(always)]
fn quotient<T: Real>(x: T) -> [T; 2] {
    let end = T::of(END);
    let x = if x < end { x } else { end };
    let x = if x > -end { x } else { -end };
    let square = x * x;
    let [mut above, mut below] = [T::of(ERF[0][6]), T::of(ERF[1][6])];
    for k in (0..6).rev() {
        above = above * square + T::of(ERF[0][k]);
        below = below * square + T::of(ERF[1][k]);
    }
    [x * above, below]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::{LANES, WIDE};
    use statrs::function::erf::erf;

    #[test]
    fn functions_agree_with_another_library_in_double_precision() {
        for index in -4000..4000 {
            let x = f64::from(index) * 0.011_3;
            let (alone, (edge, bell)) = (edge(&[x; LANES]), step(&[x; LANES]));
            assert!((edge[3] - erf(x * FRAC_1_SQRT_2)).abs() < 1e-9, "{x}");
            assert!((bell[5] - (-0.5 * x * x).exp()).abs() < 3e-10, "{x}");
            assert!((alone[2] - erf(x * FRAC_1_SQRT_2)).abs() < 3e-9, "{x}");
            let product = erf(x * FRAC_1_SQRT_2) * erf(0.3 * FRAC_1_SQRT_2);
            assert!((edges(&[0.3; LANES], &[x; LANES])[7] - product).abs() < 3e-9, "{x}");
        }
        assert!(exp_minus(&[1e9_f64; LANES])[0] < 1e-300 && exp_minus(&[0.0_f64; LANES])[0] == 1.0);
    }

    #[test]
    fn functions_agree_with_another_library_in_single_precision() {
        for index in -4000..4000 {
            let x = index as f32 * 0.011_3;
            let (alone, (edge, bell)) = (edge(&[x; WIDE]), step(&[x; WIDE]));
            let x = f64::from(x);
            assert!((f64::from(alone[9]) - erf(x * FRAC_1_SQRT_2)).abs() < 5e-7, "{x}");
            let product = erf(x * FRAC_1_SQRT_2) * erf(0.3 * FRAC_1_SQRT_2);
            assert!((f64::from(edges(&[x as f32; WIDE], &[0.3; WIDE])[4]) - product).abs() < 5e-7, "{x}");
            assert!((f64::from(edge[3]) - erf(x * FRAC_1_SQRT_2)).abs() < 5e-7, "{x}");
            assert!((f64::from(bell[5]) - (-0.5 * x * x).exp()).abs() < 2e-7, "{x}");
        }
        assert!(exp_minus(&[1e9_f32; WIDE])[0] < 1e-37 && exp_minus(&[0.0_f32; WIDE])[0] == 1.0);
    }
}
