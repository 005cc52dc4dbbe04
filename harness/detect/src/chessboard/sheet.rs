//! A grid of corners in the image, and which of its squares are light.

use std::collections::BTreeMap;

use calibench_model::upper_median;

use super::complete::{inferred, sought};
use super::grow::{Grid, Place, WAYS, moved};
use super::level::{Level, Pyramid, scaled};
use super::refine::{Around, refined};
use super::sectors::{Contrast, Steps, contrast};
use super::side::Sides;
use super::straight::straighten;
use crate::plane::{Homography, Point, distance};

/// So many corners, at most so far away, tell one among them better than the dots around it let it be seen.
const ENOUGH: usize = 25;
const FAR: i32 = 5;
/// Corners are filled in where so many of the four neighbours are there.
const BESIDE: usize = 2;
/// A corner that is no saddle is put where the squares around it are there, and so many of the four neighbours.
const AMONG: usize = 3;
/// The surroundings of a corner that is nearer to the border of the image are cut, px.
const RIM: i64 = 3;
/// Two corners are at least this share of a step apart.
const APART: f64 = 0.5;

/// How a board of squares with something in or between them is looked at.
#[derive(Clone, Copy)]
pub(crate) struct Reading {
    /// How the sides of squares are looked at.
    pub sides: Sides,
    /// What is looked at around a corner.
    pub around: Around,
    /// Where the middle one of the steps is shorter than this, px, what lies beside corners moves them, so that they are smoothed.
    pub near: f64,
    /// Around a corner that nothing covers in part the darker of two light squares is lighter than the lighter of two dark ones by this share of the contrast.
    pub even: f64,
    /// Grids of fewer corners are not looked at.
    pub fewest: usize,
}

/// Corners by their place; the second axis is clockwise of the first in the image.
pub(crate) struct Sheet {
    /// Where, px of the image.
    pub corners: BTreeMap<Place, Point>,
    /// 1 if the squares between the steps of one sign are light at places whose sum is even, -1 if those at the others.
    pub sign: f64,
    /// The difference between light and dark, in the middle.
    pub contrast: f64,
}

impl Sheet {
    /// `None` for what has no steps or no colours.
    pub(crate) fn new(pyramid: &Pyramid, level: &Level, mut grid: Grid, reading: &Reading) -> Option<Self> {
        close(level, &mut grid);
        let mut corners: BTreeMap<Place, Point> = grid.iter().map(|(place, saddle)| (*place, scaled(saddle.at, level.factor))).collect();
        // What has no neighbour on one of the axes has no square beside it.
        loop {
            let single: Vec<Place> = corners.keys().copied().filter(|place| Steps::among(&corners, *place).is_none()).collect();
            if single.is_empty() {
                break;
            }
            corners.retain(|place, _| !single.contains(place));
        }
        let shortest = |place: &Place| Steps::among(&corners, *place).map_or(0.0, |steps| steps.shorter());
        let lengths: Vec<f64> = corners.keys().map(shortest).collect();
        let places: Vec<Point> = corners.values().copied().collect();
        let found = refined(pyramid, &places, &lengths, reading.around, level.factor);
        let mut corners: BTreeMap<Place, Point> = corners.into_keys().zip(found.into_iter().map(|(at, _)| at)).collect();
        if upper_median(lengths).is_some_and(|middle| middle < reading.near) {
            corners = smoothed(&corners);
        } else {
            straighten(&mut corners);
        }
        let whole = |[x, y]: Point| pyramid.image().holds(x.round() as i64, y.round() as i64, RIM);
        corners.retain(|_, at| whole(*at));
        let signed = |place: &Place| {
            let contrast: Contrast = contrast(pyramid.image(), corners[place], &Steps::among(&corners, *place)?)?;
            (contrast.least > reading.even * contrast.mean.abs()).then_some(())?;
            Some((*place, parity(*place) * contrast.mean))
        };
        let all: Vec<(Place, f64)> = corners.keys().filter_map(signed).collect();
        let sign = if 2 * all.iter().filter(|(_, contrast)| *contrast > 0.0).count() > all.len() { 1.0 } else { -1.0 };
        let kept: BTreeMap<Place, f64> = all.into_iter().filter(|(_, contrast)| contrast * sign > 0.0).collect();
        let corners: BTreeMap<Place, Point> = corners.into_iter().filter(|(place, _)| kept.contains_key(place)).collect();
        let contrast = upper_median(kept.values().map(|contrast| contrast.abs()))?;
        Some(Self { corners, sign, contrast })
    }

