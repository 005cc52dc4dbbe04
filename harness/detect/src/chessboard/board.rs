//! A whole rectangle of corners in the image: is it a board, which way round.

use calibench_model::{Image, upper_median};

use super::complete::extent;
use super::grow::Grid;
use super::level::{Level, scaled};
use super::sectors::{Steps, contrast};
use crate::plane::{Point, cross, length, minus, plus, times};

/// The contrast at a corner is this share of the middle one of all at least.
const EVEN: f64 = 0.03;
/// Squares have a shorter side of this length at least, px, the middle one of all.
const RESOLVED: f64 = 6.0;
/// So large a share of corners beyond a border of the board, with this share of the contrast of their neighbours: the board goes on.
const BEYOND: f64 = 0.5;
const BEYOND_CONTRAST: f64 = 0.3;
/// Beyond, where a square that ends is no corner, the sectors are so even.
const BEYOND_EVEN: f64 = 0.4;

/// Corners row by row.
#[derive(Clone)]
pub(super) struct Board {
    pub columns: usize,
    pub rows: usize,
    /// Where, px of the image.
    pub corners: Vec<Point>,
    /// Whether it is seen there, or where the others have it.
    pub seen: Vec<bool>,
    /// Whether nearly all corners are seen, about where the others have them; known of what was settled.
    pub settled: bool,
    /// Whether the square before the first corner on both axes is dark; known of what [`Board::stands`].
    pub starts_dark: bool,
}

impl Board {
    /// A rectangle without gaps, in the image.
    pub(super) fn new(level: &Level, grid: &Grid) -> Option<Self> {
        let [low, high] = extent(grid)?;
        let size = |axis: usize| (high[axis] - low[axis] + 1) as usize;
        let places = (low[1]..=high[1]).flat_map(|v| (low[0]..=high[0]).map(move |u| [u, v]));
        let corners: Option<Vec<Point>> = places.map(|place| grid.get(&place).map(|saddle| scaled(saddle.at, level.factor))).collect();
        let corners = corners?;
        Some(Self { columns: size(0), rows: size(1), seen: vec![true; corners.len()], corners, settled: false, starts_dark: false })
    }

    /// The area between its outermost corners, px^2.
    pub(super) fn area(&self) -> f64 {
        let last = self.corners.len() - 1;
        let [a, b, c, d] = [0, self.columns - 1, last, last + 1 - self.columns].map(|index| self.corners[index]);
        0.5 * cross(minus(c, a), minus(d, b)).abs()
    }

    pub(super) fn place(&self, index: usize) -> [usize; 2] {
        [index % self.columns, index / self.columns]
    }

    /// Where the corner `by` columns and rows from another is.
    pub(super) fn beside(&self, index: usize, by: [i32; 2]) -> Option<Point> {
        self.index_beside(index, by).map(|index| self.corners[index])
    }

    /// The same of a corner that is seen.
    pub(super) fn seen_beside(&self, index: usize, by: [i32; 2]) -> Option<Point> {
        self.index_beside(index, by).filter(|index| self.seen[*index]).map(|index| self.corners[index])
    }

    fn index_beside(&self, index: usize, [u, v]: [i32; 2]) -> Option<usize> {
        let [column, row] = self.place(index);
        let (column, row) = (column.checked_add_signed(u as isize)?, row.checked_add_signed(v as isize)?);
        (column < self.columns && row < self.rows).then(|| row * self.columns + column)
    }

    /// Its columns and rows, the larger first: which of them are columns nobody said.
    pub(super) fn counts(&self) -> [usize; 2] {
        [self.columns.max(self.rows), self.columns.min(self.rows)]
    }

    /// Whether the squares around its outermost corners are in the image: a board that goes on beyond its border has unknown counts.
    pub(super) fn is_inside(&self, image: &Image) -> bool {
        let [right, bottom] = [self.columns - 1, self.rows - 1];
        let outer = |[column, row]: [usize; 2]| {
            let index = row * self.columns + column;
            let Some(Steps([u, v])) = self.steps(index) else { return false };
            let [u, v] = [times(u, if column == 0 { -1.0 } else { 1.0 }), times(v, if row == 0 { -1.0 } else { 1.0 })];
            let [x, y] = plus(self.corners[index], plus(u, v));
            image.holds(x.round() as i64, y.round() as i64, 0)
        };
        [[0, 0], [right, 0], [right, bottom], [0, bottom]].into_iter().all(outer)
    }

    /// The steps to the neighbours of a corner.
    pub(super) fn steps(&self, index: usize) -> Option<Steps> {
        Steps::at(self.corners[index], |by| self.beside(index, by))
    }

    /// The shorter of the steps to the neighbours of a corner, px.
    pub(super) fn step(&self, index: usize) -> f64 {
        self.steps(index).map_or(0.0, |steps| steps.shorter())
    }

