//! Drawings of the design's targets, to be held against what is seen.

use calibench_model::TargetKind;
use calibench_model::target::BAR;

use crate::design::Design;
use crate::normal::{Normal, SIDE};
use crate::smooth::gaussian;

/// Turns of a drawing are this far apart at most, radians.
const TURN: f64 = 0.14;
/// Samples to a pixel and axis.
const SAMPLES: usize = 4;
/// How far around a target's farthest point it is compared, px of the normal image.
const AROUND: f64 = 3.0;

/// The kinds of a coded field, in the order of its codes.
pub(crate) const KINDS: [TargetKind; 4] = [TargetKind::Square, TargetKind::Triangle, TargetKind::Cross, TargetKind::Disc];

/// The drawings of every kind in both sizes.
#[derive(Clone, Debug)]
pub(crate) struct Bank {
    /// By [`index`].
    shapes: Vec<Shape>,
}

/// A kind of one size.
#[derive(Clone, Debug)]
struct Shape {
    /// Pixels from the middle of a drawing to its border.
    half: usize,
    /// Pixels that are compared: columns of each row, from the middle.
    reach: f64,
    /// After which turn it looks the same, radians.
    period: f64,
    /// Turned by equal parts of the period.
    drawings: Vec<Vec<f32>>,
}

fn index(kind: TargetKind, large: bool) -> usize {
    KINDS.iter().position(|known| *known == kind).unwrap_or(0) + if large { 4 } else { 0 }
}

/// After which turn a kind looks the same, radians.
fn period(kind: TargetKind) -> f64 {
    match kind {
        TargetKind::Triangle => std::f64::consts::TAU / 3.0,
        _ => std::f64::consts::FRAC_PI_2,
    }
}

/// Whether a place (in sizes, v down) is on a target.
fn is_on(kind: TargetKind, [u, v]: [f64; 2]) -> bool {
    let (a, b) = (u.abs(), v.abs());
    match kind {
        TargetKind::Square => a.max(b) <= 0.5,
        TargetKind::Triangle => {
            let height = 3_f64.sqrt() / 2.0;
            v <= height / 3.0 && 2.0 * a * height <= v + height * 2.0 / 3.0
        }
        TargetKind::Cross => (a <= 0.5 && b <= 0.5 * BAR) || (b <= 0.5 && a <= 0.5 * BAR),
        _ => u.hypot(v) <= 0.5,
    }
}

/// The farthest point, in sizes.
fn reach(kind: TargetKind) -> f64 {
    match kind {
        TargetKind::Square => 0.5_f64.sqrt(),
        TargetKind::Triangle => 1.0 / 3_f64.sqrt(),
        TargetKind::Cross => 0.5_f64.hypot(0.5 * BAR),
        _ => 0.5,
    }
}

impl Bank {
    /// Without blur.
    pub fn of(design: &Design) -> Self {
        let size = |kind: TargetKind, large: bool| {
            let same = |p: &&crate::design::Printed| p.kind == kind && p.large == large;
            design.cells.iter().flatten().find(same).map_or(0.1, |p| p.axes[0][0].hypot(p.axes[0][1])) * SIDE as f64
        };
        let all = [false, true].into_iter().flat_map(|large| KINDS.map(|kind| (kind, large)));
        // Two kinds of a size group are compared over the same pixels.
        let farthest = |kind: TargetKind, large: bool| {
            let pair = if matches!(kind, TargetKind::Square | TargetKind::Triangle) { [KINDS[0], KINDS[1]] } else { [KINDS[2], KINDS[3]] };
            pair.into_iter().map(|kind| reach(kind) * size(kind, large)).fold(0.0, f64::max) + AROUND
        };
        Self { shapes: all.map(|(kind, large)| Shape::drawn(kind, size(kind, large), farthest(kind, large))).collect() }
    }

    /// The same drawings under a Gaussian blur, px of the normal image along its rows and columns, ready to be compared.
    pub fn blurred(&self, sigmas: [f64; 2]) -> Self {
        let kernels = sigmas.map(gaussian);
        let shapes = self.shapes.iter().map(|shape| Shape {
            drawings: shape.drawings.iter().map(|drawing| shape.normalised(shape.smoothed(drawing, &kernels))).collect(),
            ..shape.clone()
        });
        Self { shapes: shapes.collect() }
    }

