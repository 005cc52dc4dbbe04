//! An edge in an image: its levels, where it is, how wide it is spread, how straight it is.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use calibench_model::Image;
use nalgebra::{Matrix4, Vector4};

use crate::geometry::Edge;

/// The parts of an edge near its ends that are left out, as a share of its length: corners are no edges.
const ENDS: f64 = 0.2;
/// How far across an edge is looked at, px at most.
const MOST_REACH: f64 = 7.0;
/// The same as a share of the edge's length.
const REACH: f64 = 0.35;
/// Edges that are shorter are not looked at, px.
const SHORTEST: f64 = 8.0;
/// Length of the pieces of which each is asked where it is, px.
const PIECE: f64 = 2.0;
/// Spreads outside these are no edges', px.
const SPREADS: [f64; 2] = [0.2, 6.0];

/// An edge as a smooth step: grey = dark + (bright - dark) Phi((d - shift) / spread), d across towards the bright side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeFit {
    /// The middle of the edge, px from the middle of the frame.
    pub at: [f64; 2],
    /// The direction towards the bright side, a unit vector in the image.
    pub normal: [f64; 2],
    /// Grey values on both sides, fractions of full scale.
    pub levels: [f64; 2],
    /// How far the edge is from where the geometry says, towards the bright side, px.
    pub shift: f64,
    /// Standard deviation of the line spread with the pixel's own, px.
    pub spread: f64,
    /// Mean square of where pieces of 2 px are about the edge's own straight line, px^2.
    pub raggedness: f64,
}

/// A pixel near an edge.
#[derive(Clone, Copy)]
struct Near {
    /// Along the chord, px.
    along: f64,
    /// Across, towards the bright side, px.
    across: f64,
    grey: f64,
}

/// Mean profile of edges: by distance across, in steps of a quarter of a pixel, grey values between 0 (dark) and 1 (bright).
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    sums: Vec<f64>,
    counts: Vec<f64>,
}

/// Steps of a profile on either side.
pub const STEPS: usize = 24;
/// The width of a step, px.
pub const STEP: f64 = 0.25;

impl Default for Profile {
    fn default() -> Self {
        Self { sums: vec![0.0; 2 * STEPS + 1], counts: vec![0.0; 2 * STEPS + 1] }
    }
}

impl Profile {
    fn add(&mut self, across: f64, level: f64) {
        let place = (across / STEP).round() + STEPS as f64;
        if place >= 0.0 && place <= 2.0 * STEPS as f64 {
            self.sums[place as usize] += level;
            self.counts[place as usize] += 1.0;
        }
    }

    /// With the pixels of another.
    pub fn join(&mut self, other: &Self) {
        self.sums.iter_mut().zip(&other.sums).for_each(|(own, more)| *own += more);
        self.counts.iter_mut().zip(&other.counts).for_each(|(own, more)| *own += more);
    }

    /// Distance across, px, and mean level, of each step that has enough pixels.
    pub fn points(&self) -> Vec<[f64; 2]> {
        let all = self.sums.iter().zip(&self.counts).enumerate().filter(|(_, (_, count))| **count >= 20.0);
        all.map(|(step, (sum, count))| [(step as f64 - STEPS as f64) * STEP, sum / count]).collect()
    }

    /// Root mean square difference to another where both are known.
    pub fn distance(&self, other: &Self) -> f64 {
        let (mut sum, mut count) = (0.0, 0.0);
        for place in 0..self.sums.len() {
            if self.counts[place] >= 20.0 && other.counts[place] >= 20.0 {
                sum += (self.sums[place] / self.counts[place] - other.sums[place] / other.counts[place]).powi(2);
                count += 1.0;
            }
        }
        if count > 0.0 { f64::sqrt(sum / count) } else { f64::NAN }
    }
}

/// The edge in `image`, and its pixels added to `profile`, if it is one that can be looked at.
pub fn fit_edge(image: &Image, edge: &Edge, profile: &mut Profile) -> Option<EdgeFit> {
    if edge.length < SHORTEST {
        return None;
    }
    let (mut pixels, normal) = near(image, edge)?;
    let step = fitted(&pixels)?;
    let [dark, bright, shift, spread] = [step[0], step[1], step[2], step[3]];
    if bright - dark < 0.03 || !(SPREADS[0]..=SPREADS[1]).contains(&spread) || shift.abs() > 3.0 {
        return None;
    }
    for pixel in &pixels {
        profile.add(pixel.across - shift, (pixel.grey - dark) / (bright - dark));
    }
    pixels.sort_by(|a, b| a.along.total_cmp(&b.along));
    let raggedness = raggedness(&pixels, &step)?;
    let (middle, [width, height]) = (edge.middle(), [image.width() as f64, image.height() as f64]);
    let at = [middle.x - 0.5 * (width - 1.0), middle.y - 0.5 * (height - 1.0)];
    Some(EdgeFit { at, normal, levels: [dark, bright], shift, spread, raggedness })
}

