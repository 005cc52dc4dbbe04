//! Straight lines through points of lines.

use std::f64::consts::PI;

use calibench_model::stop;

use crate::ridge::Ridge;

/// Directions, a degree each.
const DIRECTIONS: usize = 180;
/// How far a point's own direction across may be from that of a line that it votes for, degrees.
const TURN: i64 = 10;
/// How far, px, points of a line lie from it at most: at first, and once it is adjusted.
const FIRST: f64 = 2.0;
const ADJUSTED: f64 = 1.0;
/// The shortest line, as a share of the image's shorter side and in px.
const SHORTEST: f64 = 0.15;
const SHORTEST_PX: f64 = 14.0;
/// Votes of a line, as a share of the best line's and as a share of its length.
const OF_BEST: f64 = 0.15;
const FILLED: f64 = 0.25;
/// The root mean square distance of a line's points, px, at most: points that lie anywhere, or on rows of targets, come to 0.3 to 0.6, those of lines to 0.2.
const SCATTER: f64 = 0.28;
/// Lines at most.
const MOST: usize = 60;

/// A straight line: x nx + y ny = r, in px from the middle of the image.
#[derive(Clone, Debug)]
pub(crate) struct Line {
    pub normal: [f64; 2],
    pub r: f64,
    /// Where along the line its points begin and end, from the foot of the perpendicular, px.
    pub span: [f64; 2],
    /// How many points it was adjusted to.
    pub points: usize,
    /// Root mean square distance of the points, px.
    pub rms: f64,
}

impl Line {
    /// The point at `s` px along it.
    pub fn along(&self, s: f64) -> [f64; 2] {
        let [nx, ny] = self.normal;
        [self.r * nx - s * ny, self.r * ny + s * nx]
    }

    /// The standard deviation across, at its middle, of a line of independent points, px.
    pub fn sigma(&self) -> f64 {
        self.rms / (self.points.max(3) as f64 - 2.0).sqrt()
    }

    /// Where two lines meet; `None` if they are nearly parallel.
    pub fn meet(&self, other: &Self) -> Option<[f64; 2]> {
        let ([a, b], [c, d]) = (self.normal, other.normal);
        let det = a * d - b * c;
        (det.abs() > 0.05).then(|| [(self.r * d - other.r * b) / det, (a * other.r - c * self.r) / det])
    }
}

/// The lines through `points` (px from the middle of an image whose half diagonal is `reach` and whose shorter side is `side` px), the best supported first:
/// votes by direction and distance, the best line, its points taken out, and so on; each line adjusted to its points by least squares of the distances.
///
/// Source: Hough transformation and line adjustment: Vosselman & Förstner 1988, section 3.1.
pub(crate) fn lines(points: &[Ridge], reach: f64, side: f64) -> Vec<Line> {
    let mut votes = Votes::new(reach);
    points.iter().for_each(|point| votes.add(point, 1.0));
    let mut free = vec![true; points.len()];
    let (mut found, mut best) = (Vec::new(), 0.0_f64);
    let shortest = (SHORTEST * side).max(SHORTEST_PX);
    for _ in 0..4 * MOST {
        stop::point();
        let (normal, r, count) = votes.best();
        best = best.max(count);
        if found.len() == MOST || count < OF_BEST * best || count < 0.5 * FILLED * shortest {
            break;
        }
        let (line, of) = adjusted(points, &free, normal, r);
        let taken: Vec<usize> = if of.is_empty() { votes.clear(normal, r) } else { of };
        for index in taken {
            free[index] = false;
            votes.add(&points[index], -1.0);
        }
        let Some(line) = line else { continue };
        let length = line.span[1] - line.span[0];
        if length >= shortest && line.points as f64 >= FILLED * length && line.rms <= SCATTER {
            found.push(line);
        }
    }
    found
}

/// Votes by direction (of the normal, degrees) and distance from the middle (px).
struct Votes {
    counts: Vec<f32>,
    distances: usize,
    normals: Vec<[f64; 2]>,
    /// For each direction the distance with the most votes, and these; `None` after a change.
    most: Vec<Option<(usize, f32)>>,
}

impl Votes {
    fn new(reach: f64) -> Self {
        let distances = 2 * reach.ceil() as usize + 4;
        let normal = |degrees: usize| (degrees as f64 * PI / DIRECTIONS as f64).sin_cos();
        let normals = (0..DIRECTIONS).map(normal).map(|(sine, cosine)| [cosine, sine]).collect();
        Self { counts: vec![0.0; DIRECTIONS * distances], distances, normals, most: vec![None; DIRECTIONS] }
    }

