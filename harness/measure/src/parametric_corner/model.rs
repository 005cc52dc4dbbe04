//! The grey value of a blurred chess corner, averaged over a pixel, with its derivatives.

use crate::lanes::{DENSITY, LANES, Lanes, exp_minus, step};

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
}

/// A pixel's area as a mixture of Gaussians: `offsets` along each axis with `weights`, each of this `variance`, px^2.
///
/// Up to which order the mixture's cumulants are the unit square's grows with the Gaussians of an axis. Of the contrast, an edge blurred by a Gaussian of
/// standard deviation s is off by 8e-6 with two at s = 0.71, 7e-6 with three at 0.4, 4e-6 with four at 0.3 and 5e-3 at 0.1, all px;
/// without any blur the grey values are 4e-2 off, but the model does not become singular.
struct Pixel {
    offsets: &'static [f64],
    weights: &'static [f64],
    variance: f64,
}

/// One Gaussian of the square's variance: quick, and near enough to begin with.
const ONE: Pixel = Pixel { offsets: &[0.0], weights: &[1.0], variance: 1.0 / 12.0 };
const TWO: Pixel =
    Pixel { offsets: &[-0.254_066_374_077_307_4, 0.254_066_374_077_307_4], weights: &[0.5, 0.5], variance: 0.018_783_610_896_543_05 };
const THREE: Pixel = Pixel {
    offsets: &[-0.345_831_998_689_224, 0.0, 0.345_831_998_689_224],
    weights: &[0.318_902_974_746_591_3, 0.362_194_050_506_817_4, 0.318_902_974_746_591_3],
    variance: 0.007_051_887_868_281_641,
};
const FOUR: Pixel = Pixel {
    offsets: &[-0.393_654_415_751_417_5, -0.142_049_084_498_668_68, 0.142_049_084_498_668_68, 0.393_654_415_751_417_5],
    weights: &[0.222_131_926_791_124_26, 0.277_868_073_208_875_7, 0.277_868_073_208_875_7, 0.222_131_926_791_124_26],
    variance: 0.003_274_906_849_960_283_4,
};

impl Pixel {
    /// As many Gaussians as the blur needs.
    fn for_blur(variance: f64, fidelity: Fidelity) -> &'static Self {
        match variance {
            _ if fidelity == Fidelity::Rough => &ONE,
            v if v > 0.5 => &TWO,
            v if v > 0.16 => &THREE,
            _ => &FOUR,
        }
    }
}

/// How well the pixel's area is integrated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fidelity {
    /// Within a hundredth of the contrast.
    Rough,
    /// As far as anything can be seen of it.
    Full,
}

/// Half of the nodes and the weights of Gauss and Legendre of order 2, 4 and 8.
const LEGENDRE: [&[(f64, f64)]; 3] = [
    &[(0.577_350_269_189_625_8, 1.0)],
    &[(0.861_136_311_594_052_6, 0.347_854_845_137_453_74), (0.339_981_043_584_856_3, 0.652_145_154_862_545_2)],
    &[
        (0.960_289_856_497_536_3, 0.101_228_536_290_376_18),
        (0.796_666_477_413_626_8, 0.222_381_034_453_374_4),
        (0.525_532_409_916_329, 0.313_706_645_877_887_4),
        (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    ],
];

/// One Gaussian of the pixel: offset from its centre (px) and weight.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Node {
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) weight: f64,
}

/// A straight or curved edge: the cosine and sine of its normal's direction, its curvature.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    pub(super) nx: f64,
    pub(super) ny: f64,
    pub(super) curvature: f64,
}

/// All that a chunk of pixels needs to know of a shape.
pub(super) struct Model {
    pub(super) edges: [Edge; 2],
    pub(super) nodes: [Node; 16],
    pub(super) count: usize,
    /// Variance of the blurred Gaussians of the pixel, px^2, and 1 / its root.
    pub(super) variance: f64,
    pub(super) inverse: f64,
    /// Cosine and sine of the angle between the normals.
    rho: f64,
    sine: f64,
    /// `(2 / pi) integral of exp(-a (u^2 + v^2) + b u v)`: a, b and weight at each node.
    pub(super) integral: [(f64, f64, f64); 8],
    pub(super) terms: usize,
    /// Distance from an edge, px, from which on it is not seen.
    pub(super) reach: f64,
}

