//! Corners that do not lie where the others around them have them, put there.

use std::collections::BTreeMap;

use super::forecast::by_plane;
use super::grow::Place;
use super::sectors::Steps;
use crate::plane::{Point, distance};

/// Farther off than this it is put there.
const OFF: f64 = 0.025;
const OFF_PX: f64 = 0.75;
/// So large a share of the corners may be put elsewhere.
const MOVED: f64 = 0.06;

/// Corners by their place.
type Corners = BTreeMap<Place, Point>;

/// Where the eight others of 3 x 3 around a corner have it, and how much worse they know than in their middle; `None` where no such eight are there.
fn foreseen(corners: &Corners, [u, v]: Place) -> Option<(Point, f64)> {
    by_plane(|by| corners.get(&[u + by[0], v + by[1]]).copied())
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
