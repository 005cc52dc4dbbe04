//! Numbers side by side, and the functions of a blurred edge on them: see [`crate::lanes`].
//!
//! Fits are worked out in single precision. In double precision the same lines are tested.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use crate::lanes::{ERFCX, KNEE};

/// Numbers of single precision that are worked on side by side.
pub(super) const WIDE: usize = 16;

/// [`WIDE`] numbers.
pub(super) type Wide = [f32; WIDE];

/// A number of either precision.
pub(super) trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + PartialOrd
{
    fn of(value: f64) -> Self;
    fn magnitude(self) -> Self;
    fn signed_as(self, other: Self) -> Self;
    /// `exp(-y)` for y >= 0.
    fn exp_minus<const N: usize>(y: &[Self; N]) -> [Self; N];
}

const EXP: [f32; 7] = [1.0, 1.0, 0.5, 1.0 / 6.0, 1.0 / 24.0, 1.0 / 120.0, 1.0 / 720.0];
/// Adding it leaves a whole number in the lowest bits.
const ROUND: f32 = 12_582_912.0;

impl Real for f32 {
    #[inline(always)]
    fn of(value: f64) -> Self {
        value as Self
    }

    #[inline(always)]
    fn magnitude(self) -> Self {
        self.abs()
    }

    #[inline(always)]
    fn signed_as(self, other: Self) -> Self {
        self.copysign(other)
    }

    /// Error 2e-7.
    #[inline(always)]
    fn exp_minus<const N: usize>(y: &[Self; N]) -> [Self; N] {
        let mut result = [0.0; N];
        for i in 0..N {
            let x = -(if y[i] < 87.0 { y[i] } else { 87.0 });
            let shifted = x * std::f32::consts::LOG2_E + ROUND;
            let whole = shifted - ROUND;
            // log 2 in two parts, the first with few bits.
            let r = (x - whole * 0.693_359_4) + whole * 2.121_944_4e-4;
            let mut p = EXP[6];
            for c in EXP[..6].iter().rev() {
                p = p * r + c;
            }
            result[i] = p * f32::from_bits(shifted.to_bits().wrapping_add(127) << 23);
        }
        result
    }
}

#[cfg(test)]
impl Real for f64 {
    fn of(value: f64) -> Self {
        value
    }

    fn magnitude(self) -> Self {
        self.abs()
    }

    fn signed_as(self, other: Self) -> Self {
        self.copysign(other)
    }

    fn exp_minus<const N: usize>(y: &[Self; N]) -> [Self; N] {
        y.map(|y| crate::lanes::exp_minus(&[y; crate::lanes::LANES])[0])
    }
}

/// For x in units of the blur: the blurred unit step `2 Phi(x) - 1` (from -1 to 1) and `exp(-x^2 / 2)`. In single precision the errors are 5e-7 and 2e-7.
#[inline(always)]
pub(super) fn step<T: Real, const N: usize>(x: &[T; N]) -> ([T; N], [T; N]) {
    let mut half = [T::of(0.0); N];
    for i in 0..N {
        half[i] = T::of(0.5) * x[i] * x[i];
    }
    let bell = T::exp_minus(&half);
    let mut edge = [T::of(0.0); N];
    for i in 0..N {
        let z = x[i].magnitude() * T::of(std::f64::consts::FRAC_1_SQRT_2);
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

#[cfg(test)]
mod tests {
    use super::*;
    use statrs::function::erf::erf;

    #[test]
    fn functions_agree_with_another_library() {
        for index in -4000..4000 {
            let x = index as f32 * 0.011_3;
            let (edge, bell) = step(&[x; WIDE]);
            let x = f64::from(x);
            assert!((f64::from(edge[3]) - erf(x * std::f64::consts::FRAC_1_SQRT_2)).abs() < 5e-7, "{x}");
            assert!((f64::from(bell[5]) - (-0.5 * x * x).exp()).abs() < 2e-7, "{x}");
        }
        assert!(f32::exp_minus(&[1e9; WIDE])[0] < 1e-37 && f32::exp_minus(&[0.0; WIDE])[0] == 1.0);
    }
}
