//! The grey value of a blurred chess corner, averaged over a photosite, with its derivatives.

use std::sync::LazyLock;

use calibench_model::quadrature::gauss_legendre;

use crate::blurred_step::{DENSITY, edge, exp_minus, step};
use crate::lanes::{BLOCK, Block, Real, WIDE, half_of};
pub(super) use crate::photosite::Fidelity;
use crate::photosite::Square;

/// Unknowns, in this order: position x, y (px), directions of the two edges' normals (rad), variance of the blur (px^2), mean of the two
/// grey values, half their difference.
pub(super) const BASE: usize = 7;

/// The shape of the corner: all unknowns but the grey values.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shape {
    /// From the window's centre, px.
    pub(super) position: [f64; 2],
    /// Directions of the normals, rad. The light areas are where the distances from both edges have the same sign.
    pub(super) normals: [f64; 2],
    /// Variance of the blur, px^2.
    pub(super) variance: f64,
    /// Curvatures of the edges, 1/px, positive towards the normal.
    pub(super) curvature: [f64; 2],
    /// Side of the square that is sensitive to light in each pixel, px: not unknown.
    pub(super) photosite: f64,
}

/// Gauss-Legendre rules of 2, 4 and 8 points on [0, 1].
static RULES: LazyLock<[Vec<(f64, f64)>; 3]> = LazyLock::new(|| [2, 4, 8].map(gauss_legendre));

/// One Gaussian of the photosite: offset from its centre (px) and weight.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node<T> {
    pub(super) x: T,
    pub(super) y: T,
    pub(super) weight: T,
}

/// A straight or curved edge: the cosine and sine of its normal's direction, its curvature.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge<T> {
    pub(super) nx: T,
    pub(super) ny: T,
    pub(super) curvature: T,
}

/// All that a chunk of pixels needs to know of a shape.
pub(super) struct Model<T> {
    pub(super) edges: [Edge<T>; 2],
    pub(super) nodes: [Node<T>; 16],
    pub(super) count: usize,
    /// Variance of the blurred Gaussians of the photosite, px^2, and 1 / its root.
    pub(super) variance: T,
    pub(super) inverse: T,
    /// Cosine of the angle between the normals, and 1 / its sine.
    rho: T,
    cosecant: T,
    /// `(2 / pi) integral of exp(-a (u^2 + v^2) + b u v)`: a, b and weight at each node.
    pub(super) integral: [(T, T, T); 8],
    pub(super) terms: usize,
    /// Distance from an edge, px, from which on it is not seen.
    pub(super) reach: T,
}

/// A grey value in units of half the contrast, and its derivatives by the [`Shape`], of `N` pixels.
#[derive(Clone, Copy)]
pub(super) struct Field<T, const N: usize> {
    pub(super) value: [T; N],
    pub(super) position: [[T; N]; 2],
    pub(super) normals: [[T; N]; 2],
    pub(super) variance: [T; N],
    pub(super) curvature: [[T; N]; 2],
}

impl<T: Real, const N: usize> Field<T, N> {
    /// Of pixels from which no edge is seen.
    #[inline(always)]
    pub(super) fn constant(value: [T; N]) -> Self {
        let zero = [T::of(0.0); N];
        Self { value, position: [zero; 2], normals: [zero; 2], variance: zero, curvature: [zero; 2] }
    }
}

impl Field<f32, BLOCK> {
    /// Of the pixels of one half.
    #[inline(always)]
    pub(super) fn half(&self, half: usize) -> Field<f32, WIDE> {
        let of = |block: &Block| *half_of(block, half);
        Field {
            value: of(&self.value),
            position: [of(&self.position[0]), of(&self.position[1])],
            normals: [of(&self.normals[0]), of(&self.normals[1])],
            variance: of(&self.variance),
            curvature: [of(&self.curvature[0]), of(&self.curvature[1])],
        }
    }
}

