//! What all nodes give, row by row.

use super::outline::Node;
use super::{COVERED, Exact, Fineness, PLANES, Picture, Planes, Quick, lanes};
use crate::ellipse::Ellipse;
use crate::lanes::{LANES, Real};

impl Picture for Exact {
    fn fill(&mut self, ellipse: &Ellipse, variance: f64, fineness: Fineness) {
        exact(self, ellipse, variance.sqrt(), fineness, true);
    }

    fn cover(&mut self, ellipse: &Ellipse, variance: f64, fineness: Fineness) {
        exact(self, ellipse, variance.sqrt(), fineness, false);
    }
}

impl Picture for Quick {
    fn fill(&mut self, ellipse: &Ellipse, variance: f64, fineness: Fineness) {
        quick(self, ellipse, variance.sqrt(), fineness, true);
    }

    fn cover(&mut self, ellipse: &Ellipse, variance: f64, fineness: Fineness) {
        quick(self, ellipse, variance.sqrt(), fineness, false);
    }
}

#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn exact(to: &mut Exact, ellipse: &Ellipse, blur: f64, fineness: Fineness, all: bool) {
    if all { fill::<f64, true>(to, ellipse, blur, fineness) } else { fill::<f64, false>(to, ellipse, blur, fineness) }
}

#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn quick(to: &mut Quick, ellipse: &Ellipse, blur: f64, fineness: Fineness, all: bool) {
    if all { fill::<f32, true>(to, ellipse, blur, fineness) } else { fill::<f32, false>(to, ellipse, blur, fineness) }
}

#[inline(always)]
fn fill<T: Real, const ALL: bool>(to: &mut Planes<T>, ellipse: &Ellipse, blur: f64, fineness: Fineness) {
    to.outline.lay::<ALL>(ellipse, blur, fineness);
    let (mut from, mut until) = (0, 0);
    let heights = &to.outline.heights;
    let (side, chunks) = (to.side, to.stride / LANES);
    if ALL {
        let [first, end] = [heights.first().map_or(0, |height| height.first), heights.last().map_or(0, |height| height.end)];
        to.seen = first.min(side)..end.min(side);
    }
    for row in 0..side {
        while from < heights.len() && heights[from].end <= row {
            from += 1;
        }
        while until < heights.len() && heights[until].first <= row {
            until += 1;
        }
        let seeing = &heights[from.min(until)..until];
        for chunk in 0..chunks {
            let mut sums = [[T::of(0.0); LANES]; PLANES];
            for height in seeing {
                let down = &to.outline.down[height.down + row - height.first];
                for node in &height.nodes {
                    let index = chunk.wrapping_sub(node.chunk);
                    if index < node.chunks {
                        let at = node.across + index * LANES;
                        let across = lanes(&to.outline.across, at);
                        if ALL {
                            add(&mut sums, node, down, &across, &lanes(&to.outline.slopes, at));
                        } else {
                            add_line(&mut sums[COVERED], &across, down[2] * node.dx);
                        }
                    }
                }
            }
            // Past the side there is nothing.
            let (at, inside) = (row * to.stride + chunk * LANES, side.saturating_sub(chunk * LANES).min(LANES));
            if ALL {
                for (plane, sums) in to.values[1..].iter_mut().zip(&mut sums[1..]) {
                    sums[inside..].fill(T::of(0.0));
                    plane[at..][..LANES].copy_from_slice(sums);
                }
            }
            // What was added to one row is meant for all rows below it.
            if row > 0 {
                let above: [T; LANES] = lanes(&to.values[COVERED], at - to.stride);
                for i in 0..LANES {
                    sums[COVERED][i] += above[i];
                }
            }
            sums[COVERED][inside..].fill(T::of(0.0));
            to.values[COVERED][at..][..LANES].copy_from_slice(&sums[COVERED]);
        }
    }
}

/// What the outline between two nodes gives to one chunk of a row.
#[inline(always)]
fn add<T: Real>(sums: &mut [[T; LANES]; PLANES], node: &Node<T>, down: &[T; 3], across: &[T; LANES], slopes: &[T; LANES]) {
    let [down, down_slope, gain] = *down;
    let half = T::of(0.5);
    let (dx, dy) = (node.dx, node.dy);
    let [covered, by_x, by_y, by_variance, by_a, by_b, by_c] = sums;
    let (covers, along, across_slope) = (gain * dx, half * down_slope * dx, -half * down * dy);
    let [a, b, c] = node.speeds;
    let (a, b, c) = (a * down, b * down, c * down);
    let (x, y) = (down * dy, -down * dx);
    for i in 0..LANES {
        let (value, slope) = (across[i], slopes[i]);
        covered[i] += value * covers;
        by_x[i] += value * x;
        by_y[i] += value * y;
        by_a[i] += value * a;
        by_b[i] += value * b;
        by_c[i] += value * c;
        by_variance[i] += value * along + slope * across_slope;
    }
}

#[inline(always)]
fn add_line<T: Real>(sums: &mut [T; LANES], values: &[T; LANES], weight: T) {
    for (sum, value) in sums.iter_mut().zip(values) {
        *sum += *value * weight;
    }
}