    /// Contrasts of the sectors of all corners as if at an even place; `None` if dark and light do not alternate.
    fn contrasts(&self, image: &Image) -> Option<Vec<f64>> {
        let own = |index: usize| {
            let [column, row] = self.place(index);
            let sign = if (column + row).is_multiple_of(2) { 1.0 } else { -1.0 };
            contrast(image, self.corners[index], &self.steps(index)?).map(|contrast| sign * contrast.mean)
        };
        let all = (0..self.corners.len()).map(own).collect::<Option<Vec<f64>>>()?;
        let mut sizes: Vec<f64> = all.iter().map(|contrast| contrast.abs()).collect();
        sizes.sort_by(f64::total_cmp);
        let least = EVEN * sizes[sizes.len() / 2];
        (all.iter().all(|contrast| contrast * all[0] > 0.0) && sizes[0] > least).then_some(all)
    }

    /// Whether dark and light squares go on beyond a border, given by its corners and the step across it.
    fn goes_on(&self, image: &Image, border: &[usize], axis: usize, sign: i32) -> bool {
        let beyond = |index: &&usize| {
            let index = **index;
            let by = |times: i32| if axis == 0 { [times * sign, 0] } else { [0, times * sign] };
            let (Some(steps), Some(before), Some(earlier)) = (self.steps(index), self.beside(index, by(-1)), self.beside(index, by(-2)))
            else {
                return false;
            };
            let own = self.corners[index];
            let (last, first) = (minus(own, before), minus(before, earlier));
            let across = times(last, (length(last) / length(first)).clamp(0.7, 1.4));
            let at = plus(own, across);
            if at.iter().any(|at| *at < 0.0) || at[0] > image.width() as f64 - 1.0 || at[1] > image.height() as f64 - 1.0 {
                return false;
            }
            let Steps(mut there) = steps;
            there[axis] = times(across, f64::from(sign));
            let (Some(beyond), Some(own)) = (contrast(image, at, &Steps(there)), contrast(image, own, &Steps(there))) else { return false };
            // Neighbours have the opposite sign.
            -beyond.mean * own.mean.signum() > BEYOND_CONTRAST * own.mean.abs() && beyond.least > BEYOND_EVEN * beyond.mean.abs()
        };
        border.iter().filter(beyond).count() as f64 >= BEYOND * border.len() as f64
    }

    /// Whether it is larger than it was found.
    fn is_larger(&self, image: &Image) -> bool {
        let line = |axis: usize, at: usize| -> Vec<usize> {
            let along = |other: usize| if axis == 0 { other * self.columns + at } else { at * self.columns + other };
            (0..if axis == 0 { self.rows } else { self.columns }).map(along).collect()
        };
        let size = [self.columns, self.rows];
        (0..2).any(|axis| self.goes_on(image, &line(axis, 0), axis, -1) || self.goes_on(image, &line(axis, size[axis] - 1), axis, 1))
    }

    /// Whether its squares are so large that one more would be seen.
    fn is_resolved(&self) -> bool {
        upper_median((0..self.corners.len()).map(|index| self.step(index))).is_some_and(|step| step > RESOLVED)
    }

    /// Whether these are the corners of a board, all of them.
    pub(super) fn stands(&mut self, image: &Image) -> bool {
        let Some(contrasts) = self.contrasts(image).filter(|_| self.settled && self.is_resolved()) else { return false };
        self.starts_dark = contrasts.iter().sum::<f64>() < 0.0;
        !self.is_larger(image)
    }

    /// Turned by a quarter: the last of each row comes first.
    fn turned(&self) -> Self {
        let place = |index: usize| (index % self.rows) * self.columns + (self.columns - 1 - index / self.rows);
        let places = || (0..self.corners.len()).map(place);
        let corners = places().map(|place| self.corners[place]).collect();
        let seen = places().map(|place| self.seen[place]).collect();
        // Along a row dark and light squares alternate.
        Self {
            columns: self.rows,
            rows: self.columns,
            corners,
            seen,
            settled: self.settled,
            starts_dark: self.starts_dark == self.columns.is_multiple_of(2),
        }
    }

    /// With the counts that are asked for, from the start that the rule of order has; `None` if it has other counts.
    pub(super) fn ordered(self, columns: usize, rows: usize) -> Option<Self> {
        let turns = std::iter::successors(Some(self), |board| Some(board.turned())).take(4);
        let mut turns: Vec<Self> = turns.filter(|board| (board.columns, board.rows) == (columns, rows)).collect();
        if turns.iter().any(|board| board.starts_dark) {
            turns.retain(|board| board.starts_dark);
        }
        turns.into_iter().min_by(|a, b| length(a.corners[0]).total_cmp(&length(b.corners[0])))
    }
}
