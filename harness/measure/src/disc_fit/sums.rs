//! The sums of the normal equations over all pixels of a window.

use nalgebra::SMatrix;

use super::{UNKNOWNS, Unknowns};
use crate::blurred_ellipse::{CENTRE, COVERED, Exact, Planes, Quick, SHAPE, VARIANCE};
use crate::lanes::{LANES, Real, WIDE};
use crate::marquardt::Normal;

/// The unknowns that move the outline or its blur, each with its plane; the grey value outside and the contrast follow.
const MOVING: [usize; 6] = [CENTRE[0], CENTRE[1], SHAPE[0], SHAPE[1], SHAPE[2], VARIANCE];

/// Grey values in one precision, in rows as the planes' are, filled up with zeros.
pub(super) struct Greys<T> {
    grey: Vec<T>,
    side: usize,
    /// What is left of them.
    r: Vec<T>,
}

impl<T: Real> Greys<T> {
    /// Of a square window, whose rows are filled up to `stride`.
    pub(super) fn new(grey: &[f32], side: usize, stride: usize) -> Self {
        let mut filled = vec![T::of(0.0); side * stride];
        for (line, row) in filled.chunks_exact_mut(stride).zip(grey.chunks_exact(side)) {
            line.iter_mut().zip(row).for_each(|(to, from)| *to = T::of(f64::from(*from)));
        }
        Self { r: filled.clone(), grey: filled, side }
    }

    /// The residuals of the last picture.
    pub(super) fn residuals(&self) -> Vec<f32> {
        self.r.iter().map(|r| Into::<f64>::into(*r) as f32).collect()
    }

    /// What the picture leaves of the grey values.
    #[inline(always)]
    fn subtract(&mut self, planes: &Planes<T>, [ground, contrast]: Levels) {
        let (ground, contrast) = (T::of(ground), T::of(contrast));
        let covered = planes.values[COVERED].chunks_exact(planes.stride);
        for ((r, grey), covered) in self.r.chunks_exact_mut(planes.stride).zip(self.grey.chunks_exact(planes.stride)).zip(covered) {
            for (r, (grey, covered)) in r[..self.side].iter_mut().zip(grey.iter().zip(covered)) {
                *r = *grey - ground - contrast * *covered;
            }
        }
    }
}

/// The grey value outside, and the contrast.
pub(super) type Levels = [f64; 2];

/// Sums that are worked out in one precision.
pub(super) trait Summed<T> {
    /// The normal equations of all unknowns.
    fn normal(&self, greys: &mut Greys<T>, levels: Levels) -> Normal<UNKNOWNS>;
    /// The right-hand side by the derivatives of `slopes`, and the squared residuals.
    fn gradient(&self, slopes: &Quick, greys: &mut Greys<T>, levels: Levels) -> (Unknowns, f64);
}

impl Summed<f64> for Exact {
    fn normal(&self, greys: &mut Greys<f64>, levels: Levels) -> Normal<UNKNOWNS> {
        exact(self, greys, levels)
    }

    fn gradient(&self, slopes: &Quick, greys: &mut Greys<f64>, levels: Levels) -> (Unknowns, f64) {
        exact_gradient(self, slopes, greys, levels)
    }
}

impl Summed<f32> for Quick {
    fn normal(&self, greys: &mut Greys<f32>, levels: Levels) -> Normal<UNKNOWNS> {
        quick(self, greys, levels)
    }

    fn gradient(&self, slopes: &Quick, greys: &mut Greys<f32>, levels: Levels) -> (Unknowns, f64) {
        quick_gradient(self, slopes, greys, levels)
    }
}

#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn exact(planes: &Exact, greys: &mut Greys<f64>, levels: Levels) -> Normal<UNKNOWNS> {
    normal::<f64, LANES>(planes, greys, levels)
}

#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn quick(planes: &Quick, greys: &mut Greys<f32>, levels: Levels) -> Normal<UNKNOWNS> {
    normal::<f32, WIDE>(planes, greys, levels)
}

#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn exact_gradient(planes: &Exact, slopes: &Quick, greys: &mut Greys<f64>, levels: Levels) -> (Unknowns, f64) {
    gradient::<f64, LANES>(planes, slopes, greys, levels)
}

#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn quick_gradient(planes: &Quick, slopes: &Quick, greys: &mut Greys<f32>, levels: Levels) -> (Unknowns, f64) {
    gradient::<f32, WIDE>(planes, slopes, greys, levels)
}

#[inline(always)]
fn normal<T: Real, const N: usize>(planes: &Planes<T>, greys: &mut Greys<T>, levels: Levels) -> Normal<UNKNOWNS> {
    greys.subtract(planes, levels);
    let (r, covered, seen) = (&greys.r[..], &planes.values[COVERED][..], planes.seen_rows());
    let (mut n, mut b) = (SMatrix::<f64, UNKNOWNS, UNKNOWNS>::zeros(), Unknowns::zeros());
    let contrast = levels[1];
    for (i, plane) in MOVING.into_iter().enumerate() {
        let by = &planes.values[plane][seen.clone()];
        for (j, other) in MOVING.into_iter().enumerate().skip(i) {
            n[(i, j)] = contrast * contrast * dot::<T, T, N>(by, &planes.values[other][seen.clone()]);
        }
        n[(i, 6)] = contrast * sum::<T, N>(by);
        n[(i, 7)] = contrast * dot::<T, T, N>(by, &covered[seen.clone()]);
        b[i] = contrast * dot::<T, T, N>(by, &r[seen.clone()]);
    }
    n[(6, 6)] = (planes.side * planes.side) as f64;
    n[(6, 7)] = sum::<T, N>(covered);
    n[(7, 7)] = dot::<T, T, N>(covered, covered);
    (b[6], b[7]) = (sum::<T, N>(r), dot::<T, T, N>(covered, r));
    n.fill_lower_triangle_with_upper_triangle();
    Normal { n, b, omega: dot::<T, T, N>(r, r) }
}

#[inline(always)]
fn gradient<T: Real, const N: usize>(planes: &Planes<T>, slopes: &Quick, greys: &mut Greys<T>, levels: Levels) -> (Unknowns, f64) {
    greys.subtract(planes, levels);
    let (r, covered, seen) = (&greys.r[..], &planes.values[COVERED][..], slopes.seen_rows());
    let mut b = Unknowns::zeros();
    for (b, plane) in b.iter_mut().zip(MOVING) {
        *b = levels[1] * dot::<f32, T, N>(&slopes.values[plane][seen.clone()], &r[seen.clone()]);
    }
    (b[6], b[7]) = (sum::<T, N>(r), dot::<T, T, N>(covered, r));
    (b, dot::<T, T, N>(r, r))
}

/// The sum of products, in lanes.
#[inline(always)]
fn dot<A: Real, T: Real, const N: usize>(a: &[A], b: &[T]) -> f64 {
    let mut sums = [T::of(0.0); N];
    for (a, b) in a.chunks_exact(N).zip(b.chunks_exact(N)) {
        for i in 0..N {
            sums[i] += T::of(a[i].into()) * b[i];
        }
    }
    total(&sums)
}

/// The sum, in lanes.
#[inline(always)]
fn sum<T: Real, const N: usize>(a: &[T]) -> f64 {
    let mut sums = [T::of(0.0); N];
    for a in a.chunks_exact(N) {
        for i in 0..N {
            sums[i] += a[i];
        }
    }
    total(&sums)
}

#[inline(always)]
fn total<T: Real, const N: usize>(lanes: &[T; N]) -> f64 {
    let mut total = 0.0;
    for value in lanes {
        total += (*value).into();
    }
    total
}