    /// The correlation of what is seen around a place with a kind that is turned so (radians), or in the turn that fits best. Of a blurred bank.
    pub fn likeness(&self, normal: &Normal, centre: [f64; 2], (kind, large): (TargetKind, bool), turn: Option<f64>) -> f64 {
        let shape = &self.shapes[index(kind, large)];
        let patch = shape.normalised(shape.seen(normal, centre));
        let compare = |drawing: &Vec<f32>| f64::from(dot(&patch, drawing));
        match turn {
            Some(turn) => {
                let n = shape.drawings.len();
                let part = (turn / shape.period).rem_euclid(1.0);
                compare(&shape.drawings[(part * n as f64).round() as usize % n])
            }
            None => shape.drawings.iter().map(compare).fold(-1.0, f64::max),
        }
    }
}

impl Shape {
    fn drawn(kind: TargetKind, size: f64, reach: f64) -> Self {
        let half = reach.ceil() as usize;
        let turns = if kind == TargetKind::Disc { 1 } else { (period(kind) / TURN).ceil() as usize };
        let drawing = |turn: usize| {
            let (s, c) = (period(kind) * turn as f64 / turns as f64).sin_cos();
            let sample = |i: usize| (i as f64 + 0.5) / SAMPLES as f64 - 0.5;
            let value = |x: f64, y: f64| is_on(kind, [(c * x + s * y) / size, (c * y - s * x) / size]);
            let pixel = |at: usize| {
                let [x, y] = [at % (2 * half + 1), at / (2 * half + 1)].map(|i| i as f64 - half as f64);
                let on = (0..SAMPLES * SAMPLES).filter(|k| value(x + sample(k % SAMPLES), y + sample(k / SAMPLES))).count();
                on as f32 / (SAMPLES * SAMPLES) as f32
            };
            (0..(2 * half + 1).pow(2)).map(pixel).collect()
        };
        Self { half, reach, period: period(kind), drawings: (0..turns).map(drawing).collect() }
    }

    fn side(&self) -> usize {
        2 * self.half + 1
    }

    fn smoothed(&self, drawing: &[f32], [along, across]: &[Vec<f32>; 2]) -> Vec<f32> {
        let side = self.side();
        let pass = |values: &[f32], kernel: &[f32], step: usize| {
            let reach = (kernel.len() / 2) as i64;
            let mut out = vec![0.0_f32; values.len()];
            for (at, sum) in out.iter_mut().enumerate() {
                let place = (if step == 1 { at % side } else { at / side }) as i64;
                for (k, weight) in kernel.iter().enumerate() {
                    let from = place + k as i64 - reach;
                    if (0..side as i64).contains(&from) {
                        *sum += weight * values[(at as i64 + (from - place) * step as i64) as usize];
                    }
                }
            }
            out
        };
        pass(&pass(drawing, along, 1), across, side)
    }

    fn seen(&self, normal: &Normal, [x, y]: [f64; 2]) -> Vec<f32> {
        let offset = |i: usize| i as f64 - self.half as f64;
        (0..self.side()).flat_map(|j| (0..self.side()).map(move |i| normal.at(x + offset(i), y + offset(j)))).collect()
    }

    /// Of mean 0 and length 1 over the pixels that are compared, and 0 elsewhere.
    fn normalised(&self, mut values: Vec<f32>) -> Vec<f32> {
        let side = self.side();
        let compared = |at: usize| {
            let offset = |i: usize| i as f64 - self.half as f64;
            offset(at % side).hypot(offset(at / side)) <= self.reach
        };
        let (mut sum, mut count) = (0.0, 0.0);
        for at in (0..values.len()).filter(|&at| compared(at)) {
            sum += values[at];
            count += 1.0;
        }
        let mut squares = 0.0;
        for (at, value) in values.iter_mut().enumerate() {
            *value = if compared(at) { *value - sum / count } else { 0.0 };
            squares += *value * *value;
        }
        let length = squares.sqrt().max(1e-6);
        values.iter_mut().for_each(|value| *value /= length);
        values
    }
}

/// In eight sums side by side.
fn dot(a: &[f32], b: &[f32]) -> f32 {
    let mut sums = [0.0_f32; 8];
    let (a_parts, b_parts) = (a.chunks_exact(8), b.chunks_exact(8));
    let rest: f32 = a_parts.remainder().iter().zip(b_parts.remainder()).map(|(a, b)| a * b).sum();
    for (a, b) in a_parts.zip(b_parts) {
        for lane in 0..8 {
            sums[lane] += a[lane] * b[lane];
        }
    }
    sums.iter().sum::<f32>() + rest
}
