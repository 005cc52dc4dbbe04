//! The curves of a border in the image: how they run, and what an affine map's parameters do to them.

use calibench_model::Affine;

use super::mask::map;
use super::profile::LANES;

/// Affine parameters and the position: planes 0 to 5.
pub(super) const MOVING: usize = 6;

/// How a curve's functions make the derivatives by the [`MOVING`] parameters.
#[derive(Clone, Copy, Debug)]
pub(super) enum Expansion {
    /// Of the functions 1 and t.
    Line(Line),
    /// Of cosine, sine, and their products: factors of each for each parameter.
    Arc([[f32; 5]; MOVING]),
}

/// A line's steps dx, dy in the image, px, and what its mask coordinates u and v are of 1 and t.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    step: [f32; 2],
    u: [f32; 2],
    v: [f32; 2],
}

impl Line {
    #[inline(always)]
    pub(super) fn new(from: [f64; 2], to: [f64; 2], step: [f64; 2]) -> Self {
        let single = |pair: [f64; 2]| pair.map(|value| value as f32);
        Self { step: single(step), u: single([from[0], to[0] - from[0]]), v: single([from[1], to[1] - from[1]]) }
    }

    /// Adds a line's integrals of `K` times 1 and t to the derivatives: `q x dp` is `dy` or `-dx`, times 1, u or v.
    #[inline(always)]
    pub(super) fn expand(&self, [one, t]: &[[f32; LANES]; 2], moving: &mut [[f32; LANES]; MOVING]) {
        let [dx, dy] = self.step;
        for lane in 0..LANES {
            let u = self.u[0] * one[lane] + self.u[1] * t[lane];
            let v = self.v[0] * one[lane] + self.v[1] * t[lane];
            moving[0][lane] += dy * one[lane];
            moving[1][lane] -= dx * one[lane];
            moving[2][lane] += dy * u;
            moving[3][lane] += dy * v;
            moving[4][lane] -= dx * u;
            moving[5][lane] -= dx * v;
        }
    }
}

/// An arc in the image; its steps are combinations of cosine and sine.
pub(super) struct Arc {
    centre: [f64; 2],
    radius: f64,
    step: [[f64; 2]; 2],
    pub(super) expansion: [[f64; 5]; MOVING],
}

impl Arc {
    #[inline(always)]
    pub(super) fn new(a: &Affine, centre: [f64; 2], radius: f64, sweep: f64, sense: f64) -> Self {
        let scale = radius * sweep * sense;
        let (dx, dy) = ([a.axy * scale, -a.axx * scale], [a.ayy * scale, -a.ayx * scale]);
        // The centre's coordinate plus the radius times cosine (of u) or sine (of v), times a step.
        let u = |[c, s]: [f64; 2]| [centre[0] * c, centre[0] * s, radius * c, radius * s, 0.0];
        let v = |[c, s]: [f64; 2]| [centre[1] * c, centre[1] * s, 0.0, radius * c, radius * s];
        let only = |[c, s]: [f64; 2]| [c, s, 0.0, 0.0, 0.0];
        let back = dx.map(|d| -d);
        Self { centre, radius, step: [dx, dy], expansion: [only(dy), only(back), u(dy), v(dy), u(back), v(back)] }
    }

    #[inline(always)]
    pub(super) fn at(&self, a: &Affine, reference: [f64; 2], (sine, cosine): (f64, f64)) -> ([f64; 2], [f64; 2]) {
        let [x, y] = map(a, [self.centre[0] + self.radius * cosine, self.centre[1] + self.radius * sine]);
        ([reference[0] + x, reference[1] + y], self.step.map(|[c, s]| c * cosine + s * sine))
    }
}

/// Adds an arc's integrals of `K` times its functions to the derivatives.
#[inline(always)]
pub(super) fn expand(factors: &[[f32; 5]; MOVING], moments: &[[f32; LANES]; 5], moving: &mut [[f32; LANES]; MOVING]) {
    // One by one: in a loop they would be worked out across the planes, with gathered numbers.
    let [x, y, axx, axy, ayx, ayy] = moving;
    combine(x, &factors[0], moments);
    combine(y, &factors[1], moments);
    combine(axx, &factors[2], moments);
    combine(axy, &factors[3], moments);
    combine(ayx, &factors[4], moments);
    combine(ayy, &factors[5], moments);
}

#[inline(always)]
fn combine(to: &mut [f32; LANES], factors: &[f32; 5], moments: &[[f32; LANES]; 5]) {
    let mut sum = *to;
    for function in 0..5 {
        for lane in 0..LANES {
            sum[lane] += factors[function] * moments[function][lane];
        }
    }
    *to = sum;
}
