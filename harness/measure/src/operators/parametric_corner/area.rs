//! What the photosite's area does to a grey value beyond widening the blur by its variance.

use super::model::{Fidelity, Model, Shape};
use crate::blurred_step::{edge, edges, exp_minus};
use crate::lanes::{BLOCK, Block};
use crate::photosite::Square;

/// A chunk of pixels, seen from the two edges, px: the distance from the tangents at the corner, and the way along them.
pub(super) struct Seen {
    pub(super) straight: [Block; 2],
    along: [Block; 2],
}

impl Model<f32> {
    /// `x` and `y` are taken from the corner, px.
    #[inline(always)]
    pub(super) fn seen(&self, x: &Block, y: &Block) -> Seen {
        let mut seen = Seen { straight: [[0.0; BLOCK]; 2], along: [[0.0; BLOCK]; 2] };
        for (which, edge) in self.edges.iter().enumerate() {
            for i in 0..BLOCK {
                seen.straight[which][i] = edge.nx * x[i] + edge.ny * y[i];
                seen.along[which][i] = edge.nx * y[i] - edge.ny * x[i];
            }
        }
        seen
    }

    /// Distances from edge `which` in units of the blur, for the Gaussian of the photosite that lies at `offset`.
    #[inline(always)]
    #[expect(clippy::needless_range_loop, reason = "many arrays side by side")]
    fn scaled<const CURVED: bool>(&self, which: usize, seen: &Seen, offset: [f32; 2]) -> Block {
        let edge = &self.edges[which];
        let straight = edge.nx * offset[0] + edge.ny * offset[1];
        let along = edge.nx * offset[1] - edge.ny * offset[0];
        let bend = 0.5 * edge.curvature;
        let mut scaled = [0.0; BLOCK];
        for i in 0..BLOCK {
            let mut distance = seen.straight[which][i] + straight;
            if CURVED {
                let along = seen.along[which][i] + along;
                distance += bend * (along * along + self.variance);
            }
            scaled[i] = distance * self.inverse;
        }
        scaled
    }

    /// The grey value where both edges are near, in units of half the contrast: to 1e-6 that of [`Model::corner`].
    #[inline(always)]
    pub(super) fn corner_value<const CURVED: bool>(&self, seen: &Seen) -> Block {
        let mut sum = [0.0; BLOCK];
        for node in &self.nodes[..self.count] {
            let [a, b] = [0, 1].map(|which| self.scaled::<CURVED>(which, seen, [node.x, node.y]));
            let (mut squares, mut product, mut value) = ([0.0; BLOCK], [0.0; BLOCK], edges(&a, &b));
            for i in 0..BLOCK {
                squares[i] = a[i] * a[i] + b[i] * b[i];
                product[i] = a[i] * b[i];
            }
            for (square, mixed, weight) in &self.integral[..self.terms] {
                let mut exponent = [0.0; BLOCK];
                for i in 0..BLOCK {
                    exponent[i] = square * squares[i] - mixed * product[i];
                }
                let term = exp_minus(&exponent);
                for i in 0..BLOCK {
                    value[i] += weight * term[i];
                }
            }
            for i in 0..BLOCK {
                sum[i] += node.weight * value[i];
            }
        }
        sum
    }

    /// The grey value where edge `which` alone is near, up to its sign.
    #[inline(always)]
    pub(super) fn edge_value<const CURVED: bool>(&self, which: usize, seen: &Seen) -> Block {
        let mut sum = [0.0; BLOCK];
        for node in &self.nodes[..self.count] {
            let edge = edge(&self.scaled::<CURVED>(which, seen, [node.x, node.y]));
            for i in 0..BLOCK {
                sum[i] += node.weight * edge[i];
            }
        }
        sum
    }
}

/// What a straight edge sees of the photosite: Gaussians along its normal.
pub(super) struct Strip {
    /// How far from the centre, px, and how much of it.
    nodes: [(f32, f32); 16],
    count: usize,
    /// 1 / the root of the variance of each when blurred, 1/px.
    inverse: f32,
}

impl Strip {
    /// For edge `which` of a shape.
    pub(super) fn of(shape: &Shape, which: usize) -> Self {
        let (width, (sine, cosine)) = (shape.photosite, shape.normals[which].sin_cos());
        let across = Square::for_blur(shape.variance / (width * width), Fidelity::Full).across([cosine, sine]);
        let mut nodes = [(0.0, 0.0); 16];
        for (slot, (offset, weight)) in nodes.iter_mut().zip(across.nodes()) {
            *slot = ((offset * width) as f32, *weight as f32);
        }
        let inverse = 1.0 / (shape.variance + across.variance * width * width).sqrt();
        Self { nodes, count: across.nodes().len(), inverse: inverse as f32 }
    }

    /// As [`Model::edge_value`] with all of the photosite, of a straight edge from which pixels lie `straight` px away.
    #[inline(always)]
    pub(super) fn value(&self, straight: &Block) -> Block {
        let mut sum = [0.0; BLOCK];
        for (offset, weight) in &self.nodes[..self.count] {
            let mut scaled = [0.0; BLOCK];
            for i in 0..BLOCK {
                scaled[i] = (straight[i] + offset) * self.inverse;
            }
            let edge = edge(&scaled);
            for i in 0..BLOCK {
                sum[i] += weight * edge[i];
            }
        }
        sum
    }
}