/// The pixels near an edge, and the direction towards the bright side.
fn near(image: &Image, edge: &Edge) -> Option<(Vec<Near>, [f64; 2])> {
    let reach = (REACH * edge.length).min(MOST_REACH);
    let ends = [edge.from.x, edge.from.x + edge.length * edge.along[0]];
    let others = [edge.from.y, edge.from.y + edge.length * edge.along[1]];
    let margin = reach + edge.sag.abs();
    let low = |ends: [f64; 2]| (ends[0].min(ends[1]) - margin).floor();
    let high = |ends: [f64; 2]| (ends[0].max(ends[1]) + margin).ceil();
    if low(ends) < 1.0 || low(others) < 1.0 || high(ends) > image.width() as f64 - 2.0 || high(others) > image.height() as f64 - 2.0 {
        return None;
    }
    let mut pixels = Vec::new();
    let mut moment = 0.0;
    for y in low(others) as usize..=high(others) as usize {
        let row = image.row(y);
        for (x, grey) in row.iter().enumerate().take(high(ends) as usize + 1).skip(low(ends) as usize) {
            let [along, across] = edge.place(x as f64, y as f64);
            if across.abs() <= reach && along >= ENDS * edge.length && along <= (1.0 - ENDS) * edge.length {
                pixels.push(Near { along, across, grey: f64::from(*grey) });
                moment += across.signum() * f64::from(*grey);
            }
        }
    }
    let normal = edge.normal();
    if moment < 0.0 {
        pixels.iter_mut().for_each(|pixel| pixel.across = -pixel.across);
        return Some((pixels, [-normal[0], -normal[1]]));
    }
    Some((pixels, normal))
}

/// Dark and bright level, shift and spread, by Gauss and Newton.
fn fitted(pixels: &[Near]) -> Option<Vector4<f64>> {
    let mean = |bright: bool| {
        let side = pixels.iter().filter(|pixel| pixel.across.abs() > 2.0 && (pixel.across > 0.0) == bright).map(|pixel| pixel.grey);
        let (sum, count) = side.fold((0.0, 0), |(sum, count), grey| (sum + grey, count + 1));
        (count > 4).then(|| sum / f64::from(count))
    };
    let mut state = Vector4::new(mean(false)?, mean(true)?, 0.0, 0.9);
    for _ in 0..12 {
        let (mut normal, mut right) = (Matrix4::zeros(), Vector4::zeros());
        for pixel in pixels {
            let z = (pixel.across - state[2]) / state[3];
            let (step, slope, contrast) = (cumulative(z), density(z), state[1] - state[0]);
            let row = Vector4::new(1.0 - step, step, -contrast * slope / state[3], -contrast * slope * z / state[3]);
            normal += row * row.transpose();
            right += row * (pixel.grey - state[0] - contrast * step);
        }
        let change = normal.cholesky()?.solve(&right);
        state += Vector4::new(change[0], change[1], change[2].clamp(-0.5, 0.5), change[3].clamp(-0.4, 0.4));
        state[3] = state[3].max(0.15);
        if change[2].abs() < 1e-5 && change[3].abs() < 1e-5 {
            break;
        }
    }
    state.iter().all(|value| value.is_finite()).then_some(state)
}

/// Mean square of where pieces are, about a straight line through them. `pixels` are sorted along the edge.
fn raggedness(pixels: &[Near], step: &Vector4<f64>) -> Option<f64> {
    let (first, contrast) = (pixels.first()?.along, step[1] - step[0]);
    let pieces = ((pixels.last()?.along - first) / PIECE).floor() as usize;
    if pieces < 4 {
        return Some(f64::NAN);
    }
    let mut sums = vec![[0.0; 2]; pieces];
    for pixel in pixels {
        let Some(piece) = sums.get_mut(((pixel.along - first) / PIECE) as usize) else { continue };
        let z = (pixel.across - step[2]) / step[3];
        let slope = contrast * density(z) / step[3];
        piece[0] -= slope * (pixel.grey - step[0] - contrast * cumulative(z));
        piece[1] += slope * slope;
    }
    let offsets: Vec<f64> = sums.iter().map(|[sum, weight]| sum / weight.max(1e-12)).collect();
    let n = offsets.len() as f64;
    let place = |index: usize| index as f64 - 0.5 * (n - 1.0);
    let mean = offsets.iter().sum::<f64>() / n;
    let trend = offsets.iter().enumerate().map(|(i, offset)| place(i) * offset).sum::<f64>()
        / (0..offsets.len()).map(|i| place(i).powi(2)).sum::<f64>();
    let square = |(i, offset): (usize, &f64)| (offset - mean - trend * place(i)).powi(2);
    Some(offsets.iter().enumerate().map(square).sum::<f64>() / (n - 2.0))
}

/// The standard normal density.
fn density(z: f64) -> f64 {
    (-0.5 * z * z).exp() / (2.0 * PI).sqrt()
}

/// The standard normal distribution function.
pub fn cumulative(z: f64) -> f64 {
    0.5 * libm::erfc(-z * FRAC_1_SQRT_2)
}
