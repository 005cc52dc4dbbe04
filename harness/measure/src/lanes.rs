//! Numbers side by side, in single or double precision.
//!
//! Fixed lanes and no fused multiply-add: every instruction set gives the same bits.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// Numbers of double precision that are worked on side by side.
pub(crate) const LANES: usize = 8;

/// [`LANES`] numbers.
pub(crate) type Lanes = [f64; LANES];

/// Numbers of single precision that are worked on side by side.
pub(crate) const WIDE: usize = 16;

/// [`WIDE`] numbers.
pub(crate) type Wide = [f32; WIDE];

/// Numbers of single precision that go through one calculation together: more than are worked on side by side, so that none waits for what it itself gives.
pub(crate) const BLOCK: usize = 2 * WIDE;

/// [`BLOCK`] numbers.
pub(crate) type Block = [f32; BLOCK];

/// The first or the second half.
#[inline(always)]
pub(crate) fn half_of(block: &Block, half: usize) -> &Wide {
    &block.as_chunks::<WIDE>().0[half & 1]
}

/// The `N` values from `first` on.
#[inline(always)]
pub(crate) fn side_by_side<T, const N: usize>(values: &[T], first: usize) -> &[T; N] {
    values[first..first + N].try_into().expect("a slice of that length")
}

/// The sum of all, in pairs, so that additions do not wait for each other.
#[inline(always)]
pub(crate) fn sum(lanes: &Wide) -> f64 {
    // Sums after each other are not to be worked out side by side, from numbers that are gathered one by one.
    let lanes = std::hint::black_box(*lanes);
    let mut sums = [0.0; WIDE / 2];
    for i in 0..WIDE / 2 {
        sums[i] = f64::from(lanes[i]) + f64::from(lanes[i + WIDE / 2]);
    }
    let mut width = WIDE / 2;
    while width > 1 {
        width /= 2;
        for i in 0..width {
            sums[i] += sums[i + width];
        }
    }
    sums[0]
}

/// Adds the products of two, each to its own.
#[inline(always)]
pub(crate) fn add_products(sum: &mut Wide, a: &Wide, b: &Wide) {
    // On a copy: in place, it would be asked each time whether the three overlap.
    let mut sums = *sum;
    for i in 0..WIDE {
        sums[i] += a[i] * b[i];
    }
    *sum = sums;
}

/// Each less `what`. A loop, as everywhere here: what is handed to `map` is not always compiled for the instructions around it, and then called.
#[inline(always)]
pub(crate) fn less<const N: usize>(lanes: &[f32; N], what: f32) -> [f32; N] {
    let mut less = [0.0; N];
    for i in 0..N {
        less[i] = lanes[i] - what;
    }
    less
}

/// A number of either precision, and what its exponential is made of.
pub(crate) trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + PartialOrd
    + Into<f64>
{
    /// Degree of the Taylor polynomial of the exponential: enough within half of log 2.
    const DEGREE: usize;
    /// The largest exponent: beyond it nothing is left that matters, and the result is still a normal number.
    const LARGEST: Self;
    /// Adding it leaves a whole number in the lowest bits.
    const ROUND: Self;
    /// log 2 in two parts, the first with few bits.
    const LOG_2: [Self; 2];
    /// The nearest number.
    fn of(value: f64) -> Self;
    /// The absolute value.
    fn magnitude(self) -> Self;
    /// The absolute value with the sign of `other`.
    fn signed_as(self, other: Self) -> Self;
    /// Two to the whole number that [`Self::ROUND`] was added to.
    fn power_of_two(shifted: Self) -> Self;
}

macro_rules! real {
    ($float:ty, degree $degree:expr, largest $largest:expr, round $round:expr, log_2 $log_2:expr, bias $bias:expr, mantissa $mantissa:expr) => {
        impl Real for $float {
            const DEGREE: usize = $degree;
            const LARGEST: Self = $largest;
            const ROUND: Self = $round;
            const LOG_2: [Self; 2] = $log_2;

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

            #[inline(always)]
            fn power_of_two(shifted: Self) -> Self {
                Self::from_bits(shifted.to_bits().wrapping_add($bias) << $mantissa)
            }
        }
    };
}

real!(f32, degree 6, largest 87.0, round 12_582_912.0, log_2 [0.693_359_4, -2.121_944_4e-4], bias 127, mantissa 23);
real!(f64, degree 8, largest 700.0, round 6_755_399_441_055_744.0, log_2 [0.693_147_180_369_123_8, 1.908_214_929_270_587_7e-10], bias 1023, mantissa 52);
