//! Curves to pieces in the image.

use calibench_model::PixelPoint;
use calibench_model::camera::NoCounterpart;

use crate::raster::Piece;

/// How far a piece may lie off the curve that it stands for, px.
pub(super) const TOLERANCE: f64 = 1e-5;
/// What estimated errors are multiplied by: terms that fall more slowly than expected were seen to add up to four times the estimate.
const CAUTION: f64 = 4.0;
/// Halvings at most: a curve of a million pixels in pieces of one.
const DEEPEST: u32 = 20;

/// A point of the curve: its parameter and its image.
#[derive(Clone, Copy)]
struct Sample {
    t: f64,
    at: [f64; 2],
}

/// Appends the image of a curve to `pieces`; `project(t, near)` is its point at parameter t from 0 to 1, given one nearby if there is one, `sides` the frame
/// with its margin.
///
/// Beyond the frame only the ends matter, and the curve is not followed. No piece within is longer than `longest`, px. `near` is a point near its start, if one is known; its end is returned.
pub(super) fn trace(
    project: &impl Fn(f64, Option<PixelPoint>) -> Result<PixelPoint, NoCounterpart>,
    sides: [f64; 4],
    longest: f64,
    near: Option<PixelPoint>,
    pieces: &mut Vec<Piece>,
) -> Result<PixelPoint, NoCounterpart> {
    let sample = |t: f64, near: Option<Sample>| {
        let near = near.map(|near| PixelPoint::new(near.at[0], near.at[1]));
        project(t, near).map(|p| Sample { t, at: [p.x, p.y] })
    };
    let start = sample(0.0, near.map(|near| Sample { t: 0.0, at: [near.x, near.y] }))?;
    let quarter = sample(0.25, Some(start))?;
    let middle = sample(0.5, Some(quarter))?;
    let third = sample(0.75, Some(middle))?;
    let end = sample(1.0, Some(third))?;
    split(&sample, sides, longest, [start, quarter, middle, third, end], DEEPEST, pieces)?;
    Ok(PixelPoint::new(end.at[0], end.at[1]))
}

fn split(
    sample: &impl Fn(f64, Option<Sample>) -> Result<Sample, NoCounterpart>,
    sides: [f64; 4],
    longest: f64,
    samples: [Sample; 5],
    depth: u32,
    pieces: &mut Vec<Piece>,
) -> Result<(), NoCounterpart> {
    let points = samples.map(|sample| sample.at);
    if depth == 0 || beyond(sides, &points) || (error(&points) < TOLERANCE && chord(&points) <= longest) {
        pieces.push(Piece { points, contrast: 0.0 });
        return Ok(());
    }
    let between = |a: Sample, b: Sample| sample(0.5 * (a.t + b.t), Some(a));
    let [a, c, e, g, i] = samples;
    split(sample, sides, longest, [a, between(a, c)?, c, between(c, e)?, e], depth - 1, pieces)?;
    split(sample, sides, longest, [e, between(e, g)?, g, between(g, i)?, i], depth - 1, pieces)
}

/// From the first to the last of five points, px.
fn chord(points: &[[f64; 2]; 5]) -> f64 {
    (points[4][0] - points[0][0]).hypot(points[4][1] - points[0][1])
}

/// An estimate of how far the quartic through five points of a smooth curve lies off it, px: the first terms that are left out, if they go on falling as those
/// before them. Only what lies across the curve counts.
fn error(points: &[[f64; 2]; 5]) -> f64 {
    let length = chord(points);
    let (c, s) = if length > 0.0 { ((points[4][0] - points[0][0]) / length, (points[4][1] - points[0][1]) / length) } else { (1.0, 0.0) };
    let along = tail(points.map(|p| c * p[0] + s * p[1]));
    let across_values = points.map(|p| c * p[1] - s * p[0]);
    let (mut steepest, mut shortest) = (0.0_f64, f64::INFINITY);
    for i in 0..4 {
        let step = [points[i + 1][0] - points[i][0], points[i + 1][1] - points[i][1]];
        steepest = steepest.max((across_values[i + 1] - across_values[i]).abs());
        shortest = shortest.min((c * step[0] + s * step[1]).abs());
    }
    let steepness = if shortest > 0.0 { (steepest / shortest).min(1.0) } else { 1.0 };
    tail(across_values) + steepness * along
}

/// What the terms beyond the fourth of a function's expansion over [-1, 1] add up to, estimated from five values.
fn tail([a, b, c, d, e]: [f64; 5]) -> f64 {
    // Chebyshev coefficients of the quartic through the values.
    let (even, odd) = (a - 4.0 * b + 6.0 * c - 4.0 * d + e, -a + 2.0 * b - 2.0 * d + e);
    let (first, second) = ((0.5 * (e - a)).abs(), (0.25 * (a - 2.0 * c + e)).abs());
    let (third, fourth) = ((odd / 6.0).abs(), (even / 12.0).abs());
    let (low, high) = (first.max(second), third.max(fourth));
    if high < 0.1 * TOLERANCE {
        return high;
    }
    // Two orders further on: they fall as much again as from the first two to the last two.
    CAUTION * (third + fourth) * (high / low).min(1.0)
}

/// Whether all points lie beyond one side of the frame.
fn beyond([left, top, right, bottom]: [f64; 4], points: &[[f64; 2]]) -> bool {
    let all = |outside: &dyn Fn(&[f64; 2]) -> bool| points.iter().all(outside);
    all(&|p| p[0] < left) || all(&|p| p[0] > right) || all(&|p| p[1] < top) || all(&|p| p[1] > bottom)
}