/// A grey value in units of half the contrast, and its derivatives by the [`Shape`].
#[derive(Clone, Copy, Default)]
pub(super) struct Field {
    pub(super) value: Lanes,
    pub(super) position: [Lanes; 2],
    pub(super) normals: [Lanes; 2],
    pub(super) variance: Lanes,
    pub(super) curvature: [Lanes; 2],
}

impl Model {
    /// `None` for edges that are parallel to 3 degrees.
    pub(super) fn new(shape: &Shape, fidelity: Fidelity) -> Option<Self> {
        let (sine, rho) = (shape.normals[1] - shape.normals[0]).sin_cos();
        if sine.is_nan() || sine < 0.05 {
            return None;
        }
        let pixel = Pixel::for_blur(shape.variance, fidelity);
        let (mut nodes, mut count) = ([Node::default(); 16], 0);
        for (y, wy) in pixel.offsets.iter().zip(pixel.weights) {
            for (x, wx) in pixel.offsets.iter().zip(pixel.weights) {
                nodes[count] = Node { x: *x, y: *y, weight: wx * wy };
                count += 1;
            }
        }
        let edge = |i: usize| {
            let (ny, nx) = shape.normals[i].sin_cos();
            Edge { nx, ny, curvature: shape.curvature[i] }
        };
        let (integral, terms) = correlation(rho.asin());
        let variance = shape.variance + pixel.variance;
        let blur = variance.sqrt();
        // Half a pixel's diagonal, and five standard deviations: 3e-7 of the contrast.
        let reach = std::f64::consts::FRAC_1_SQRT_2 + 5.0 * blur;
        Some(Self { edges: [edge(0), edge(1)], nodes, count, variance, inverse: 1.0 / blur, rho, sine, integral, terms, reach })
    }

    /// Both edges are near.
    #[inline(always)]
    pub(super) fn corner<const CURVED: bool>(&self, x: &Lanes, y: &Lanes) -> Field {
        let mut sum = Field::default();
        for node in &self.nodes[..self.count] {
            self.add_corner::<CURVED>(node, x, y, &mut sum);
        }
        sum
    }

    #[inline(always)]
    fn add_corner<const CURVED: bool>(&self, node: &Node, x: &Lanes, y: &Lanes, sum: &mut Field) {
        let p = self.edges[0].place::<CURVED>(node, self.variance, x, y);
        let q = self.edges[1].place::<CURVED>(node, self.variance, x, y);
        let (mut a, mut b, mut along_a, mut along_b) = ([0.0; LANES], [0.0; LANES], [0.0; LANES], [0.0; LANES]);
        for i in 0..LANES {
            a[i] = p.distance[i] * self.inverse;
            b[i] = q.distance[i] * self.inverse;
            along_a[i] = (b[i] - self.rho * a[i]) / self.sine;
            along_b[i] = (a[i] - self.rho * b[i]) / self.sine;
        }
        let ((edge_a, bell_a), (edge_b, bell_b)) = (step(&a), step(&b));
        let ((far_a, fade_a), (far_b, _)) = (step(&along_a), step(&along_b));
        let bulge = self.bulge(&a, &b);
        let (mut by_p, mut by_q, mut by_angle) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        let slope = 2.0 * DENSITY * self.inverse * node.weight;
        for i in 0..LANES {
            sum.value[i] += node.weight * (edge_a[i] * edge_b[i] + bulge[i]);
            by_p[i] = slope * bell_a[i] * far_a[i];
            by_q[i] = slope * bell_b[i] * far_b[i];
            by_angle[i] = node.weight * std::f64::consts::FRAC_2_PI * bell_a[i] * fade_a[i];
            sum.normals[0][i] += by_angle[i];
            sum.normals[1][i] -= by_angle[i];
        }
        self.add_edge::<CURVED>(0, &p, &by_p, sum);
        self.add_edge::<CURVED>(1, &q, &by_q, sum);
    }

    /// `E[sign u sign v] - E[sign u] E[sign v]` for two unit normal variables about (a, b) with correlation rho.
    #[inline(always)]
    fn bulge(&self, a: &Lanes, b: &Lanes) -> Lanes {
        let mut sum = [0.0; LANES];
        for (square, product, weight) in &self.integral[..self.terms] {
            let mut exponent = [0.0; LANES];
            for i in 0..LANES {
                exponent[i] = square * (a[i] * a[i] + b[i] * b[i]) - product * (a[i] * b[i]);
            }
            let term = exp_minus(&exponent);
            for i in 0..LANES {
                sum[i] += weight * term[i];
            }
        }
        sum
    }

