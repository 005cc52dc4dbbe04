//! Where the corners around one have it: by a homography, which a plane before a pinhole has, and by a polynomial, for squares whose sides bend.

use nalgebra::{SMatrix, SVector};

use super::grow::Place;
use crate::plane::{Homography, Point, distance, plus, times};

/// How far away corners are that the polynomial is adjusted to, steps.
const FAR: i32 = 2;
/// Weight of the terms of second degree being none, where a neighbour has 1.
const STIFF: f64 = 1e-4;
/// By how much an error of a point exceeds one of the others: in the middle, on a side and in a corner of nine, of which eight determine an affine map and its twist.
const EXTRAPOLATION: [f64; 3] = [1.06, 1.18, 1.81];
/// The middles of nine that hold a corner, from it: it is their middle, on a side, in a corner.
const MIDDLES: [Place; 9] = [[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1], [1, 1], [1, -1], [-1, 1], [-1, -1]];

/// Where a corner is expected.
#[derive(Clone, Copy, Debug)]
pub(super) struct Forecast {
    /// By the homography of the eight others of nine, and how much worse than in their middle it knows; `None` where no such eight are there.
    plane: Option<(Point, f64)>,
    /// By the polynomial of second degree of all around, and how much worse it knows.
    bent: (Point, f64),
}

impl Forecast {
    /// `beside` tells where the corner so many columns and rows farther is; `None` where too few are there.
    pub(super) fn of(beside: impl Fn(Place) -> Option<Point>) -> Option<Self> {
        Some(Self { bent: bent(&beside)?, plane: by_plane(beside) })
    }

    /// How far a point is off by the polynomial alone, relative to what the corners around know, px: sooner told than by both.
    pub(super) fn off_bent(at: Point, beside: impl Fn(Place) -> Option<Point>) -> Option<f64> {
        bent(&beside).map(|(place, factor)| distance(at, place) / factor)
    }

    /// How far a point is off, relative to what the corners around know, px: from the nearer of the two.
    pub(super) fn off(&self, at: Point) -> f64 {
        let off = |(place, factor): (Point, f64)| distance(at, place) / factor;
        self.plane.map_or(off(self.bent), |plane| off(plane).min(off(self.bent)))
    }

    /// Where it is expected, the likelier first.
    pub(super) fn places(&self) -> impl Iterator<Item = Point> {
        [Some(self.bent), self.plane].into_iter().flatten().map(|(at, _)| at)
    }
}

/// By the homography of the eight others of nine, and by how much an error there exceeds one of the others; `None` where no such eight are there.
pub(super) fn by_plane(beside: impl Fn(Place) -> Option<Point>) -> Option<(Point, f64)> {
    let others = |[x, y]: Place| {
        let around = (y - 1..=y + 1).flat_map(|y| (x - 1..=x + 1).map(move |x| [x, y])).filter(|by| *by != [0, 0]);
        around.map(|by| Some((by.map(f64::from), beside(by)?))).collect::<Option<Vec<(Point, Point)>>>()
    };
    let (middle, pairs) = MIDDLES.into_iter().find_map(|middle| Some((middle, others(middle)?)))?;
    let outside = middle.iter().filter(|by| **by != 0).count();
    Some((Homography::fitted(&pairs)?.at([0.0, 0.0]), EXTRAPOLATION[outside]))
}

/// By a polynomial of second degree, and by how much an error there exceeds one of the others; nearer corners weigh more.
fn bent(beside: &impl Fn(Place) -> Option<Point>) -> Option<(Point, f64)> {
    let mut normal = SMatrix::<f64, 6, 6>::zeros();
    let mut corners = Vec::with_capacity(24);
    for by in (-FAR..=FAR).flat_map(|v| (-FAR..=FAR).map(move |u| [u, v])).filter(|by| *by != [0, 0]) {
        let Some(at) = beside(by) else { continue };
        let [u, v] = by.map(f64::from);
        let row = SVector::<f64, 6>::from([1.0, u, v, u * u, u * v, v * v]);
        let weight = 1.0 / (u * u + v * v).powi(2);
        normal += row * row.transpose() * weight;
        corners.push((row * weight, at));
    }
    // Corners may lie so that they do not determine the terms of second degree.
    (3..6).for_each(|term| normal[(term, term)] += STIFF);
    let solved = normal.cholesky().filter(|_| corners.len() >= 6)?;
    let first = solved.solve(&SVector::<f64, 6>::from([1.0, 0.0, 0.0, 0.0, 0.0, 0.0]));
    let (mut sum, mut share, mut squares) = ([0.0; 2], 0.0, 1.0);
    for (row, at) in corners {
        let own = row.dot(&first);
        sum = plus(sum, times(at, own));
        share += own;
        squares += own * own;
    }
    let at = times(sum, 1.0 / share);
    at.iter().all(|part| part.is_finite()).then_some((at, squares.sqrt()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Corners of a grid seen by a homography, and by a parabola beside it.
    #[test]
    fn both_ways_of_seeing_are_foreseen() {
        let plane = |u: f64, v: f64| [(30.0 * u + 4.0 * v) / (1.0 + 0.05 * u), (25.0 * v - 3.0 * u) / (1.0 + 0.05 * u)];
        let bent = |u: f64, v: f64| [30.0 * u - 2.0 * u * u, 25.0 * v + 1.5 * u * v];
        for at in [[0, 0], [2, 1], [3, 2]] {
            let within = |by: Place| (0..2).all(|axis| (0..=3).contains(&(at[axis] + by[axis])));
            for map in [&plane as &dyn Fn(f64, f64) -> Point, &bent] {
                let own = map(f64::from(at[0]), f64::from(at[1]));
                let beside = |by: Place| (within(by) && by != [0, 0]).then(|| map(f64::from(at[0] + by[0]), f64::from(at[1] + by[1])));
                let forecast = Forecast::of(beside).unwrap();
                assert!(forecast.off(own) < 0.02, "{at:?}: {forecast:?}");
                assert!(forecast.off([own[0] + 3.0, own[1]]) > 1.0);
            }
        }
    }

    #[test]
    fn few_corners_foresee_nothing() {
        assert!(Forecast::of(|[u, v]| (v == 0).then(|| [f64::from(u), 0.0])).is_none());
        assert!(Forecast::of(|_| None).is_none());
    }
}
