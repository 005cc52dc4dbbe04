//! The strength of many pixels, row by row: Sobel or central differences, products, separable weights, strength.

use std::ops::{Add, Mul, Sub};

/// Output columns of one strip: its buffers stay in the second-level cache, and rows are read in long runs.
const STRIP: usize = 4096;

/// Single or double precision.
pub(super) trait Real: Copy + Default + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    /// A grey value.
    fn from_grey(grey: f32) -> Self;
    /// A weight.
    fn from_weight(weight: f64) -> Self;
}

impl Real for f32 {
    #[inline(always)]
    fn from_grey(grey: f32) -> Self {
        grey
    }
    #[inline(always)]
    fn from_weight(weight: f64) -> Self {
        weight as Self
    }
}

impl Real for f64 {
    #[inline(always)]
    fn from_grey(grey: f32) -> Self {
        Self::from(grey)
    }
    #[inline(always)]
    fn from_weight(weight: f64) -> Self {
        weight
    }
}

/// How gradients are taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gradient {
    /// Sobel's operator, per px.
    Sobel,
    /// Half the difference of the neighbours.
    Central,
}

/// What the strength is made of.
#[derive(Clone, Copy)]
pub(super) struct Recipe<'a> {
    /// One half of the weights, from the middle outwards.
    pub(super) weights: &'a [f64],
    /// Weight of the squared trace.
    pub(super) alpha: f64,
    /// How gradients are taken.
    pub(super) gradient: Gradient,
    /// Factor of the moments of the gradients.
    pub(super) scale: f64,
}

/// Grey values row by row, `stride` apart; `columns` x `rows` are wanted, the first of them `weights.len()` from the left and the top.
#[derive(Clone, Copy)]
pub(super) struct Source<'a> {
    pub(super) grey: &'a [f32],
    pub(super) stride: usize,
    pub(super) columns: usize,
    pub(super) rows: usize,
}

/// Strengths in double precision.
#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
pub(super) fn double(source: Source<'_>, recipe: Recipe<'_>, out: &mut [f64]) {
    if source.columns < 8 { strips::<f64, 1>(source, recipe, out) } else { strips::<f64, 8>(source, recipe, out) }
}

/// Strengths in single precision.
#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
pub(super) fn single(source: Source<'_>, recipe: Recipe<'_>, out: &mut [f32]) {
    if source.columns < 16 { strips::<f32, 1>(source, recipe, out) } else { strips::<f32, 16>(source, recipe, out) }
}

/// Weights of a radius known to the compiler are unrolled.
#[inline(always)]
fn strips<T: Real, const L: usize>(source: Source<'_>, recipe: Recipe<'_>, out: &mut [T]) {
    let mut done = 0;
    while done < source.columns {
        let columns = STRIP.min(source.columns);
        // The last strip overlaps the one before it, so that it is wide enough for the lanes.
        let strip = Strip { source, left: done.min(source.columns - columns), columns };
        match recipe.weights.len() - 1 {
            1 => rows::<T, _, L>(strip, recipe, &Fixed::<T, 2>::new(recipe.weights), out),
            2 => rows::<T, _, L>(strip, recipe, &Fixed::<T, 3>::new(recipe.weights), out),
            3 => rows::<T, _, L>(strip, recipe, &Fixed::<T, 4>::new(recipe.weights), out),
            _ => rows::<T, _, L>(strip, recipe, &Any(recipe.weights.iter().map(|&w| T::from_weight(w)).collect()), out),
        }
        done = strip.left + columns;
    }
}

#[inline(always)]
fn load<T: Copy, const L: usize>(values: &[T], start: usize) -> [T; L] {
    values[start..start + L].try_into().expect("a slice of that length")
}

/// Symmetric weights.
trait Weights<T> {
    fn radius(&self) -> usize;
    fn at(&self, distance: usize) -> T;
}

struct Fixed<T, const N: usize>([T; N]);

