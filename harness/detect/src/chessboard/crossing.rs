//! A corner by the sides of the squares that meet in it: each is followed along its bend, and measured across it.

use calibench_model::Image;

use crate::ground::grey;
use crate::plane::{Point, length, minus, plus, times};

/// Where along the sides they are measured, steps from the corner; nearer than this to it, px, what is across one side belongs to the other, too.
const ALONG: [f64; 4] = [0.14, 0.24, 0.34, 0.44];
const LEAST_ALONG: f64 = 1.5;
/// How far across a side it is looked for, as a share of the step there; px at least, and so many samples on both sides.
const ACROSS: f64 = 0.25;
const LEAST_ACROSS: f64 = 2.5;
const SAMPLES: usize = 8;
/// Samples are so far apart at least, px.
const APART: f64 = 0.75;
/// Where a step is shorter than this, px, what is across a side reaches to the next one.
const RESOLVED: f64 = 10.0;
/// The rise across a side is this share of the contrast at least.
const RISE: f64 = 0.25;
/// So many places show where a side runs, and this share of all that are looked at.
const FEWEST: usize = 4;
const SHARE: f64 = 0.5;
/// They lie so near to a straight line beside the bend, px and as a share of the step across.
const NEAR: f64 = 0.6;
const NEAR_SHARE: f64 = 0.012;
/// The slope of that line at most.
const SLOPE: f64 = 0.4;
/// From where the sides meet they are measured again, so many times, until they meet within this, px.
const ROUNDS: usize = 3;
const LAST: f64 = 0.5;

/// What the sides around a corner tell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Crossing {
    /// Where they meet, px.
    At(Point),
    /// The squares are too small to be looked at in this way.
    Unresolved,
    /// The saddle there, px, where the squares are too small.
    Peak(Point),
    /// They are not there, or do not meet near the corner.
    Unseen,
}

impl Crossing {
    /// Where the corner is, px.
    pub(super) fn at(self) -> Option<Point> {
        match self {
            Self::At(at) | Self::Peak(at) => Some(at),
            Self::Unresolved | Self::Unseen => None,
        }
    }
}

/// The way of a side through a corner: from it by `t` steps lies `t step + t^2 bend`, px.
#[derive(Clone, Copy, Debug)]
struct Course {
    step: Point,
    bend: Point,
}

impl Course {
    /// By the corners around; `beside` tells where the one so many columns and rows farther is.
    fn through(own: Point, axis: usize, beside: &impl Fn([i32; 2]) -> Option<Point>) -> Option<Self> {
        let at = |by: i32| beside(if axis == 0 { [by, 0] } else { [0, by] });
        let ahead = |sign: i32| {
            let next = at(sign)?;
            let bend = at(2 * sign).map_or([0.0; 2], |after| times(plus(minus(own, times(next, 2.0)), after), 0.5));
            Some(Self { step: times(minus(minus(next, own), bend), f64::from(sign)), bend })
        };
        match (at(-1), at(1)) {
            (Some(before), Some(behind)) => {
                let bend = minus(times(plus(before, behind), 0.5), own);
                Some(Self { step: times(minus(behind, before), 0.5), bend })
            }
            (Some(_), None) => ahead(-1),
            (None, _) => ahead(1),
        }
    }

    fn at(&self, steps: f64) -> Point {
        plus(times(self.step, steps), times(self.bend, steps * steps))
    }
}

/// Where the sides through a point meet. `light`: the contrast of the sectors around it, positive where the light ones are those between steps of one sign.
pub(super) fn crossing(image: &Image, from: Point, light: f64, beside: impl Fn([i32; 2]) -> Option<Point>) -> Crossing {
    let mut own = from;
    for _ in 0..ROUNDS {
        let (Some(u), Some(v)) = (Course::through(own, 0, &beside), Course::through(own, 1, &beside)) else { return Crossing::Unseen };
        let sides = [Side { image, own, along: u, across: v.step, light }, Side { image, own, along: v, across: u.step, light }];
        if sides.iter().any(|side| length(side.across) < RESOLVED) {
            return Crossing::Unresolved;
        }
        let [Some([a, p]), Some([b, q])] = sides.map(|side| side.line()) else { return Crossing::Unseen };
        // v = a + p u and u = b + q v.
        let at_u = (b + q * a) / (1.0 - p * q);
        let at_v = a + p * at_u;
        if at_u.abs().max(at_v.abs()) > 2.0 * ACROSS {
            return Crossing::Unseen;
        }
        let moved = plus(u.at(at_u), v.at(at_v));
        own = plus(own, moved);
        if length(minus(own, from)) > 2.0 * ACROSS * length(u.step).max(length(v.step)) {
            return Crossing::Unseen;
        }
        if length(moved) < LAST {
            break;
        }
    }
    Crossing::At(own)
}