impl<T: Real> Model<T> {
    /// `None` for edges that are parallel to 3 degrees.
    pub(super) fn new(shape: &Shape, fidelity: Fidelity) -> Option<Self> {
        let (sine, rho) = (shape.normals[1] - shape.normals[0]).sin_cos();
        if sine.is_nan() || sine < 0.05 {
            return None;
        }
        let (width, area) = (shape.photosite, shape.photosite * shape.photosite);
        let square = Square::for_blur(shape.variance / area, fidelity);
        let zero = T::of(0.0);
        let (mut nodes, mut count) = ([Node { x: zero, y: zero, weight: zero }; 16], 0);
        for [x, y, weight] in square.nodes() {
            nodes[count] = Node { x: T::of(x * width), y: T::of(y * width), weight: T::of(weight) };
            count += 1;
        }
        let edge = |i: usize| {
            let (ny, nx) = shape.normals[i].sin_cos();
            Edge { nx: T::of(nx), ny: T::of(ny), curvature: T::of(shape.curvature[i]) }
        };
        let (integral, terms) = correlation(rho.asin());
        let variance = shape.variance + square.variance * area;
        let blur = variance.sqrt();
        let reach = square.reach(width, blur);
        Some(Self {
            edges: [edge(0), edge(1)],
            nodes,
            count,
            variance: T::of(variance),
            inverse: T::of(1.0 / blur),
            rho: T::of(rho),
            cosecant: T::of(1.0 / sine),
            integral: integral.map(|(square, product, weight)| (T::of(square), T::of(product), T::of(weight))),
            terms,
            reach: T::of(reach),
        })
    }

    /// Both edges are near.
    #[inline(always)]
    pub(super) fn corner<const N: usize, const CURVED: bool>(&self, x: &[T; N], y: &[T; N]) -> Field<T, N> {
        let mut sum = Field::constant([T::of(0.0); N]);
        for node in &self.nodes[..self.count] {
            self.add_corner::<N, CURVED>(node, x, y, &mut sum);
        }
        sum
    }

    #[inline(always)]
    fn add_corner<const N: usize, const CURVED: bool>(&self, node: &Node<T>, x: &[T; N], y: &[T; N], sum: &mut Field<T, N>) {
        let zero = [T::of(0.0); N];
        let p = self.edges[0].place::<N, CURVED>(node, self.variance, x, y);
        let q = self.edges[1].place::<N, CURVED>(node, self.variance, x, y);
        let (mut a, mut b, mut along_a, mut along_b) = (zero, zero, zero, zero);
        for i in 0..N {
            a[i] = p.distance[i] * self.inverse;
            b[i] = q.distance[i] * self.inverse;
            along_a[i] = (b[i] - self.rho * a[i]) * self.cosecant;
            along_b[i] = (a[i] - self.rho * b[i]) * self.cosecant;
        }
        let ((edge_a, bell_a), (edge_b, bell_b)) = (step(&a), step(&b));
        let ((far_a, fade_a), far_b) = (step(&along_a), edge(&along_b));
        let bulge = self.bulge(&a, &b);
        let (mut by_p, mut by_q, mut by_angle) = (zero, zero, zero);
        let slope = T::of(2.0 * DENSITY) * self.inverse * node.weight;
        let turn = T::of(std::f64::consts::FRAC_2_PI) * node.weight;
        for i in 0..N {
            sum.value[i] += node.weight * (edge_a[i] * edge_b[i] + bulge[i]);
            by_p[i] = slope * bell_a[i] * far_a[i];
            by_q[i] = slope * bell_b[i] * far_b[i];
            by_angle[i] = turn * bell_a[i] * fade_a[i];
            sum.normals[0][i] += by_angle[i];
            sum.normals[1][i] -= by_angle[i];
        }
        self.add_edge::<N, CURVED>(0, &p, &by_p, sum);
        self.add_edge::<N, CURVED>(1, &q, &by_q, sum);
    }

    /// `E[sign u sign v] - E[sign u] E[sign v]` for two unit normal variables about (a, b) with correlation rho.
    #[inline(always)]
    fn bulge<const N: usize>(&self, a: &[T; N], b: &[T; N]) -> [T; N] {
        let zero = [T::of(0.0); N];
        let (mut sum, mut squares, mut products) = (zero, zero, zero);
        for i in 0..N {
            (squares[i], products[i]) = (a[i] * a[i] + b[i] * b[i], a[i] * b[i]);
        }
        for (square, product, weight) in &self.integral[..self.terms] {
            let mut exponent = zero;
            for i in 0..N {
                exponent[i] = *square * squares[i] - *product * products[i];
            }
            let term = exp_minus(&exponent);
            for i in 0..N {
                sum[i] += *weight * term[i];
            }
        }
        sum
    }

