//! Curves to parabolas in the image.

use calibench_model::PixelPoint;
use calibench_model::camera::NoCounterpart;

use crate::raster::Piece;

/// How far a parabola may lie off the curve that it stands for, px.
const TOLERANCE: f64 = 1e-5;
/// Halvings at most: a curve of a million pixels in pieces of one.
const DEEPEST: u32 = 20;

/// A point of the curve: its parameter and its image.
#[derive(Clone, Copy)]
struct Sample {
    t: f64,
    at: [f64; 2],
}

/// Appends the image of a curve to `pieces`; `project(t)` is its point at parameter t from 0 to 1, `sides` the frame with its margin.
///
/// Beyond the frame only the ends matter, and the curve is not followed.
pub(super) fn trace(
    project: &impl Fn(f64) -> Result<PixelPoint, NoCounterpart>,
    sides: [f64; 4],
    pieces: &mut Vec<Piece>,
) -> Result<(), NoCounterpart> {
    let sample = |t: f64| project(t).map(|p| Sample { t, at: [p.x, p.y] });
    let ends = [sample(0.0)?, sample(0.5)?, sample(1.0)?];
    split(&sample, sides, ends, DEEPEST, pieces)
}

fn split(
    sample: &impl Fn(f64) -> Result<Sample, NoCounterpart>,
    sides: [f64; 4],
    [start, middle, end]: [Sample; 3],
    depth: u32,
    pieces: &mut Vec<Piece>,
) -> Result<(), NoCounterpart> {
    let quarters = [sample(0.5 * (start.t + middle.t))?, sample(0.5 * (middle.t + end.t))?];
    let piece = Piece { start: start.at, middle: middle.at, end: end.at, contrast: 0.0 };
    let beyond = beyond(sides, &[start.at, quarters[0].at, middle.at, quarters[1].at, end.at]);
    if beyond || depth == 0 || follows(&piece, 0.25, quarters[0].at) && follows(&piece, 0.75, quarters[1].at) {
        pieces.push(piece);
        return Ok(());
    }
    split(sample, sides, [start, quarters[0], middle], depth - 1, pieces)?;
    split(sample, sides, [middle, quarters[1], end], depth - 1, pieces)
}

/// Does the parabola come by `at` near its parameter `t`? Only the distance across it counts.
fn follows(piece: &Piece, t: f64, at: [f64; 2]) -> bool {
    let [x, y] = piece.polynomial();
    let off = [at[0] - (x[0] + t * (x[1] + t * x[2])), at[1] - (y[0] + t * (y[1] + t * y[2]))];
    let along = [x[1] + 2.0 * t * x[2], y[1] + 2.0 * t * y[2]];
    let (length, chord) = (along[0].hypot(along[1]), off[0].hypot(off[1]));
    let across = if length > 0.0 { (off[0] * along[1] - off[1] * along[0]).abs() / length } else { chord };
    // Far along the parabola the tangent no longer tells the distance.
    across < TOLERANCE && chord < TOLERANCE + 0.1 * length
}

/// Do all points lie beyond one side of the frame?
fn beyond([left, top, right, bottom]: [f64; 4], points: &[[f64; 2]]) -> bool {
    let all = |outside: &dyn Fn(&[f64; 2]) -> bool| points.iter().all(outside);
    all(&|p| p[0] < left) || all(&|p| p[0] > right) || all(&|p| p[1] < top) || all(&|p| p[1] > bottom)
}
