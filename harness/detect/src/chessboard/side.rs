//! Sides of squares: edges between two corners.

use super::candidates::{Saddle, direction};
use super::level::Level;
use crate::ground::grey;
use crate::plane::{Point, cross, dot, plus, times};

/// Where along a side of a square it is looked at, as shares of its length.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sides(&'static [f64]);

impl Sides {
    /// Nothing lies on them.
    pub(crate) const PLAIN: Self = Self(&[0.2, 0.35, 0.5, 0.65, 0.8]);
    /// A dot lies on their middles.
    pub(crate) const DOTTED: Self = Self(&[0.14, 0.25, 0.75, 0.86]);
}

/// How far beside it, as a share of its length; px of the level at least.
const BESIDE: f64 = 0.1;
const LEAST_BESIDE: f64 = 1.0;
/// The least difference along a side is this share of the greatest.
const EVEN: f64 = 0.05;
/// Sine of the angle between a side and the middles of the sectors beside it, at least.
const SLANT: f64 = 0.12;
/// A side that is shorter, px of the level, is not looked at near its ends.
const SHORT: f64 = 12.0;
/// By how much a side may bow, as shares of its length: what is beside the straight line is beside one of these.
const BOWS: [f64; 4] = [0.08, -0.08, 0.16, -0.16];
/// Cosine of the angle between the light of neighbours, which are a quarter turn apart, at most.
const TURN: f64 = 0.55;

/// Which way the light lies beside the way from a saddle: 1 clockwise, -1 counterclockwise in the image; `None` along the middle of a sector.
fn light_beside(saddle: &Saddle, way: Point) -> Option<f64> {
    let ahead = dot(saddle.light, way);
    let beside = cross(way, saddle.light) * ahead.signum();
    (ahead.abs() > SLANT && beside.abs() > SLANT).then(|| beside.signum())
}

/// Whether the side of a square runs from one saddle to another: the same side of it is light all along, as it is at both ends.
pub(super) fn is_side(level: &Level, a: &Saddle, b: &Saddle) -> bool {
    let Some((way, far)) = direction(a.at, b.at) else { return false };
    if dot(a.light, b.light).abs() > TURN {
        return false;
    }
    let (Some(from_a), Some(from_b)) = (light_beside(a, way), light_beside(b, times(way, -1.0))) else { return false };
    if from_a != -from_b {
        return false;
    }
    let beside = times([-way[1], way[0]], from_a);
    let off = (BESIDE * far).max(LEAST_BESIDE);
    let Sides(mut along) = level.sides;
    // Near to its ends a short side is lost in the blur.
    if far < SHORT {
        along = &along[1..along.len() - 1];
    }
    let is_light_along = |bow: f64| {
        let difference = |share: f64| {
            let bent = 4.0 * bow * far * share * (1.0 - share);
            let at = plus(a.at, plus(times(way, share * far), times(beside, bent)));
            grey(&level.smooth, plus(at, times(beside, off))) - grey(&level.smooth, plus(at, times(beside, -off)))
        };
        let (mut least, mut greatest) = (f64::INFINITY, f64::NEG_INFINITY);
        for share in along {
            let own = difference(*share);
            (least, greatest) = (least.min(own), greatest.max(own));
            if least <= EVEN * greatest || least <= 0.0 {
                return false;
            }
        }
        true
    };
    is_light_along(0.0) || (far >= SHORT && BOWS.into_iter().any(is_light_along))
}