    /// Only edge `which` is near; `side` is the sign of the distance from the other.
    #[inline(always)]
    #[expect(clippy::needless_range_loop, reason = "many arrays side by side")]
    pub(super) fn edge<const N: usize, const CURVED: bool>(&self, which: usize, side: &[T; N], x: &[T; N], y: &[T; N]) -> Field<T, N> {
        let mut sum = Field::constant([T::of(0.0); N]);
        for node in &self.nodes[..self.count] {
            let p = self.edges[which].place::<N, CURVED>(node, self.variance, x, y);
            let mut a = [T::of(0.0); N];
            for i in 0..N {
                a[i] = p.distance[i] * self.inverse;
            }
            let (edge, bell) = step(&a);
            let slope = T::of(2.0 * DENSITY) * self.inverse * node.weight;
            let mut by = [T::of(0.0); N];
            for i in 0..N {
                sum.value[i] += node.weight * side[i] * edge[i];
                by[i] = slope * side[i] * bell[i];
            }
            self.add_edge::<N, CURVED>(which, &p, &by, &mut sum);
        }
        sum
    }

    #[expect(clippy::needless_range_loop, reason = "many arrays side by side")]
    /// Adds the derivatives of which `by` is that by the distance from edge `which`.
    #[inline(always)]
    fn add_edge<const N: usize, const CURVED: bool>(&self, which: usize, p: &Place<T, N>, by: &[T; N], sum: &mut Field<T, N>) {
        let Edge { nx, ny, curvature } = self.edges[which];
        let half = T::of(0.5);
        let by_variance = half * self.inverse * self.inverse;
        for i in 0..N {
            let (along, straight) = (p.along[i], p.straight[i]);
            let (bend, lean) = if CURVED { (curvature * along, curvature * along * straight) } else { (T::of(0.0), T::of(0.0)) };
            sum.position[0][i] -= by[i] * (nx - bend * ny);
            sum.position[1][i] -= by[i] * (ny + bend * nx);
            sum.normals[which][i] += by[i] * (along - lean);
            sum.variance[i] -= by_variance * by[i] * p.distance[i];
            if CURVED {
                sum.variance[i] += half * curvature * by[i];
                sum.curvature[which][i] += half * by[i] * (along * along + self.variance);
            }
        }
    }
}

/// Where points lie with regard to an edge, px: the distance from it, that from its tangent at the corner, and the way along it.
struct Place<T, const N: usize> {
    distance: [T; N],
    straight: [T; N],
    along: [T; N],
}

impl<T: Real> Edge<T> {
    /// The distance of (`x`, `y`), taken from the corner, px. That from a curve is right to the second order of its curvature.
    #[inline(always)]
    pub(super) fn distance(&self, x: T, y: T) -> T {
        let along = self.nx * y - self.ny * x;
        self.nx * x + self.ny * y + T::of(0.5) * self.curvature * along * along
    }

    /// `variance` is the blur's, px^2: it moves a curved edge to its hollow side, by the mean of what it averages.
    #[inline(always)]
    fn place<const N: usize, const CURVED: bool>(&self, node: &Node<T>, variance: T, x: &[T; N], y: &[T; N]) -> Place<T, N> {
        let zero = [T::of(0.0); N];
        let mut place = Place { distance: zero, straight: zero, along: zero };
        for i in 0..N {
            let (x, y) = (x[i] + node.x, y[i] + node.y);
            place.straight[i] = self.nx * x + self.ny * y;
            place.along[i] = self.nx * y - self.ny * x;
            place.distance[i] = place.straight[i];
            if CURVED {
                place.distance[i] += T::of(0.5) * self.curvature * (place.along[i] * place.along[i] + variance);
            }
        }
        place
    }
}

/// The nodes of `(2 / pi)` times the integral over the arc sine of the correlation from 0 to `angle`, of
/// `exp(-(u^2 - 2 sin t uv + v^2) / (2 cos^2 t))`, as (factor of u^2 + v^2, factor of uv, weight).
///
/// An error of 4e-8 with two nodes up to 8 degrees, of 2e-7 with four up to 40, of 3e-8 with eight up to 65.
fn correlation(angle: f64) -> ([(f64, f64, f64); 8], usize) {
    let rule = match angle.abs() {
        small if small < 0.15 => &RULES[0],
        middling if middling < 0.7 => &RULES[1],
        _ => &RULES[2],
    };
    let mut nodes = [(0.0, 0.0, 0.0); 8];
    for (slot, (node, weight)) in nodes.iter_mut().zip(rule) {
        let (sine, cosine) = (angle * node).sin_cos();
        let c2 = cosine * cosine;
        *slot = (0.5 / c2, sine / c2, weight * angle * std::f64::consts::FRAC_2_PI);
    }
    (nodes, rule.len())
}