impl<T: Real, const N: usize> Fixed<T, N> {
    #[inline(always)]
    fn new(weights: &[f64]) -> Self {
        Self(std::array::from_fn(|i| T::from_weight(weights[i])))
    }
}

impl<T: Real, const N: usize> Weights<T> for Fixed<T, N> {
    #[inline(always)]
    fn radius(&self) -> usize {
        N - 1
    }
    #[inline(always)]
    fn at(&self, distance: usize) -> T {
        self.0[distance]
    }
}

struct Any<T>(Vec<T>);

impl<T: Real> Weights<T> for Any<T> {
    #[inline(always)]
    fn radius(&self) -> usize {
        self.0.len() - 1
    }
    #[inline(always)]
    fn at(&self, distance: usize) -> T {
        self.0[distance]
    }
}

/// Some columns of a source.
#[derive(Clone, Copy)]
struct Strip<'a> {
    source: Source<'a>,
    left: usize,
    columns: usize,
}

/// Rows of gx^2, gx gy, gy^2: one as computed, and a ring of those weighted along x.
struct Buffers<T> {
    products: [Vec<T>; 3],
    ring: Vec<[Vec<T>; 3]>,
}

#[inline(always)]
fn rows<T: Real, W: Weights<T>, const L: usize>(strip: Strip<'_>, recipe: Recipe<'_>, weights: &W, out: &mut [T]) {
    let (radius, columns) = (weights.radius(), strip.columns);
    let wide = columns + 2 * radius;
    let mut buffers = Buffers {
        products: [(); 3].map(|()| vec![T::default(); wide]),
        ring: (0..=2 * radius).map(|_| [(); 3].map(|()| vec![T::default(); columns])).collect(),
    };
    let taps = buffers.ring.len();
    let (alpha, scale) = (T::from_weight(recipe.alpha), T::from_weight(recipe.scale));
    for row in 0..strip.source.rows + 2 * radius {
        let grey = |down: usize| &strip.source.grey[(row + down) * strip.source.stride + strip.left..][..wide + 2];
        let three = [grey(0), grey(1), grey(2)];
        match recipe.gradient {
            Gradient::Sobel => gradients::<T, L>(three, true, &mut buffers.products),
            Gradient::Central => gradients::<T, L>(three, false, &mut buffers.products),
        }
        for (product, to) in buffers.products.iter().zip(&mut buffers.ring[row % taps]) {
            across::<T, W, L>(product, weights, to);
        }
        if row >= 2 * radius {
            let top = row - 2 * radius;
            let line = &mut out[top * strip.source.columns + strip.left..][..columns];
            down::<T, W, L>(&buffers.ring, top, weights, (alpha, scale), line);
        }
    }
}

/// Gradients in x and in y.
type Gradients<T, const L: usize> = ([T; L], [T; L]);

// Plain loops over lanes: the arrays' own `map`, functions as arguments and iterators' adapters are not all compiled for the wider instruction
// sets. The last lanes of a row overlap those before them and are worked out again, to the same bits.

/// Sobel's gradient per px.
#[inline(always)]
fn sobel<T: Real, const L: usize>([above, here, below]: [&[f32]; 3], start: usize) -> Gradients<T, L> {
    let (two, eighth) = (T::from_weight(2.0), T::from_weight(0.125));
    let (a, b, c) = (three::<L>(above, start), three::<L>(here, start), three::<L>(below, start));
    let (mut gx, mut gy) = ([T::default(); L], [T::default(); L]);
    for i in 0..L {
        let column = |x: usize| T::from_grey(a[x][i]) + two * T::from_grey(b[x][i]) + T::from_grey(c[x][i]);
        let step = |x: usize| T::from_grey(c[x][i]) - T::from_grey(a[x][i]);
        gx[i] = (column(2) - column(0)) * eighth;
        gy[i] = (step(0) + two * step(1) + step(2)) * eighth;
    }
    (gx, gy)
}

