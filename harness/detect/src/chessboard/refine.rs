//! Corners to a fraction of a pixel.

use calibench_model::{Image, upper_median};

use super::level::{Pyramid, scaled};
use crate::meeting::Meeting;
use crate::plane::{Point, distance, minus, plus};

/// What is looked at around corners.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Around {
    /// Its radius as a share of the shorter step to a neighbour.
    pub share: f64,
    /// A coarser image is looked at if the middle one of the steps is so long there, px.
    pub resolved: f64,
    /// Grey values are smoothed before gradients are taken where the step is so long, px.
    pub smooth: f64,
}

/// The radius of what is looked at, px at least and at most.
const LEAST: f64 = 2.0;
const GREATEST: f64 = 9.0;
/// How far beyond this radius gradients are kept, px.
const SPARE: f64 = 2.0;
/// Steps at most, and the length of the last, px.
const STEPS: usize = 10;
const LAST: f64 = 0.01;
/// Where edges are sharp the misfit of their gradients gives a corner this standard deviation at most, px.
const SHARP: f64 = 0.4;
/// The smoothing before gradients are taken.
const BINOMIAL: [f64; 5] = [0.0625, 0.25, 0.375, 0.25, 0.0625];

/// Each corner moved to where the edges around it meet, and whether they do: in the image, or in a coarser one in which they are sharp. It stays where nothing
/// meets near it.
/// `steps`: the shorter step from each to a neighbour, px; `factor`: px of the image to one of the level in which they were found.
pub(crate) fn refined(pyramid: &Pyramid, corners: &[Point], steps: &[f64], around: Around, factor: f64) -> Vec<(Point, bool)> {
    let mut best = (f64::INFINITY, corners.iter().map(|at| (*at, false)).collect::<Vec<_>>());
    let Some(step) = upper_median(steps.iter().copied()) else { return best.1 };
    for (image, of) in pyramid.up_to((2.0 * factor).max(1.0)).filter(|(_, of)| *of == 1.0 || step / of >= around.resolved) {
        let met = |(at, step): (&Point, &f64)| {
            let found = meeting(image, scaled(*at, 1.0 / of), step / of, around, factor / of);
            found.map_or(((*at, false), f64::INFINITY), |(at, variance)| ((scaled(at, of), true), variance))
        };
        let (moved, variances): (Vec<(Point, bool)>, Vec<f64>) = corners.iter().zip(steps).map(met).unzip();
        let middle = upper_median(variances).map_or(f64::INFINITY, f64::sqrt);
        if middle < best.0 {
            best = (middle, moved);
        }
        if middle < SHARP {
            break;
        }
    }
    best.1
}

/// Where edges meet near `from`, and its variance, px^2; `scale`: px of this image to one in which `from` is known to a fraction.
fn meeting(image: &Image, from: Point, step: f64, around: Around, scale: f64) -> Option<(Point, f64)> {
    let radius = (around.share * step).clamp(LEAST, GREATEST);
    let smooth = step >= around.smooth;
    let mut patch = Patch::around(image, from, radius + SPARE, smooth);
    let (mut at, mut known) = (from, f64::INFINITY);
    for _ in 0..STEPS {
        if distance(at, patch.middle) > SPARE {
            patch = Patch::around(image, at, radius + SPARE, smooth);
        }
        let (next, variance) = patch.met(at, radius)?;
        if distance(next, from) > (0.2 * step).max(scale) {
            return None;
        }
        let moved = distance(next, at);
        (at, known) = (next, variance);
        if moved < LAST {
            break;
        }
    }
    Some((at, known))
}

/// Gradients around a point; none beyond the image.
struct Patch {
    middle: Point,
    first: [i64; 2],
    side: usize,
    gradients: Vec<Point>,
}

impl Patch {
    fn around(image: &Image, middle: Point, reach: f64, smooth: bool) -> Self {
        let reach = reach.ceil() as i64;
        let first = middle.map(|at| at.round() as i64 - reach);
        let side = 2 * reach as usize + 1;
        // Three px more on each side: two for the smoothing and one for the difference.
        let wide = side + 6;
        let inside = |at: i64, size: usize| at.clamp(0, size as i64 - 1) as usize;
        let grey = |x: usize, y: usize| {
            let (column, row) = (first[0] + x as i64 - 3, first[1] + y as i64 - 3);
            f64::from(image.at(inside(column, image.width()), inside(row, image.height())))
        };
        let raw: Vec<f64> = (0..wide).flat_map(|y| (0..wide).map(move |x| (x, y))).map(|(x, y)| grey(x, y)).collect();
        let smooth = if smooth { smoothed(&raw, wide) } else { raw };
        let at = |x: usize, y: usize| smooth[y * wide + x];
        let gradient = |x: usize, y: usize| {
            let (column, row) = (first[0] + x as i64, first[1] + y as i64);
            let (x, y) = (x + 3, y + 3);
            let difference = [at(x + 1, y) - at(x - 1, y), at(x, y + 1) - at(x, y - 1)];
            if image.holds(column, row, 0) { difference } else { [0.0; 2] }
        };
        let gradients = (0..side).flat_map(|y| (0..side).map(move |x| (x, y))).map(|(x, y)| gradient(x, y)).collect();
        Self { middle, first, side, gradients }
    }

    /// The point to which the gradients in a disc are closest to being at right angles, and its variance, px^2; `None` where all have one direction.
    fn met(&self, middle: Point, radius: f64) -> Option<(Point, f64)> {
        let mut meeting = Meeting::default();
        for (index, gradient) in self.gradients.iter().enumerate() {
            let pixel = [self.first[0] + (index % self.side) as i64, self.first[1] + (index / self.side) as i64];
            meeting.add(minus(pixel.map(|at| at as f64), middle), *gradient, radius);
        }
        meeting.place().map(|place| (plus(middle, place), meeting.variance()))
    }
}

/// A square of grey values, smoothed where all of five are inside.
fn smoothed(raw: &[f64], side: usize) -> Vec<f64> {
    let pass = |from: &[f64], apart: usize| -> Vec<f64> {
        let mut to = from.to_vec();
        for index in 2 * apart..from.len() - 2 * apart {
            to[index] = BINOMIAL.iter().enumerate().map(|(k, weight)| weight * from[index + k * apart - 2 * apart]).sum();
        }
        to
    };
    pass(&pass(raw, 1), side)
}
