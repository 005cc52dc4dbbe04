//! Where an outline's edge is, profile by profile.

use calibench_model::Image;
use nalgebra::{SMatrix, SVector, Vector2};

use crate::ellipse::Ellipse;
use crate::lanes::{DENSITY, LANES, step};
use crate::marquardt::{Normal, Problem, minimise};

/// Samples of a profile are this far apart, px.
const SPACING: f64 = 0.5;
/// Samples to either side of the outline.
const HALF: usize = 8;
const SAMPLES: usize = 2 * HALF + 1;
/// Inwards a profile ends at this fraction of the smaller semi-axis: beyond the centre lies the opposite edge.
const INWARDS: f64 = 0.8;
/// Profiles for each px of the outline: many, so that what interpolation does to each averages out.
pub(super) const DENSELY: f64 = 4.0;

/// A profile across the outline, from inside to outside.
pub(super) struct Profile {
    foot: Vector2<f64>,
    normal: Vector2<f64>,
    grey: [f64; SAMPLES],
    /// The first sample that is taken.
    first: usize,
}

/// The edge that all profiles have in common: grey values inside and outside, and the blur, px.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    inside: f64,
    outside: f64,
    blur: f64,
}

/// Profiles across an ellipse, [`DENSELY`]; `None` when one leaves the image.
pub(super) fn profiles(image: &Image, ellipse: &Ellipse) -> Option<Vec<Profile>> {
    let [large, small] = ellipse.semi_axes();
    // A multiple of eight: in an image that is turned or reflected the same profiles are taken.
    let count = 8 * (DENSELY * std::f64::consts::PI * (large + small) / 8.0).ceil().max(3.0) as usize;
    let first = HALF - ((INWARDS * small / SPACING) as usize).clamp(2, HALF);
    (0..count)
        .map(|i| {
            let (offset, tangent) = ellipse.point(std::f64::consts::TAU * i as f64 / count as f64);
            let normal = Vector2::new(tangent.y, -tangent.x).normalize();
            let foot = Vector2::from(ellipse.position) + offset;
            let mut grey = [0.0; SAMPLES];
            for (sample, grey) in grey.iter_mut().enumerate().skip(first) {
                *grey = interpolate(image, foot + normal * distance(sample))?;
            }
            Some(Profile { foot, normal, grey, first })
        })
        .collect()
}

fn distance(sample: usize) -> f64 {
    (sample as f64 - HALF as f64) * SPACING
}

/// Bilinear.
fn interpolate(image: &Image, at: Vector2<f64>) -> Option<f64> {
    let (x, y) = (at.x.floor(), at.y.floor());
    if !image.holds(x as i64, y as i64, 0) || !image.holds(x as i64 + 1, y as i64 + 1, 0) {
        return None;
    }
    let (fx, fy, x, y) = (at.x - x, at.y - y, x as usize, y as usize);
    let row = |y: usize| f64::from(image.at(x, y)) * (1.0 - fx) + f64::from(image.at(x + 1, y)) * fx;
    Some(row(y) * (1.0 - fy) + row(y + 1) * fy)
}

/// A blurred step and its slope at a distance from the edge, in blurs.
fn blurred(distance: f64) -> (f64, f64) {
    let (edge, bell) = step(&[distance; LANES]);
    (edge[0], DENSITY * bell[0])
}

/// Mean, half the difference and variance of the blur of the mean profile.
struct Common {
    grey: [f64; SAMPLES],
    first: usize,
}

impl Problem<4> for Common {
    fn normal(&mut self, x: &SVector<f64, 4>) -> Option<Normal<4>> {
        let blur = x[2];
        let mut normal = Normal { n: SMatrix::zeros(), b: SVector::zeros(), omega: 0.0 };
        for (sample, grey) in self.grey.iter().enumerate().skip(self.first) {
            let t = (distance(sample) - x[0]) / blur;
            let (edge, slope) = blurred(t);
            let j = SVector::from([-2.0 * x[1] * slope / blur, edge, -2.0 * x[1] * slope * t / blur, 1.0]);
            let r = grey - x[3] - x[1] * edge;
            normal.n += j * j.transpose();
            normal.b += j * r;
            normal.omega += r * r;
        }
        x.iter().all(|value| value.is_finite()).then_some(normal)
    }

    fn lowest(&self, unknown: usize) -> f64 {
        if unknown == 2 { 0.2 } else { f64::NEG_INFINITY }
    }

    fn redundancy(&self) -> f64 {
        (SAMPLES - self.first) as f64 - 4.0
    }
}

/// The edge of the mean of all profiles: its own place does not matter.
pub(super) fn common(profiles: &[Profile]) -> Option<Edge> {
    let mut grey = [0.0; SAMPLES];
    for profile in profiles {
        for (sum, value) in grey.iter_mut().zip(&profile.grey) {
            *sum += value / profiles.len() as f64;
        }
    }
    let first = profiles.first()?.first;
    let (inside, outside) = (grey[first], grey[SAMPLES - 1]);
    let start = SVector::from([0.0, 0.5 * (outside - inside), 0.8, 0.5 * (outside + inside)]);
    let x = minimise(&mut Common { grey, first }, start, 1e-2)?.x;
    Some(Edge { inside: x[3] - x[1], outside: x[3] + x[1], blur: x[2] })
}

impl Profile {
    /// The point where the profile crosses the edge: the shift that agrees best with the common edge, in the least-squares sense.
    pub(super) fn crossing(&self, edge: &Edge) -> Option<Vector2<f64>> {
        let (mean, half) = (0.5 * (edge.inside + edge.outside), 0.5 * (edge.outside - edge.inside));
        let mut shift = 0.0;
        for _ in 0..4 {
            let (mut n, mut b) = (0.0, 0.0);
            for (sample, grey) in self.grey.iter().enumerate().skip(self.first) {
                let (value, slope) = blurred((distance(sample) - shift) / edge.blur);
                let j = -2.0 * half * slope / edge.blur;
                n += j * j;
                b += j * (grey - mean - half * value);
            }
            shift += (b / n).clamp(-1.0, 1.0);
        }
        (shift.abs() < HALF as f64 * SPACING).then(|| self.foot + self.normal * shift)
    }
}