/// The side of squares through a point.
struct Side<'a> {
    image: &'a Image<'a>,
    own: Point,
    along: Course,
    across: Point,
    light: f64,
}

impl Side<'_> {
    /// The line that it follows beside its course: steps across at the point, and by how much they rise with each step along.
    fn line(&self) -> Option<[f64; 2]> {
        let (along, across) = (length(self.along.step), length(self.across));
        let places = ALONG.iter().filter(|share| *share * along >= LEAST_ALONG).flat_map(|share| [-share, *share]);
        let places = places.filter(|at| self.holds(*at));
        let (mut looked, mut seen) = (0, Vec::with_capacity(2 * ALONG.len()));
        for at in places {
            looked += 1;
            seen.extend(self.edge(at).map(|edge| [at, edge]));
        }
        let near = NEAR / across + NEAR_SHARE;
        let fewest = FEWEST.max((SHARE * f64::from(looked)).ceil() as usize);
        let mut best: Option<(usize, f64, [f64; 2])> = None;
        for (index, [s, y]) in seen.iter().enumerate() {
            for [t, z] in &seen[..index] {
                let slope = (z - y) / (t - s);
                let line = [y - slope * s, slope];
                let off = |[at, edge]: &[f64; 2]| (line[0] + line[1] * at - edge).abs();
                let inside = || seen.iter().map(off).filter(|off| *off < near);
                let (count, sum) = (inside().count(), inside().sum::<f64>());
                let better = best.is_none_or(|(most, least, _)| count > most || (count == most && sum < least));
                if better && slope.abs() < SLOPE && count >= fewest {
                    best = Some((count, sum, line));
                }
            }
        }
        let (_, _, line) = best?;
        let inside: Vec<[f64; 2]> = seen.into_iter().filter(|[at, edge]| (line[0] + line[1] * at - edge).abs() < near).collect();
        fitted(&inside)
    }

    /// Whether so many steps along it is in the image.
    fn holds(&self, steps: f64) -> bool {
        let [x, y] = plus(self.own, self.along.at(steps));
        self.image.holds(x.round() as i64, y.round() as i64, 0)
    }

    /// Where the side is, steps across its course, so many steps along it.
    fn edge(&self, steps: f64) -> Option<f64> {
        let across = length(self.across);
        let reach = (ACROSS * across).max(LEAST_ACROSS);
        let apart = (reach / SAMPLES as f64).max(APART);
        let half = (reach / apart) as usize;
        let (middle, step) = (plus(self.own, self.along.at(steps)), times(self.across, apart / across));
        let sign = self.light.signum() * steps.signum();
        // Three samples more on each side: a rise is over five of them, and has neighbours.
        let far = half as f64 + 3.0;
        let mut profile = [0.0; 2 * SAMPLES + 7];
        let count = 2 * half + 7;
        for (index, value) in profile[..count].iter_mut().enumerate() {
            *value = sign * grey(self.image, plus(middle, times(step, index as f64 - far)));
        }
        // Of values that are smoothed by 1 2 1.
        let rise = |index: usize| 0.25 * (profile[index + 2] - profile[index - 2]) + 0.5 * (profile[index + 1] - profile[index - 1]);
        let best = (3..count - 3).max_by(|a, b| rise(*a).total_cmp(&rise(*b)))?;
        if profile[best + 2] - profile[best - 2] < RISE * self.light.abs() {
            return None;
        }
        let (before, own, behind) = (rise(best - 1), rise(best), rise(best + 1));
        let bend = before - 2.0 * own + behind;
        let part = if bend < 0.0 { (0.5 * (before - behind) / bend).clamp(-0.5, 0.5) } else { 0.0 };
        Some((best as f64 + part - far) * apart / across)
    }
}

/// The straight line of least squares.
fn fitted(points: &[[f64; 2]]) -> Option<[f64; 2]> {
    let count = points.len() as f64;
    let mean = |part: usize| points.iter().map(|point| point[part]).sum::<f64>() / count;
    let [s, y] = [mean(0), mean(1)];
    let spread: f64 = points.iter().map(|point| (point[0] - s).powi(2)).sum();
    let together: f64 = points.iter().map(|point| (point[0] - s) * (point[1] - y)).sum();
    let slope = together / spread;
    slope.is_finite().then_some([y - slope * s, slope])
}
