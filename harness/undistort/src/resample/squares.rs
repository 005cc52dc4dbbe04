//! The loops over squares: for each kernel, number of channels and kind of level one that is compiled for several instruction sets.

use super::job::Job;
use super::pairs::{area, linear, linear_by_channels};
use super::taps::taps;
use crate::kernel::Kernel;
use crate::picture::Sample;

/// Fills rows of squares, as many as they have.
pub(super) type Squares<T> = fn(&Job<'_, T>, &mut [T]);

/// Levels for which there are loops.
pub trait Sampled: Sized {
    /// The loop of a kernel for so many channels, if there is one.
    #[expect(private_interfaces, reason = "nobody else can call it, nor need to")]
    fn squares(kernel: Kernel, channels: usize) -> Option<Squares<Self>>;
}

macro_rules! loops {
    ($level:ty: $($name:ident = $inner:ident<$($number:literal),*>;)*) => {
        $(
            // The first target that the machine has is taken.
            #[cfg_attr(
                not(any(test, debug_assertions)),
                multiversion::multiversion(targets("x86_64+avx512f+avx512bw+avx512vl+avx512dq", "x86_64+avx2"))
            )]
            fn $name(job: &Job<'_, $level>, into: &mut [$level]) {
                $inner::<$level, $($number),*>(job, into);
            }
        )*
    };
}

macro_rules! sampled {
    ($level:ty, $module:ident) => {
        mod $module {
            use super::*;

            loops! {
                $level:
                linear_grey = linear<1, 1, 2>;
                linear_colour = linear_by_channels<3>;
                area_grey = area<1>;
                area_colour = area<3>;
                cubic_grey = taps<1, 4, 4>;
                cubic_colour = taps<3, 4, 12>;
                lanczos3_grey = taps<1, 6, 8>;
                lanczos3_colour = taps<3, 6, 24>;
                lanczos4_grey = taps<1, 8, 8>;
                lanczos4_colour = taps<3, 8, 24>;
            }

            impl Sampled for $level {
                #[expect(private_interfaces, reason = "as in the trait")]
                fn squares(kernel: Kernel, channels: usize) -> Option<Squares<Self>> {
                    Some(match (kernel, channels) {
                        (Kernel::Linear, 1) => linear_grey,
                        (Kernel::Linear, 3) => linear_colour,
                        (Kernel::Area, 1) => area_grey,
                        (Kernel::Area, 3) => area_colour,
                        (Kernel::Cubic, 1) => cubic_grey,
                        (Kernel::Cubic, 3) => cubic_colour,
                        (Kernel::Lanczos3, 1) => lanczos3_grey,
                        (Kernel::Lanczos3, 3) => lanczos3_colour,
                        (Kernel::Lanczos4, 1) => lanczos4_grey,
                        (Kernel::Lanczos4, 3) => lanczos4_colour,
                        _ => return None,
                    })
                }
            }
        }
    };
}

sampled!(u8, bytes);
sampled!(u16, words);

loops! {
    f32:
    linear_plane = linear<1, 1, 2>;
    area_plane = area<1>;
    cubic_plane = taps<1, 4, 4>;
    six_plane = taps<1, 6, 8>;
    eight_plane = taps<1, 8, 8>;
}

impl Sampled for f32 {
    #[expect(private_interfaces, reason = "as in the trait")]
    fn squares(_: Kernel, _: usize) -> Option<Squares<Self>> {
        None
    }
}

/// The loop for a plane, which may hold the coefficients of a spline.
pub(super) fn of_plane(kernel: Kernel) -> Squares<f32> {
    match kernel {
        Kernel::Linear => linear_plane,
        Kernel::Area => area_plane,
        Kernel::Cubic => cubic_plane,
        Kernel::Lanczos3 | Kernel::Spline => six_plane,
        Kernel::Lanczos4 => eight_plane,
    }
}

/// Levels that can be resampled: of 8 and 16 bits, and single precision.
pub trait Level: Sample + Sampled {}

impl Level for u8 {}
impl Level for u16 {}
impl Level for f32 {}
