//! The dots on the sides of squares.

use calibench_model::Image;

use crate::chessboard::grow::{Place, moved};
use crate::chessboard::sectors::Steps;
use crate::chessboard::sheet::Sheet;
use crate::ground::grey;
use crate::plane::{Point, minus, plus, times};

/// How far beside a side its squares are looked at, and where along it, as shares of a step: beside the largest dot.
const BESIDE: f64 = 0.3;
const ALONG: [f64; 3] = [-0.1, 0.0, 0.1];
/// How far around its middle a dot is looked at.
const WITHIN: f64 = 0.06;
/// The squares beside a side differ by at least this share of the contrast of all.
const EVEN: f64 = 0.25;
/// What lies between is neither dark nor light, as a share of the difference of the squares.
const UNCLEAR: [f64; 2] = [0.4, 0.6];

/// A dot that was read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Dot {
    /// The corner at the beginning of its side.
    pub at: Place,
    /// The axis along which its side runs.
    pub axis: usize,
    pub light: bool,
}

impl Dot {
    /// The corners at both ends of its side.
    pub(super) fn ends(&self) -> [Place; 2] {
        [self.at, moved(self.at, self.axis, 1)]
    }
}

impl Sheet {
    /// The dots that can be read.
    pub(super) fn dots(&self, image: &Image) -> Vec<Dot> {
        let sides = self.corners.keys().flat_map(|place| [0, 1].map(|axis| (*place, axis)));
        sides.filter_map(|(at, axis)| self.light_at(image, at, axis).map(|light| Dot { at, axis, light })).collect()
    }

    fn light_at(&self, image: &Image, at: Place, axis: usize) -> Option<bool> {
        let corner = |by: i32| self.corners.get(&moved(at, axis, by)).copied();
        let (from, to) = (corner(0)?, corner(1)?);
        let middle = between([corner(-1), Some(from), Some(to), corner(2)], from, to);
        let along = minus(to, from);
        let across = |place: Place| self.steps(place).map(|Steps(steps)| steps[1 - axis]);
        let across = times(plus(across(at)?, across(moved(at, axis, 1))?), 0.5);
        let sample = |s: f64, t: f64| grey(image, plus(middle, plus(times(along, s), times(across, t))));
        let square = |t: f64| ALONG.iter().map(|s| sample(*s, t)).sum::<f64>() / ALONG.len() as f64;
        let (before, behind) = (square(-BESIDE), square(BESIDE));
        let difference = (behind - before) * self.light(at);
        if difference < EVEN * self.contrast {
            return None;
        }
        let around = [[0.0, 0.0], [WITHIN, 0.0], [-WITHIN, 0.0], [0.0, WITHIN], [0.0, -WITHIN]];
        let dot = around.iter().map(|[s, t]| sample(*s, *t)).sum::<f64>() / around.len() as f64;
        let level = (dot - before.min(behind)) / difference;
        if level < UNCLEAR[0] {
            Some(false)
        } else if level > UNCLEAR[1] {
            Some(true)
        } else {
            None
        }
    }
}

/// The middle of a side, by a cubic through four corners where they are there: under a tilt it is not the mean of its ends.
fn between(line: [Option<Point>; 4], from: Point, to: Point) -> Point {
    let [Some(before), _, _, behind] = line else { return times(plus(from, to), 0.5) };
    let Some(behind) = behind else { return times(plus(from, to), 0.5) };
    plus(times(plus(from, to), 9.0 / 16.0), times(plus(before, behind), -1.0 / 16.0))
}
