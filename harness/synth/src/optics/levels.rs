//! A blur that changes over the frame: rendered at a few levels, interpolated between them at each pixel.

use super::{Kernel, Optics};

/// The largest error of the interpolation, as a fraction of contrast.
const ERROR: f64 = 1e-6;

/// Kernels at Chebyshev nodes of the logarithm of the blur's variance. A grey value as a function of the variance solves the equation of heat, so the
/// interpolating polynomial converges geometrically.
pub(crate) struct Levels {
    /// One kernel for each node.
    pub kernels: Vec<Kernel>,
    /// The nodes and their barycentric weights.
    nodes: Vec<(f64, f64)>,
    middle: [f64; 2],
    /// The variance in the middle, and its growth per px^2 of distance.
    variance: [f64; 2],
}

/// The place of a pixel between the levels of blur: barycentric interpolation over the logarithm of the variance.
#[derive(Clone, Copy, Default)]
pub(crate) struct Place {
    log: f64,
    sum: f64,
}

impl Levels {
    /// For a frame of `width` x `height` px. A blur that does not change has one level.
    pub fn new(optics: &Optics, width: usize, height: usize) -> Self {
        let middle = [(width as f64 - 1.0) / 2.0, (height as f64 - 1.0) / 2.0];
        let low = optics.blur * optics.blur;
        let high = optics.corner_blur.map_or(low, |corner| corner * corner);
        let growth = (high - low) / (middle[0] * middle[0] + middle[1] * middle[1]).max(1.0);
        if high == low {
            return Self { kernels: vec![Kernel::new(optics, optics.blur)], nodes: vec![(0.0, 1.0)], middle, variance: [low, 0.0] };
        }
        let (centre, half) = ((low.ln() + high.ln()) / 2.0, (high.ln() - low.ln()) / 2.0);
        // The singularities lie where the variance turns imaginary: pi/2 off the real axis of its logarithm.
        let distance = std::f64::consts::FRAC_PI_2 / half;
        let rate = distance + (distance * distance + 1.0).sqrt();
        let n = (-ERROR.ln() / rate.ln()).ceil() as usize + 2;
        let node = |i: usize| {
            let angle = std::f64::consts::PI * (i as f64 + 0.5) / n as f64;
            let sign = if i.is_multiple_of(2) { 1.0 } else { -1.0 };
            (centre + half * angle.cos(), sign * angle.sin())
        };
        let nodes: Vec<(f64, f64)> = (0..n).map(node).collect();
        let kernels = nodes.iter().map(|(log, _)| Kernel::new(optics, (log / 2.0).exp())).collect();
        Self { kernels, nodes, middle, variance: [low, growth] }
    }

    /// Where pixel (`x`, `y`) lies between the levels.
    pub fn place(&self, x: f64, y: f64) -> Place {
        let r2 = (x - self.middle[0]).powi(2) + (y - self.middle[1]).powi(2);
        let log = (self.variance[0] + self.variance[1] * r2).ln();
        Place { log, sum: self.nodes.iter().map(|(node, factor)| factor / (log - node)).sum() }
    }

    /// Adds the grey values of one level to `sums`, each with the weight that the level has at the place of its pixel.
    pub fn add(&self, level: usize, places: &[Place], values: &[f64], sums: &mut [f64]) {
        let (node, factor) = self.nodes[level];
        for ((sum, value), place) in sums.iter_mut().zip(values).zip(places) {
            // On a node its own part is infinite, and so is the sum.
            let weight = if place.sum.is_finite() { factor / (place.log - node) / place.sum } else { f64::from(place.log == node) };
            *sum += weight * value;
        }
    }

    /// How far the widest kernel reaches, px, along x and y.
    pub fn reach(&self) -> [f64; 2] {
        self.kernels.iter().map(Kernel::reach).fold([0.0, 0.0], |a, b| [a[0].max(b[0]), a[1].max(b[1])])
    }
}
