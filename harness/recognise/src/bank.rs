//! Drawings of the design's targets, to be held against what is seen.

use calibench_model::target::BAR;
use calibench_model::{TargetKind, stop};

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
    /// Pixels that are compared: of each row from the top of a drawing the first, and how many.
    rows: Vec<[usize; 2]>,
    /// After which turn it looks the same, radians.
    period: f64,
    /// Turned by equal parts of the period.
    drawings: Vec<Vec<f32>>,
    /// How many of their pixels are nearer to ink than to paper, in the mean.
    dark: f64,
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
        let blurred = |shape: &Shape| {
            let smoothed: Vec<Vec<f32>> = shape.drawings.iter().map(|drawing| shape.smoothed(drawing, &kernels)).collect();
            let dark = dark(&smoothed);
            Shape { drawings: smoothed.iter().map(|drawing| normalised(shape.packed(drawing))).collect(), dark, ..shape.clone() }
        };
        Self { shapes: self.shapes.iter().map(blurred).collect() }
    }

    /// The area of a target, as a fraction of a square, that is nearer to ink than to paper.
    pub fn area(&self, (kind, large): (TargetKind, bool)) -> f64 {
        self.shapes[index(kind, large)].dark / (SIDE * SIDE) as f64
    }

    /// What is seen around a place, to be compared with the two kinds of a size group.
    pub fn seen(&self, normal: &Normal, centre: [f64; 2], (kind, large): (TargetKind, bool)) -> Patch {
        stop::point();
        Patch(normalised(self.shapes[index(kind, large)].seen(normal, centre)))
    }

    /// The correlation of what is seen with a kind that is turned so (radians), or in the turn that fits best. Of a blurred bank.
    pub fn likeness(&self, Patch(patch): &Patch, (kind, large): (TargetKind, bool), turn: Option<f64>) -> f64 {
        let shape = &self.shapes[index(kind, large)];
        let compare = |drawing: &Vec<f32>| f64::from(dot(patch, drawing));
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

/// The surroundings of a place, of mean 0 and length 1.
pub(crate) struct Patch(Vec<f32>);

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
        let row = |j: usize| {
            let off = j as f64 - half as f64;
            let wide = (reach * reach - off * off).max(0.0).sqrt() as usize;
            [half - wide, 2 * wide + 1]
        };
        let drawings: Vec<Vec<f32>> = (0..turns).map(drawing).collect();
        Self { half, rows: (0..=2 * half).map(row).collect(), period: period(kind), dark: dark(&drawings), drawings }
    }

    fn side(&self) -> usize {
        2 * self.half + 1
    }

    /// Beyond a drawing is paper.
    fn smoothed(&self, drawing: &[f32], [along, across]: &[Vec<f32>; 2]) -> Vec<f32> {
        let side = self.side();
        let (reach, mut rows) = (along.len() / 2, vec![0.0_f32; drawing.len()]);
        let mut padded = vec![0.0_f32; side + 2 * reach];
        for (row, sums) in drawing.chunks_exact(side).zip(rows.chunks_exact_mut(side)) {
            padded[reach..reach + side].copy_from_slice(row);
            for (k, &weight) in along.iter().enumerate() {
                sums.iter_mut().zip(&padded[k..]).for_each(|(sum, value)| *sum += weight * value);
            }
        }
        let (reach, mut both) = ((across.len() / 2) as i64, vec![0.0_f32; drawing.len()]);
        for (j, sums) in both.chunks_exact_mut(side).enumerate() {
            for (k, &weight) in across.iter().enumerate() {
                let from = j as i64 + k as i64 - reach;
                if (0..side as i64).contains(&from) {
                    sums.iter_mut().zip(&rows[from as usize * side..]).for_each(|(sum, value)| *sum += weight * value);
                }
            }
        }
        both
    }

    /// The pixels that are compared, row by row.
    fn packed(&self, drawing: &[f32]) -> Vec<f32> {
        let row = |(j, [first, count]): (usize, &[usize; 2])| &drawing[j * self.side() + first..][..*count];
        self.rows.iter().enumerate().flat_map(row).copied().collect()
    }

    /// The same of what is seen around a place, between pixels linearly; beyond the normal image paper.
    fn seen(&self, normal: &Normal, [x, y]: [f64; 2]) -> Vec<f32> {
        let (left, top) = (x - self.half as f64, y - self.half as f64);
        let (i, j) = (left.floor() as i64, top.floor() as i64);
        let (a, b) = ((left - i as f64) as f32, (top - j as f64) as f32);
        let at = |x: i64, y: i64| {
            let inside = (0..SIDE as i64).contains(&x) && (0..SIDE as i64).contains(&y);
            if inside { normal.dark[y as usize * SIDE + x as usize] } else { 0.0 }
        };
        let mut seen = Vec::with_capacity(self.side() * self.side());
        for (row, [first, count]) in self.rows.iter().enumerate() {
            let (x, y) = (i + *first as i64, j + row as i64);
            let inside = x >= 0 && y >= 0 && x + (*count as i64) < SIDE as i64 && y + 1 < SIDE as i64;
            if inside {
                let from = y as usize * SIDE + x as usize;
                let (upper, lower) = (&normal.dark[from..=from + count], &normal.dark[from + SIDE..=from + SIDE + count]);
                let between = |(u, l): (&[f32], &[f32])| (1.0 - b) * ((1.0 - a) * u[0] + a * u[1]) + b * ((1.0 - a) * l[0] + a * l[1]);
                seen.extend(upper.windows(2).zip(lower.windows(2)).map(between));
            } else {
                let between =
                    |x: i64| (1.0 - b) * ((1.0 - a) * at(x, y) + a * at(x + 1, y)) + b * ((1.0 - a) * at(x, y + 1) + a * at(x + 1, y + 1));
                seen.extend((x..x + *count as i64).map(between));
            }
        }
        seen
    }
}

/// The mean number of pixels that are nearer to ink than to paper.
fn dark(drawings: &[Vec<f32>]) -> f64 {
    drawings.iter().flatten().filter(|value| **value > 0.5).count() as f64 / drawings.len() as f64
}

/// Of mean 0 and length 1.
fn normalised(mut values: Vec<f32>) -> Vec<f32> {
    let mean = sum(&values) / values.len() as f32;
    values.iter_mut().for_each(|value| *value -= mean);
    let length = dot(&values, &values).sqrt().max(1e-6);
    values.iter_mut().for_each(|value| *value /= length);
    values
}

/// In eight sums side by side, as [`dot`].
fn sum(values: &[f32]) -> f32 {
    let mut sums = [0.0_f32; 8];
    let parts = values.chunks_exact(8);
    let rest: f32 = parts.remainder().iter().sum();
    for part in parts {
        for lane in 0..8 {
            sums[lane] += part[lane];
        }
    }
    sums.iter().sum::<f32>() + rest
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
