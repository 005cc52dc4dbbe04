//! The grey values of a blurred ellipse, averaged over pixels, with their derivatives: Green's theorem along the outline.
//!
//! With k the pixel's square blurred along one axis, T its integral and the outline (x(t), y(t)), the ellipse covers
//! `integral of k(px - x) T(py - y) x' dt` of pixel (px, py). The integrand is periodic and as smooth as the blur: equal steps
//! shorter than the blur's standard deviation make the sum exact to 1e-7, however small or bent the ellipse.

mod outline;
mod rims;
mod rows;

use std::ops::Range;

use crate::ellipse::Ellipse;
use crate::lanes::{LANES, Real, WIDE};
use outline::Outline;

/// From a disc's outline to the border of the window that pictures it, px.
pub(crate) const MARGIN: f64 = 5.0;
/// The variance of the blur is at least this, px^2.
pub(crate) const SHARPEST: f64 = 0.01;
/// The smallest semi-axis, px.
const SMALLEST: f64 = 0.3;

/// Whether a window of `side` px can picture such an ellipse under a blur of `variance` px^2; `false` for what is not a number.
pub(crate) fn is_pictured(ellipse: &Ellipse, variance: f64, side: usize) -> bool {
    let (side, [large, small]) = (side as f64, ellipse.semi_axes());
    ellipse.position.iter().all(|c| (-side..2.0 * side).contains(c)) && small >= SMALLEST && large <= side && variance <= side * side
}

/// How closely the outline is followed, and how far its blur is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fineness {
    /// Steps of the outline in standard deviations of the blur: the error is `2 exp(-2 pi^2 / step^2)`.
    step: f64,
    /// The blurred square ends here: half its side, and so many standard deviations.
    reach: f64,
}

/// To 1e-7 of the contrast.
pub(crate) const FINE: Fineness = Fineness { step: 1.1, reach: 6.0 };
/// To 1e-5, for grey values with noise.
pub(crate) const NOISY: Fineness = Fineness { step: 1.25, reach: 5.0 };
/// To 1e-4, for steps that others follow.
pub(crate) const ROUGH: Fineness = Fineness { step: 1.4, reach: 4.5 };

/// How much of each pixel is covered.
pub(crate) const COVERED: usize = 0;
/// Its derivatives by the centre's x and y: a vector that points outwards.
pub(crate) const CENTRE: [usize; 2] = [1, 2];
/// That by the variance of the blur.
pub(crate) const VARIANCE: usize = 3;
/// Those by the shape.
pub(crate) const SHAPE: [usize; 3] = [4, 5, 6];
const PLANES: usize = 7;

/// How much of each pixel of a square window an ellipse covers, and the derivatives, in planes of rows that are filled up, with zeros.
pub(crate) struct Planes<T> {
    pub(crate) side: usize,
    /// From one row to the next: a multiple of [`WIDE`].
    pub(crate) stride: usize,
    pub(crate) values: [Vec<T>; PLANES],
    /// The rows that see the outline: elsewhere all derivatives are zero.
    seen: Range<usize>,
    outline: Outline<T>,
}

impl<T: Real> Planes<T> {
    pub(crate) fn new(side: usize) -> Self {
        let stride = side.next_multiple_of(WIDE);
        let values = [(); PLANES].map(|()| vec![T::of(0.0); side * stride]);
        Self { side, stride, values, seen: 0..side, outline: Outline::new(side) }
    }

    /// Where in the planes derivatives are not all zero.
    pub(crate) fn seen_rows(&self) -> Range<usize> {
        self.seen.start * self.stride..self.seen.end * self.stride
    }

    /// The lanes of one plane from an index on.
    #[inline(always)]
    pub(crate) fn lanes(&self, plane: usize, at: usize) -> [T; LANES] {
        lanes(&self.values[plane], at)
    }
}

/// The values from an index on.
#[inline(always)]
pub(crate) fn lanes<T: Copy, const N: usize>(values: &[T], at: usize) -> [T; N] {
    *values[at..].first_chunk().expect("rows are whole lanes")
}

/// What planes are filled with: an `ellipse` whose position is taken from the window's first pixel, under a blur of `variance` px^2.
pub(crate) trait Picture {
    /// Fills all planes.
    fn fill(&mut self, ellipse: &Ellipse, variance: f64, fineness: Fineness);
    /// Fills the plane of what is covered alone.
    fn cover(&mut self, ellipse: &Ellipse, variance: f64, fineness: Fineness);
}

/// Planes of double precision.
pub(crate) type Exact = Planes<f64>;
/// Planes of single precision.
pub(crate) type Quick = Planes<f32>;