/// Half the differences of the neighbours.
#[inline(always)]
fn central<T: Real, const L: usize>([above, here, below]: [&[f32]; 3], start: usize) -> Gradients<T, L> {
    let half = T::from_weight(0.5);
    let (b, top, bottom): ([[f32; L]; 3], [f32; L], [f32; L]) = (three(here, start), load(above, start + 1), load(below, start + 1));
    let (mut gx, mut gy) = ([T::default(); L], [T::default(); L]);
    for i in 0..L {
        gx[i] = (T::from_grey(b[2][i]) - T::from_grey(b[0][i])) * half;
        gy[i] = (T::from_grey(bottom[i]) - T::from_grey(top[i])) * half;
    }
    (gx, gy)
}

/// The lanes from `start` on, and those one and two further.
#[inline(always)]
fn three<const L: usize>(row: &[f32], start: usize) -> [[f32; L]; 3] {
    [load(row, start), load(row, start + 1), load(row, start + 2)]
}

#[inline(always)]
fn gradients<T: Real, const L: usize>(rows: [&[f32]; 3], sobel_operator: bool, products: &mut [Vec<T>; 3]) {
    let [xx, xy, yy] = products;
    let (n, mut next) = (xx.len(), 0);
    while next < n {
        let start = next.min(n - L);
        next += L;
        let (gx, gy) = if sobel_operator { sobel::<T, L>(rows, start) } else { central::<T, L>(rows, start) };
        let (mut a, mut b, mut c) = ([T::default(); L], [T::default(); L], [T::default(); L]);
        for i in 0..L {
            a[i] = gx[i] * gx[i];
            b[i] = gx[i] * gy[i];
            c[i] = gy[i] * gy[i];
        }
        xx[start..start + L].copy_from_slice(&a);
        xy[start..start + L].copy_from_slice(&b);
        yy[start..start + L].copy_from_slice(&c);
    }
}

/// The weighted sum of values on both sides of a middle: `at(0)` is the first of them, `at(2 radius)` the last.
#[inline(always)]
fn weigh<T: Real, W: Weights<T>, const L: usize>(weights: &W, at: impl Fn(usize) -> [T; L]) -> [T; L] {
    let radius = weights.radius();
    let (middle, weight) = (at(radius), weights.at(0));
    let mut sum = [T::default(); L];
    for i in 0..L {
        sum[i] = weight * middle[i];
    }
    for d in 1..=radius {
        let (weight, before, behind) = (weights.at(d), at(radius - d), at(radius + d));
        for i in 0..L {
            sum[i] = sum[i] + weight * (before[i] + behind[i]);
        }
    }
    sum
}

#[inline(always)]
fn across<T: Real, W: Weights<T>, const L: usize>(values: &[T], weights: &W, to: &mut [T]) {
    let (n, mut next) = (to.len(), 0);
    while next < n {
        let start = next.min(n - L);
        next += L;
        let sum: [T; L] = weigh(weights, |offset| load(values, start + offset));
        to[start..start + L].copy_from_slice(&sum);
    }
}

/// Weights down the ring, whose oldest row is `top`, and the strength.
#[inline(always)]
fn down<T: Real, W: Weights<T>, const L: usize>(ring: &[[Vec<T>; 3]], top: usize, weights: &W, (alpha, scale): (T, T), line: &mut [T]) {
    let (n, mut next) = (line.len(), 0);
    while next < n {
        let start = next.min(n - L);
        next += L;
        let moment = |product: usize| -> [T; L] { weigh(weights, |offset| load(&ring[(top + offset) % ring.len()][product], start)) };
        let (xx, xy, yy) = (moment(0), moment(1), moment(2));
        let mut strength = [T::default(); L];
        for i in 0..L {
            let (a, b, c) = (xx[i] * scale, xy[i] * scale, yy[i] * scale);
            let trace = a + c;
            strength[i] = a * c - b * b - alpha * trace * trace;
        }
        line[start..start + L].copy_from_slice(&strength);
    }
}
