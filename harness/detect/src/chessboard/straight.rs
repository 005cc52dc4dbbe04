//! Corners that do not lie where the others around them have them, put there.

use std::collections::BTreeMap;

use super::grow::Place;
use super::sectors::Steps;
use crate::plane::{Homography, Point, distance};

/// Farther off than this it is put there.
const OFF: f64 = 0.025;
const OFF_PX: f64 = 0.75;
/// So large a share of the corners may be put elsewhere.
const MOVED: f64 = 0.06;
/// By how much an error of a point exceeds one of the others: in the middle, on a side and in a corner of nine, of which eight determine an affine map and its twist.
const EXTRAPOLATION: [f64; 3] = [1.06, 1.18, 1.81];

/// The middles of nine that hold a corner, from it: it is their middle, on a side, in a corner.
const MIDDLES: [Place; 9] = [[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1], [1, 1], [1, -1], [-1, 1], [-1, -1]];

/// Corners by their place.
type Corners = BTreeMap<Place, Point>;

/// Where the eight others of 3 x 3 around a corner have it, and how much worse they know than in their middle; `None` where no such eight are there.
fn foreseen(corners: &Corners, [u, v]: Place) -> Option<(Point, f64)> {
    let others = |[x, y]: Place| {
        let around = (y - 1..=y + 1).flat_map(|y| (x - 1..=x + 1).map(move |x| [x, y])).filter(|by| *by != [0, 0]);
        around.map(|by| Some((by.map(f64::from), *corners.get(&[u + by[0], v + by[1]])?))).collect::<Option<Vec<(Point, Point)>>>()
    };
    let (middle, pairs) = MIDDLES.into_iter().find_map(|middle| Some((middle, others(middle)?)))?;
    let outside = middle.iter().filter(|by| **by != 0).count();
    Some((Homography::fitted(&pairs)?.at([0.0, 0.0]), EXTRAPOLATION[outside]))
}

/// How far a corner is off, relative to what its neighbours know, px.
fn off(corners: &Corners, place: Place) -> Option<f64> {
    foreseen(corners, place).map(|(at, factor)| distance(at, corners[&place]) / factor)
}

/// The shorter of the steps to the neighbours, px.
fn step(corners: &Corners, place: Place) -> f64 {
    Steps::among(corners, place).map_or(0.0, |steps| steps.shorter())
}

/// Puts few corners that are off, by the edge of a shadow for instance, to where the others have them; whether there were any.
pub(super) fn straighten(corners: &mut Corners) -> bool {
    let mut offs: BTreeMap<Place, f64> = corners.keys().filter_map(|place| Some((*place, off(corners, *place)?))).collect();
    for moved in 0..(MOVED * corners.len() as f64) as usize {
        let Some((worst, by)) = offs.iter().max_by(|a, b| a.1.total_cmp(b.1)).map(|(place, by)| (*place, *by)) else { return false };
        let limit = OFF * step(corners, worst) + OFF_PX;
        let Some((at, _)) = foreseen(corners, worst).filter(|_| by > limit) else { return moved > 0 };
        corners.insert(worst, at);
        for (place, own) in &mut offs {
            if (0..2).all(|axis| (place[axis] - worst[axis]).abs() <= 2) {
                *own = off(corners, *place).unwrap_or(*own);
            }
        }
    }
    true
}
