//! The four sectors around a corner, as large as its squares.

use std::collections::BTreeMap;

use calibench_model::Image;

use super::grow::Place;
use crate::ground::grey;
use crate::plane::{Linear, Point, length, minus, plus, times};

/// How far along both steps the middle of a sector lies: farther where that is too near to the corner, px, up to what dots in squares leave; and how far around it
/// samples are taken.
const MIDDLE: [f64; 2] = [0.22, 0.33];
const LEAST_MIDDLE: f64 = 3.0;
const AROUND: [f64; 3] = [-0.08, 0.0, 0.08];
/// Pixels of the border that are not looked at, and the least share to which sectors are made smaller to be inside.
const BORDER: f64 = 1.0;
const LEAST_SHRUNK: f64 = 0.15;
/// The darker of two light sectors is lighter than the lighter of two dark ones by this share of the difference of their means.
const SHARE: f64 = 0.08;

/// The steps from a corner to its neighbours on both axes, px.
pub(crate) struct Steps(pub [Point; 2]);

impl Steps {
    /// By the corners before and behind, or by those beside it; `place` tells where a neighbour is.
    pub(crate) fn at(own: Point, place: impl Fn([i32; 2]) -> Option<Point>) -> Option<Self> {
        let by = |axis: usize, sign: i32, across: i32| if axis == 0 { [sign, across] } else { [across, sign] };
        let step = |axis: usize| {
            let straight = match (place(by(axis, -1, 0)), place(by(axis, 1, 0))) {
                (Some(before), Some(behind)) => Some(times(minus(behind, before), 0.5)),
                (Some(before), None) => Some(minus(own, before)),
                (None, behind) => behind.map(|behind| minus(behind, own)),
            };
            let beside = |across: i32| Some(minus(place(by(axis, 1, across))?, place(by(axis, 0, across))?));
            straight.or_else(|| beside(1)).or_else(|| beside(-1))
        };
        Some(Self([step(0)?, step(1)?]))
    }

    /// Of a corner among others.
    pub(crate) fn among(corners: &BTreeMap<Place, Point>, [u, v]: Place) -> Option<Self> {
        Self::at(*corners.get(&[u, v])?, |by| corners.get(&[u + by[0], v + by[1]]).copied())
    }

    /// The length of the shorter one, px.
    pub(crate) fn shorter(&self) -> f64 {
        let Self([u, v]) = self;
        length(*u).min(length(*v))
    }

    /// From the plane of the board, u right and v up, whose squares have this side, to px.
    pub(crate) fn linear(&self, square: f64) -> Linear {
        let Self([u, v]) = self;
        Linear([0, 1].map(|axis| [u[axis] / square, -v[axis] / square]))
    }
}

/// How two opposite sectors around a corner are lighter than the others.
pub(crate) struct Contrast {
    /// Difference of the means: positive if the light ones are those where both steps have the same sign, negative if the others.
    pub mean: f64,
    /// The darker of the light ones less the lighter of the dark ones; positive.
    pub least: f64,
}

/// By how much the sectors around a corner, which reach so far along both steps, are smaller where a part of them would be beyond the border of the image.
fn inside(image: &Image, at: Point, Steps([u, v]): &Steps, reach: f64) -> f64 {
    let last = [image.width(), image.height()].map(|size| size as f64 - 1.0 - BORDER);
    let signs = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]];
    let share = |[a, b]: [f64; 2], axis: usize| {
        let way = reach * (a * u[axis] + b * v[axis]);
        let room = if way < 0.0 { at[axis] - BORDER } else { last[axis] - at[axis] };
        room / way.abs()
    };
    let least = signs.into_iter().flat_map(|sign| [share(sign, 0), share(sign, 1)]).fold(1.0, f64::min);
    least.clamp(LEAST_SHRUNK, 1.0)
}

/// The contrast of the sectors around a corner; `None` if no two are lighter than the others.
pub(crate) fn contrast(image: &Image, at: Point, steps: &Steps) -> Option<Contrast> {
    let Steps([u, v]) = steps;
    let middle = (LEAST_MIDDLE / steps.shorter()).clamp(MIDDLE[0], MIDDLE[1]);
    let shrunk = inside(image, at, steps, middle + AROUND[2]);
    let sector = |a: f64, b: f64| {
        let samples = AROUND.iter().flat_map(|i| AROUND.iter().map(move |k| [a * middle + i, b * middle + k].map(|part| shrunk * part)));
        samples.map(|[i, k]| grey(image, plus(at, plus(times(*u, i), times(*v, k))))).sum::<f64>() / 9.0
    };
    let (same, other) = ([sector(1.0, 1.0), sector(-1.0, -1.0)], [sector(1.0, -1.0), sector(-1.0, 1.0)]);
    let mean = 0.5 * (same[0] + same[1] - other[0] - other[1]);
    let (light, dark) = if mean > 0.0 { (same, other) } else { (other, same) };
    let least = light[0].min(light[1]) - dark[0].max(dark[1]);
    (least > SHARE * mean.abs() && least > 0.0).then_some(Contrast { mean, least })
}
