//! Sixteen numbers of single precision side by side, and the functions of a blurred edge on them: see [`crate::lanes`].

use crate::lanes::{ERFCX, KNEE};

/// Numbers that are worked on side by side.
pub(super) const WIDE: usize = 16;

/// [`WIDE`] numbers.
pub(super) type Wide = [f32; WIDE];

const EXP: [f32; 7] = [1.0, 1.0, 0.5, 1.0 / 6.0, 1.0 / 24.0, 1.0 / 120.0, 1.0 / 720.0];
/// Adding it leaves a whole number in the lowest bits.
const ROUND: f32 = 12_582_912.0;

/// `exp(-y)` for y >= 0, error 2e-7.
#[inline(always)]
pub(super) fn exp_minus(y: &Wide) -> Wide {
    let mut result = [0.0; WIDE];
    for i in 0..WIDE {
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

/// For x in units of the blur: the blurred unit step `2 Phi(x) - 1`, error 5e-7.
#[inline(always)]
pub(super) fn step(x: &Wide) -> Wide {
    let mut half = [0.0; WIDE];
    for i in 0..WIDE {
        half[i] = 0.5 * x[i] * x[i];
    }
    let bell = exp_minus(&half);
    let mut edge = [0.0; WIDE];
    for i in 0..WIDE {
        let z = x[i].abs() * std::f32::consts::FRAC_1_SQRT_2;
        let (above, beyond) = (z + KNEE as f32, 1.0 + 2.0 * z);
        let inverse = 1.0 / (above * beyond);
        let q = (z - KNEE as f32) * beyond * inverse;
        let mut p = ERFCX[9] as f32;
        for c in ERFCX[..9].iter().rev() {
            p = p * q + *c as f32;
        }
        edge[i] = (1.0 - bell[i] * p * above * inverse).copysign(x[i]);
    }
    edge
}

#[cfg(test)]
mod tests {
    use super::*;
    use statrs::function::erf::erf;

    #[test]
    fn functions_agree_with_another_library() {
        for index in -4000..4000 {
            let x = index as f32 * 0.011_3;
            let (edge, bell) = (step(&[x; WIDE]), exp_minus(&[0.5 * x * x; WIDE]));
            let x = f64::from(x);
            assert!((f64::from(edge[3]) - erf(x * std::f64::consts::FRAC_1_SQRT_2)).abs() < 5e-7, "{x}");
            assert!((f64::from(bell[5]) - (-0.5 * x * x).exp()).abs() < 2e-7, "{x}");
        }
        assert!(exp_minus(&[1e9; WIDE])[0] < 1e-37 && exp_minus(&[0.0; WIDE])[0] == 1.0);
    }
}
