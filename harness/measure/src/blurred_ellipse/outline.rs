//! Nodes on the outline of an ellipse, and what the blurred square of each is along rows and columns.

use std::f64::consts::{FRAC_PI_2, PI};

use super::Fineness;
use super::rims::{Rims, Seen};
use crate::blurred_step::DENSITY;
use crate::ellipse::Ellipse;
use crate::lanes::{LANES, Real};

/// The fewest pairs of nodes.
const FEWEST: f64 = 12.0;

/// So many pairs are no surprise.
const USUAL: usize = 48;

/// The nodes of an outline, in pairs of the same y, from the least to the greatest.
pub(super) struct Outline<T> {
    side: usize,
    pub(super) heights: Vec<Height<T>>,
    /// The blurred square along y, its slope, and by how much its integral grows, row by row of each height.
    pub(super) down: Vec<[T; 3]>,
    /// The blurred square along x, and its slope, in whole chunks of each node.
    pub(super) across: Vec<T>,
    pub(super) slopes: Vec<T>,
    rims: Rims<T>,
}

/// Two nodes of the same y.
pub(super) struct Height<T> {
    seen: Seen,
    /// The rows that see them, and one below, for which the integral is complete.
    pub(super) first: usize,
    pub(super) end: usize,
    /// Where these start in the list.
    pub(super) down: usize,
    pub(super) nodes: [Node<T>; 2],
}

/// What the outline goes on by at a node, and how fast it moves outwards with each of the shape; and the chunks of columns that see it.
pub(super) struct Node<T> {
    seen: Seen,
    pub(super) dx: T,
    pub(super) dy: T,
    pub(super) speeds: [T; 3],
    pub(super) chunk: usize,
    pub(super) chunks: usize,
    /// Where these start in the lists.
    pub(super) across: usize,
}

/// What all nodes of an outline have in common: half its height, sine and cosine of the angle from its highest point to the y axis, and the step.
struct Frame {
    height: f64,
    sin: f64,
    cos: f64,
    dt: f64,
}

impl<T: Real> Outline<T> {
    pub(super) fn new(side: usize) -> Self {
        let [across, slopes] = [(); 2].map(|()| Vec::with_capacity(USUAL * 6 * LANES));
        Self { side, heights: Vec::with_capacity(USUAL), down: Vec::with_capacity(USUAL * 12), across, slopes, rims: Rims::new() }
    }

    /// Lays out all nodes. `ALL`: not only what covers a pixel, slopes too.
    #[inline(always)]
    pub(super) fn lay<const ALL: bool>(&mut self, ellipse: &Ellipse, blur: f64, fineness: Fineness) {
        self.rims.start(self.side, blur, 0.5 + fineness.reach * blur);
        self.place(ellipse, (PI * ellipse.semi_axes()[0] / (fineness.step * blur)).ceil().max(FEWEST) as usize);
        self.rims.work_out();
        self.down.clear();
        self.across.clear();
        self.slopes.clear();
        let mut heights = std::mem::take(&mut self.heights);
        for height in &mut heights {
            self.rows(height, blur);
            for node in &mut height.nodes {
                self.columns::<ALL>(node, blur);
            }
        }
        self.heights = heights;
    }

    /// Where the nodes are.
    #[inline(always)]
    fn place(&mut self, ellipse: &Ellipse, pairs: usize) {
        self.heights.clear();
        let dt = PI / pairs as f64;
        let [_, b, c] = ellipse.shape;
        // The outline's y is `height * sin(s)`, with s = t + delta.
        let height = b.hypot(c);
        let frame = Frame { height, sin: b / height, cos: c / height, dt };
        let (turn_sin, turn_cos) = dt.sin_cos();
        let (mut sin, mut cos) = (0.5 * dt - FRAC_PI_2).sin_cos();
        for _ in 0..pairs {
            let seen = self.rims.seen(ellipse.position[1] + height * sin);
            let nodes = [self.node(ellipse, &frame, [sin, cos]), self.node(ellipse, &frame, [sin, -cos])];
            self.heights.push(Height { first: seen.first, end: seen.first + seen.count + 1, seen, down: 0, nodes });
            (sin, cos) = (sin * turn_cos + cos * turn_sin, cos * turn_cos - sin * turn_sin);
        }
    }

    /// The node at a place of the outline that is given by sine and cosine.
    #[inline(always)]
    fn node(&mut self, ellipse: &Ellipse, frame: &Frame, [sin, cos]: [f64; 2]) -> Node<T> {
        let ([a, b, _], dt) = (ellipse.shape, frame.dt);
        let (of_x, of_y) = (cos * frame.cos + sin * frame.sin, sin * frame.cos - cos * frame.sin);
        let (dx, dy) = ((b * of_x - a * of_y) * dt, frame.height * cos * dt);
        let speeds = [T::of(of_x * dy), T::of(of_y * dy - of_x * dx), T::of(-of_y * dx)];
        let seen = self.rims.seen(ellipse.position[0] + a * of_x + b * of_y);
        let chunk = seen.first / LANES;
        let chunks = if seen.count == 0 { 0 } else { (seen.first + seen.count).div_ceil(LANES) - chunk };
        Node { seen, dx: T::of(dx), dy: T::of(dy), speeds, chunk, chunks, across: 0 }
    }

    #[inline(always)]
    fn rows(&mut self, height: &mut Height<T>, blur: f64) {
        height.down = self.down.len();
        let (edge, bell, area) = self.rims.of(&height.seen);
        let (half, one, steep, blur) = (T::of(0.5), T::of(1.0), T::of(DENSITY / blur), T::of(blur));
        let mut above = T::of(0.0);
        for row in 0..height.seen.count {
            let integral = half + blur * (area[row + 1] - area[row]);
            self.down.push([half * (edge[row + 1] - edge[row]), steep * (bell[row + 1] - bell[row]), integral - above]);
            above = integral;
        }
        self.down.push([T::of(0.0), T::of(0.0), one - above]);
    }

    #[inline(always)]
    fn columns<const ALL: bool>(&mut self, node: &mut Node<T>, blur: f64) {
        node.across = self.across.len();
        if node.chunks == 0 {
            return;
        }
        let (edge, bell, _) = self.rims.of(&node.seen);
        let (from, count) = (node.across + node.seen.first - node.chunk * LANES, node.seen.count);
        let end = node.across + node.chunks * LANES;
        differences(&mut self.across, end, from, (edge, count), T::of(0.5));
        if ALL {
            differences(&mut self.slopes, end, from, (bell, count), T::of(DENSITY / blur));
        }
    }
}

/// Lengthens `to` to `end` with zeros, but from `from` on with so many differences of rims.
#[inline(always)]
fn differences<T: Real>(to: &mut Vec<T>, end: usize, from: usize, (rims, count): (&[T], usize), factor: T) {
    to.resize(end, T::of(0.0));
    for (to, pair) in to[from..][..count].iter_mut().zip(rims.windows(2)) {
        *to = factor * (pair[1] - pair[0]);
    }
}