    /// Votes for all lines through a point that run about as it does.
    fn add(&mut self, point: &Ridge, times: f64) {
        let own = point.normal[1].atan2(point.normal[0]).to_degrees().round() as i64;
        let weight = point.weight * times;
        for degrees in own - TURN..=own + TURN {
            let direction = degrees.rem_euclid(DIRECTIONS as i64) as usize;
            let [nx, ny] = self.normals[direction];
            let r = point.at[0] * nx + point.at[1] * ny + 0.5 * self.distances as f64;
            let (cell, part) = (r.floor(), r - r.floor());
            let first = direction * self.distances + (cell as usize).min(self.distances - 2);
            self.most[direction] = None;
            self.counts[first] += (weight * (1.0 - part)) as f32;
            self.counts[first + 1] += (weight * part) as f32;
        }
    }

    /// The line with the most votes.
    fn best(&mut self) -> ([f64; 2], f64, f64) {
        let mut best = (0, 0, f32::MIN);
        for (direction, most) in self.most.iter_mut().enumerate() {
            let of = &self.counts[direction * self.distances..(direction + 1) * self.distances];
            let (cell, count) = *most.get_or_insert_with(|| {
                let most = of.iter().fold(f32::MIN, |most, &count| most.max(count));
                (of.iter().position(|&count| count == most).unwrap_or(0), most)
            });
            if count > best.2 {
                best = (direction, cell, count);
            }
        }
        (self.normals[best.0], best.1 as f64 - 0.5 * self.distances as f64, f64::from(best.2))
    }

    /// Takes the votes of a line to which no points belong.
    fn clear(&mut self, [nx, ny]: [f64; 2], r: f64) -> Vec<usize> {
        let direction = (ny.atan2(nx).to_degrees().round() as usize) % DIRECTIONS;
        let cell = (r + 0.5 * self.distances as f64).round() as usize;
        self.most[direction] = None;
        self.counts[direction * self.distances + cell.min(self.distances - 1)] = 0.0;
        Vec::new()
    }
}

/// The line through the free points near a line, and these points.
fn adjusted(points: &[Ridge], free: &[bool], mut normal: [f64; 2], mut r: f64) -> (Option<Line>, Vec<usize>) {
    let mut of: Vec<usize> = Vec::new();
    let mut line = None;
    for (step, &within) in [FIRST, FIRST, ADJUSTED, ADJUSTED].iter().enumerate() {
        let aligned = if step < 2 { 0.9 } else { 0.95 };
        let belongs = |&index: &usize| {
            let Ridge { at, normal: own, .. } = &points[index];
            let off = at[0] * normal[0] + at[1] * normal[1] - r;
            free[index] && off.abs() <= within && (own[0] * normal[0] + own[1] * normal[1]).abs() > aligned
        };
        let near: Vec<usize> = (0..points.len()).filter(belongs).collect();
        if near.len() < 6 {
            return (line, of);
        }
        let fitted = fit(points, &near);
        (normal, r) = (fitted.normal, fitted.r);
        of = near;
        line = Some(fitted);
    }
    (line, of)
}

/// The line of least squared distances, weighted.
pub(crate) fn fit(points: &[Ridge], of: &[usize]) -> Line {
    let (mut w, mut x, mut y) = (0.0, 0.0, 0.0);
    for point in of.iter().map(|&index| &points[index]) {
        w += point.weight;
        x += point.weight * point.at[0];
        y += point.weight * point.at[1];
    }
    let (x, y) = (x / w, y / w);
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for point in of.iter().map(|&index| &points[index]) {
        let (dx, dy) = (point.at[0] - x, point.at[1] - y);
        xx += point.weight * dx * dx;
        xy += point.weight * dx * dy;
        yy += point.weight * dy * dy;
    }
    // The direction along is that of the larger moment.
    let along = 0.5 * (2.0 * xy).atan2(xx - yy);
    let normal = [-along.sin(), along.cos()];
    let r = x * normal[0] + y * normal[1];
    let (mut squares, mut span) = (0.0, [f64::INFINITY, f64::NEG_INFINITY]);
    for point in of.iter().map(|&index| &points[index]) {
        squares += (point.at[0] * normal[0] + point.at[1] * normal[1] - r).powi(2);
        let s = point.at[1] * normal[0] - point.at[0] * normal[1];
        span = [span[0].min(s), span[1].max(s)];
    }
    Line { normal, r, span, points: of.len(), rms: (squares / of.len() as f64).sqrt() }
}