    /// The steps from a corner to its neighbours.
    pub(crate) fn steps(&self, place: Place) -> Option<Steps> {
        Steps::among(&self.corners, place)
    }

    /// Whether the squares between steps of the same sign are light at a place: 1 or -1.
    pub(crate) fn light(&self, place: Place) -> f64 {
        self.sign * parity(place)
    }

    /// The shortest step, px.
    pub(crate) fn least_step(&self) -> f64 {
        let all = self.corners.keys().filter_map(|place| self.steps(*place));
        all.map(|steps| steps.shorter()).fold(f64::INFINITY, f64::min)
    }

    /// The place in the middle of all.
    pub(crate) fn middle(&self) -> Place {
        let bounds = |axis: usize| {
            let all = || self.corners.keys().map(|place| place[axis]);
            [all().min().unwrap_or(0), all().max().unwrap_or(0)]
        };
        [0, 1].map(|axis| bounds(axis).iter().sum::<i32>().div_euclid(2))
    }
}

/// Each corner where the homography of those nearest to it on the board, itself among them, has it.
fn smoothed(corners: &BTreeMap<Place, Point>) -> BTreeMap<Place, Point> {
    let mut around: Vec<Place> = (-FAR..=FAR).flat_map(|v| (-FAR..=FAR).map(move |u| [u, v])).collect();
    around.sort_by_key(|[u, v]| u * u + v * v);
    let own = |(place, at): (&Place, &Point)| {
        let pair = |by: &Place| Some((by.map(f64::from), *corners.get(&[place[0] + by[0], place[1] + by[1]])?));
        let pairs: Vec<(Point, Point)> = around.iter().filter_map(pair).take(ENOUGH).collect();
        let map = Homography::fitted(&pairs).filter(|_| pairs.len() == ENOUGH);
        (*place, map.map_or(*at, |map| map.at([0.0, 0.0])))
    };
    corners.iter().map(own).collect()
}

fn parity([u, v]: Place) -> f64 {
    if (u + v).rem_euclid(2) == 0 { 1.0 } else { -1.0 }
}

/// Adds corners that were no candidates, where two neighbours say that they are; none of them twice.
fn close(level: &Level, grid: &mut Grid) {
    for _ in 0..4 {
        let mut beside: BTreeMap<Place, usize> = BTreeMap::new();
        for place in grid.keys() {
            WAYS.iter().for_each(|(axis, sign)| *beside.entry(moved(*place, *axis, *sign)).or_default() += 1);
        }
        let gaps: Vec<(Place, usize)> = beside.into_iter().filter(|(place, count)| *count >= BESIDE && !grid.contains_key(place)).collect();
        let before = grid.len();
        for (place, count) in gaps {
            let put = || inferred(level, grid, place).filter(|_| count >= AMONG);
            let Some(corner) = sought(level, grid, place).or_else(put) else { continue };
            let around = (-2..=2).flat_map(|v| (-2..=2).map(move |u| [place[0] + u, place[1] + v]));
            let others: Vec<Point> = around.filter_map(|place| grid.get(&place)).map(|saddle| saddle.at).collect();
            let near = |other: &Point| distance(*other, corner.at);
            let direct = WAYS.iter().filter_map(|(axis, sign)| grid.get(&moved(place, *axis, *sign))).map(|saddle| near(&saddle.at));
            let step = direct.fold(0.0, f64::max);
            if others.iter().all(|other| near(other) > APART * step) {
                grid.insert(place, corner);
            }
        }
        if grid.len() == before {
            return;
        }
    }
}