    /// Only edge `which` is near; `side` is the sign of the distance from the other.
    #[inline(always)]
    pub(super) fn edge<const CURVED: bool>(&self, which: usize, side: &Lanes, x: &Lanes, y: &Lanes) -> Field {
        let mut sum = Field::default();
        for node in &self.nodes[..self.count] {
            let p = self.edges[which].place::<CURVED>(node, self.variance, x, y);
            let a = p.distance.map(|distance| distance * self.inverse);
            let (edge, bell) = step(&a);
            let mut by = [0.0; LANES];
            for i in 0..LANES {
                sum.value[i] += node.weight * side[i] * edge[i];
                by[i] = 2.0 * DENSITY * self.inverse * node.weight * side[i] * bell[i];
            }
            self.add_edge::<CURVED>(which, &p, &by, &mut sum);
        }
        sum
    }

    #[expect(clippy::needless_range_loop, reason = "many arrays side by side")]
    /// Adds the derivatives of which `by` is that by the distance from edge `which`.
    #[inline(always)]
    fn add_edge<const CURVED: bool>(&self, which: usize, p: &Place, by: &Lanes, sum: &mut Field) {
        let Edge { nx, ny, curvature } = self.edges[which];
        for i in 0..LANES {
            let (bend, lean) = if CURVED { (curvature * p.along[i], curvature * p.along[i] * p.straight[i]) } else { (0.0, 0.0) };
            sum.position[0][i] -= by[i] * (nx - bend * ny);
            sum.position[1][i] -= by[i] * (ny + bend * nx);
            sum.normals[which][i] += by[i] * (p.along[i] - lean);
            sum.variance[i] -= 0.5 * self.inverse * self.inverse * by[i] * p.distance[i];
            if CURVED {
                sum.variance[i] += 0.5 * curvature * by[i];
                sum.curvature[which][i] += 0.5 * by[i] * (p.along[i] * p.along[i] + self.variance);
            }
        }
    }
}

/// Where points lie with regard to an edge, px: the distance from it, that from its tangent at the corner, and the way along it.
struct Place {
    distance: Lanes,
    straight: Lanes,
    along: Lanes,
}

impl Edge {
    /// The distance of (`x`, `y`), taken from the corner, px. That from a curve is right to the second order of its curvature.
    #[inline(always)]
    pub(super) fn distance(&self, x: f64, y: f64) -> f64 {
        let along = self.nx * y - self.ny * x;
        self.nx * x + self.ny * y + 0.5 * self.curvature * along * along
    }

    /// `variance` is the blur's, px^2: it moves a curved edge to its hollow side, by the mean of what it averages.
    #[inline(always)]
    fn place<const CURVED: bool>(&self, node: &Node, variance: f64, x: &Lanes, y: &Lanes) -> Place {
        let mut place = Place { distance: [0.0; LANES], straight: [0.0; LANES], along: [0.0; LANES] };
        for i in 0..LANES {
            let (x, y) = (x[i] + node.x, y[i] + node.y);
            place.straight[i] = self.nx * x + self.ny * y;
            place.along[i] = self.nx * y - self.ny * x;
            let sag = if CURVED { 0.5 * self.curvature * (place.along[i] * place.along[i] + variance) } else { 0.0 };
            place.distance[i] = place.straight[i] + sag;
        }
        place
    }
}

/// The nodes of `(2 / pi)` times the integral over the arc sine of the correlation from 0 to `angle`, of
/// `exp(-(u^2 - 2 sin t uv + v^2) / (2 cos^2 t))`, as (factor of u^2 + v^2, factor of uv, weight).
///
/// An error of 4e-8 with two nodes up to 8 degrees, of 2e-7 with four up to 40, of 3e-8 with eight up to 65.
fn correlation(angle: f64) -> ([(f64, f64, f64); 8], usize) {
    let half = match angle.abs() {
        small if small < 0.15 => LEGENDRE[0],
        middling if middling < 0.7 => LEGENDRE[1],
        _ => LEGENDRE[2],
    };
    let (mut nodes, mut terms) = ([(0.0, 0.0, 0.0); 8], 0);
    for &(node, weight) in half {
        for node in [node, -node] {
            let (sine, cosine) = (0.5 * angle * (1.0 + node)).sin_cos();
            let c2 = cosine * cosine;
            nodes[terms] = (0.5 / c2, sine / c2, weight * angle / std::f64::consts::PI);
            terms += 1;
        }
    }
    (nodes, terms)
}
