//! The sums of Förstner's normal equations over one window.

use calibench_model::Image;

/// Columns that are summed side by side. Fixed, so that every instruction set adds in the same order and gives the same bits.
const LANES: usize = 4;

/// Sums over the window, with coordinates (x, y) from its centre and `t = gx x + gy y`.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sums {
    /// Sum of gx^2.
    pub(super) gxx: f64,
    /// Sum of gx gy.
    pub(super) gxy: f64,
    /// Sum of gy^2.
    pub(super) gyy: f64,
    /// Sum of gx t.
    pub(super) bx: f64,
    /// Sum of gy t.
    pub(super) by: f64,
    /// Sum of t^2.
    pub(super) c: f64,
}

/// Sums over the window of `window` px whose ring of one pixel starts at (`left`, `top`); window and ring are inside the image.
// The first target that the machine has is taken. AVX2 first: compiled for AVX-512 this was measured a tenth slower.
#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx2", "x86_64+avx512f+avx512vl")))]
pub(super) fn sums(image: &Image, left: usize, top: usize, window: usize) -> Sums {
    // A plain slice: a call into another crate for every row would cost more than the row.
    let ring = Ring { grey: &image.grey()[top * image.width() + left..], stride: image.width() };
    let mut total = Sums::default();
    if window < LANES {
        for column in 0..window {
            add(&mut total, &columns::<1>(ring, column, window), column, 0, window);
        }
        return total;
    }
    let mut done = 0;
    while done < window {
        // The last columns overlap those before them, so that nothing outside the ring is read.
        let first = done.min(window - LANES);
        add(&mut total, &columns::<LANES>(ring, first, window), first, done - first, window);
        done = first + LANES;
    }
    total
}

/// Grey values from the ring's first on, and from row to row.
#[derive(Clone, Copy)]
struct Ring<'a> {
    grey: &'a [f32],
    stride: usize,
}

/// Sums down each of `N` columns. The weights in x are the same for a whole column and wait for [`add`].
struct Columns<const N: usize> {
    gxx: [f64; N],
    gxy: [f64; N],
    gyy: [f64; N],
    y_gxy: [f64; N],
    y_gyy: [f64; N],
    yy_gyy: [f64; N],
}

/// The horizontal halves of Sobel's operator in one row: its difference and its (1, 2, 1).
#[derive(Clone, Copy)]
struct Row<const N: usize> {
    difference: [f64; N],
    smooth: [f64; N],
}

#[inline(always)]
fn row<const N: usize>(ring: Ring<'_>, first: usize, y: usize) -> Row<N> {
    let start = y * ring.stride + first;
    let grey = &ring.grey[start..start + N + 2];
    let mut row = Row { difference: [0.0; N], smooth: [0.0; N] };
    for i in 0..N {
        let (a, b, c) = (f64::from(grey[i]), f64::from(grey[i + 1]), f64::from(grey[i + 2]));
        row.difference[i] = c - a;
        row.smooth[i] = a + 2.0 * b + c;
    }
    row
}

#[inline(always)]
fn columns<const N: usize>(ring: Ring<'_>, first: usize, window: usize) -> Columns<N> {
    let half = (window / 2) as f64;
    let zero = [0.0; N];
    let mut s = Columns { gxx: zero, gxy: zero, gyy: zero, y_gxy: zero, y_gyy: zero, yy_gyy: zero };
    let (mut above, mut middle) = (row::<N>(ring, first, 0), row::<N>(ring, first, 1));
    for index in 0..window {
        let y = index as f64 - half;
        let below = row::<N>(ring, first, index + 2);
        for i in 0..N {
            let gx = above.difference[i] + 2.0 * middle.difference[i] + below.difference[i];
            let gy = below.smooth[i] - above.smooth[i];
            let (gxx, gxy, gyy) = (gx * gx, gx * gy, gy * gy);
            let y_gyy = y * gyy;
            s.gxx[i] += gxx;
            s.gxy[i] += gxy;
            s.gyy[i] += gyy;
            s.y_gxy[i] += y * gxy;
            s.y_gyy[i] += y_gyy;
            s.yy_gyy[i] += y * y_gyy;
        }
        (above, middle) = (middle, below);
    }
    s
}

/// Adds the columns from `skip` on, of which number 0 is column `first` of the window.
#[inline(always)]
fn add<const N: usize>(total: &mut Sums, s: &Columns<N>, first: usize, skip: usize, window: usize) {
    for i in skip..N {
        let x = (first + i) as f64 - (window / 2) as f64;
        total.gxx += s.gxx[i];
        total.gxy += s.gxy[i];
        total.gyy += s.gyy[i];
        total.bx += x * s.gxx[i] + s.y_gxy[i];
        total.by += x * s.gxy[i] + s.y_gyy[i];
        total.c += x * (x * s.gxx[i] + 2.0 * s.y_gxy[i]) + s.yy_gyy[i];
    }
}
