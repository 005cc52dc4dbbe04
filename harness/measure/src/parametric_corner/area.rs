//! What the pixel's area does to a grey value beyond widening the blur by its variance.

use super::model::Model;
use super::single::{WIDE, Wide, exp_minus, step};

/// A chunk of pixels, seen from the two edges, px: the distance from the tangents at the corner, and the way along them.
pub(super) struct Seen {
    straight: [Wide; 2],
    along: [Wide; 2],
}

impl Model {
    /// `x` and `y` are taken from the corner, px.
    #[inline(always)]
    pub(super) fn seen(&self, x: &Wide, y: &Wide) -> Seen {
        let mut seen = Seen { straight: [[0.0; WIDE]; 2], along: [[0.0; WIDE]; 2] };
        for (which, edge) in self.edges.iter().enumerate() {
            let (nx, ny) = (edge.nx as f32, edge.ny as f32);
            for i in 0..WIDE {
                seen.straight[which][i] = nx * x[i] + ny * y[i];
                seen.along[which][i] = nx * y[i] - ny * x[i];
            }
        }
        seen
    }

    /// Distances from edge `which` in units of the blur, for the Gaussian of the pixel that lies at `offset`.
    #[inline(always)]
    #[expect(clippy::needless_range_loop, reason = "many arrays side by side")]
    fn scaled<const CURVED: bool>(&self, which: usize, seen: &Seen, offset: [f64; 2]) -> Wide {
        let edge = &self.edges[which];
        let inverse = self.inverse as f32;
        let straight = (edge.nx * offset[0] + edge.ny * offset[1]) as f32;
        let along = (edge.nx * offset[1] - edge.ny * offset[0]) as f32;
        let (bend, variance) = (0.5 * edge.curvature as f32, self.variance as f32);
        let mut scaled = [0.0; WIDE];
        for i in 0..WIDE {
            let mut distance = seen.straight[which][i] + straight;
            if CURVED {
                let along = seen.along[which][i] + along;
                distance += bend * (along * along + variance);
            }
            scaled[i] = distance * inverse;
        }
        scaled
    }

    /// The grey value where both edges are near, in units of half the contrast: to 1e-6 that of [`Model::corner`].
    #[inline(always)]
    pub(super) fn corner_value<const CURVED: bool>(&self, seen: &Seen) -> Wide {
        let mut sum = [0.0; WIDE];
        for node in &self.nodes[..self.count] {
            let [a, b] = [0, 1].map(|which| self.scaled::<CURVED>(which, seen, [node.x, node.y]));
            let (edge_a, edge_b) = (step(&a), step(&b));
            let (mut squares, mut product, mut value) = ([0.0; WIDE], [0.0; WIDE], [0.0; WIDE]);
            for i in 0..WIDE {
                squares[i] = a[i] * a[i] + b[i] * b[i];
                product[i] = a[i] * b[i];
                value[i] = edge_a[i] * edge_b[i];
            }
            for (square, mixed, weight) in &self.integral[..self.terms] {
                let (square, mixed, weight) = (*square as f32, *mixed as f32, *weight as f32);
                let mut exponent = [0.0; WIDE];
                for i in 0..WIDE {
                    exponent[i] = square * squares[i] - mixed * product[i];
                }
                let term = exp_minus(&exponent);
                for i in 0..WIDE {
                    value[i] += weight * term[i];
                }
            }
            for i in 0..WIDE {
                sum[i] += node.weight as f32 * value[i];
            }
        }
        sum
    }

    /// The grey value where edge `which` alone is near, up to its sign.
    #[inline(always)]
    pub(super) fn edge_value<const CURVED: bool>(&self, which: usize, seen: &Seen) -> Wide {
        let mut sum = [0.0; WIDE];
        for node in &self.nodes[..self.count] {
            let edge = step(&self.scaled::<CURVED>(which, seen, [node.x, node.y]));
            for i in 0..WIDE {
                sum[i] += node.weight as f32 * edge[i];
            }
        }
        sum
    }
}
