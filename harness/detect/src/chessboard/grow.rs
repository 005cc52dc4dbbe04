//! Grids of corners, grown from neighbour to neighbour.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use calibench_model::stop;

use super::candidates::{Saddle, Saddles};
use super::level::Level;
use super::side::is_side;
use crate::plane::{Point, cross, distance, length, minus, plus, times};

/// So many grids are begun at a level.
const SEEDS: usize = 1000;
/// So many of the nearest saddles are looked at for the first steps of a grid.
const NEAREST: usize = 20;
/// How far a corner may be from where its neighbours have it, as a share of the shorter step.
const REACH: f64 = 0.35;
/// The corners of a grid of so many begin no other.
const SETTLED: usize = 9;
/// Sine of the angle between the two steps of a grid, at least.
const SLANT: f64 = 0.2;
/// By how much a step may differ from the last.
const STRETCH: [f64; 2] = [0.7, 1.4];

pub(crate) type Place = [i32; 2];
/// A grid: its corners by their place. The second axis is clockwise of the first in the image.
pub(crate) type Grid = BTreeMap<Place, Saddle>;

/// The four ways to a neighbour: axis and sign.
pub(crate) const WAYS: [(usize, i32); 4] = [(0, 1), (0, -1), (1, 1), (1, -1)];

pub(crate) fn moved(mut place: Place, axis: usize, by: i32) -> Place {
    place[axis] += by;
    place
}

/// Where the neighbour of a corner should be, by the steps before or beside it; and the shortest of those steps.
pub(super) fn foreseen(grid: &Grid, place: Place, (axis, sign): (usize, i32)) -> Option<(Point, f64)> {
    let at = |place: Place| grid.get(&place).map(|saddle| saddle.at);
    let own = at(place)?;
    let other = 1 - axis;
    let across = [-1, 1].into_iter().filter_map(|by| at(moved(place, other, by))).map(|beside| distance(beside, own));
    let across = across.fold(f64::INFINITY, f64::min);
    let straight = at(moved(place, axis, -sign)).map(|before| {
        let step = minus(own, before);
        let earlier = at(moved(place, axis, -2 * sign)).map_or(length(step), |earlier| distance(before, earlier));
        times(step, (length(step) / earlier).clamp(STRETCH[0], STRETCH[1]))
    });
    let beside =
        || [-1, 1].into_iter().find_map(|by| Some(minus(at(moved(moved(place, other, by), axis, sign))?, at(moved(place, other, by))?)));
    let step = straight.or_else(beside)?;
    Some((plus(own, step), length(step).min(across)))
}

/// Whether a corner at a place has sides to all of its neighbours that are there.
pub(super) fn fits(level: &Level, grid: &Grid, place: Place, corner: &Saddle) -> bool {
    let mut neighbours = WAYS.iter().filter_map(|(axis, sign)| grid.get(&moved(place, *axis, *sign)));
    neighbours.all(|neighbour| is_side(level, corner, neighbour))
}

/// The grids of a level, one after the other.
pub(crate) struct Grids<'a> {
    level: &'a Level,
    saddles: &'a Saddles,
    next: usize,
    taken: Vec<bool>,
}

impl<'a> Grids<'a> {
    pub(crate) fn new(level: &'a Level, saddles: &'a Saddles) -> Self {
        Self { level, saddles, next: 0, taken: vec![false; saddles.all.len()] }
    }

    fn side(&self, a: usize, b: usize) -> bool {
        is_side(self.level, &self.saddles.all[a], &self.saddles.all[b])
    }

    /// Four corners of a square of which one is the first.
    fn square(&self, first: usize) -> Option<[usize; 4]> {
        let near: Vec<usize> = self.saddles.nearest(first, NEAREST).into_iter().filter(|other| self.side(first, *other)).collect();
        let at = |index: usize| self.saddles.all[index].at;
        let step = |index: usize| minus(at(index), at(first));
        for (i, a) in near.iter().enumerate() {
            for b in &near[..i] {
                let (p, q) = (step(*a), step(*b));
                if cross(p, q).abs() < SLANT * length(p) * length(q) {
                    continue;
                }
                let reach = REACH * length(p).min(length(q));
                let fourth = self.saddles.within(plus(at(first), plus(p, q)), reach).into_iter();
                let mut fourth = fourth.filter(|c| *c != *a && *c != *b && self.side(*a, *c) && self.side(*b, *c));
                if let Some(c) = fourth.next() {
                    return Some(if cross(p, q) > 0.0 { [first, *a, c, *b] } else { [first, *b, c, *a] });
                }
            }
        }
        None
    }

    fn grow(&mut self, square: [usize; 4]) -> Grid {
        let places = [[0, 0], [1, 0], [1, 1], [0, 1]];
        let mut used: BTreeSet<usize> = square.into();
        let mut grid: Grid = places.into_iter().zip(square.map(|index| self.saddles.all[index])).collect();
        let mut open: VecDeque<Place> = places.into();
        while let Some(place) = open.pop_front() {
            for (axis, sign) in WAYS {
                let there = moved(place, axis, sign);
                if grid.contains_key(&there) {
                    continue;
                }
                let Some((at, step)) = foreseen(&grid, place, (axis, sign)) else { continue };
                let near = self.saddles.within(at, REACH * step).into_iter().filter(|index| !used.contains(index));
                let Some(next) = near.take(3).find(|index| fits(self.level, &grid, there, &self.saddles.all[*index])) else { continue };
                used.insert(next);
                grid.insert(there, self.saddles.all[next]);
                open.push_back(there);
                open.extend(WAYS.iter().map(|(axis, sign)| moved(there, *axis, *sign)).filter(|place| grid.contains_key(place)));
            }
        }
        if grid.len() >= SETTLED {
            used.into_iter().for_each(|index| self.taken[index] = true);
        }
        grid
    }
}

impl Iterator for Grids<'_> {
    type Item = Grid;

    fn next(&mut self) -> Option<Grid> {
        stop::point();
        while self.next < self.saddles.all.len().min(SEEDS) {
            let seed = self.next;
            self.next += 1;
            if self.taken[seed] {
                continue;
            }
            if let Some(square) = self.square(seed) {
                return Some(self.grow(square));
            }
        }
        None
    }
}
