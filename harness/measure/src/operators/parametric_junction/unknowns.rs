//! What is unknown of a junction, and where it stands among the unknowns.

use std::f64::consts::PI;

use super::arms::{MOST, Shape};
use crate::gradient::{ADDED, EACH, EVEN, LIGHT};

/// Most unknowns: of four sectors that change each for itself.
pub(super) const WIDEST: usize = 17;

/// In this order: position x, y (px), directions (rad; of four arms those of the two lines), variance of the blur (px^2), the sectors' grey values, and how
/// they change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Unknowns {
    pub(super) arms: usize,
    pub(super) gradient: u8,
}

impl Unknowns {
    /// Of directions. Four arms are two lines.
    pub(super) fn directions(self) -> usize {
        if self.arms == 4 { 2 } else { self.arms }
    }

    pub(super) fn direction(self, arm: usize) -> usize {
        2 + arm % self.directions()
    }

    pub(super) fn variance(self) -> usize {
        2 + self.directions()
    }

    pub(super) fn grey(self, sector: usize) -> usize {
        self.variance() + 1 + sector
    }

    pub(super) fn slope(self) -> usize {
        self.grey(self.arms)
    }

    pub(super) fn count(self) -> usize {
        let slopes = match self.gradient {
            EVEN => 0,
            ADDED | LIGHT => 2,
            _ => 2 * self.arms,
        };
        self.slope() + slopes
    }

    pub(super) fn shape(self, x: &[f64], photosite: f64) -> Shape {
        let mut directions = [0.0; MOST];
        for (arm, direction) in directions.iter_mut().enumerate().take(self.arms) {
            *direction = x[self.direction(arm)] + if self.arms == 4 && arm >= 2 { PI } else { 0.0 };
        }
        Shape { directions, arms: self.arms, variance: x[self.variance()], photosite }
    }

    /// `black` is the grey value of no light.
    pub(super) fn levels(self, x: &[f64], black: f64) -> Levels {
        let pair = |first: usize| [x[first] as f32, x[first + 1] as f32];
        let mut levels = Levels { unknowns: self, grey: [0.0; MOST], slopes: [[0.0; 2]; MOST], common: [0.0; 2], black: black as f32 };
        for sector in 0..self.arms {
            levels.grey[sector] = x[self.grey(sector)] as f32;
            if self.gradient == EACH {
                levels.slopes[sector] = pair(self.slope() + 2 * sector);
            }
        }
        if matches!(self.gradient, ADDED | LIGHT) {
            levels.common = pair(self.slope());
        }
        levels
    }
}

/// The sectors' grey values and how they change over the window.
#[derive(Clone, Copy)]
pub(super) struct Levels {
    pub(super) unknowns: Unknowns,
    /// At the point where arms meet.
    pub(super) grey: [f32; MOST],
    /// Of each sector, where they change each for itself.
    pub(super) slopes: [[f32; 2]; MOST],
    /// Of all, added or as a share of the light.
    pub(super) common: [f32; 2],
    pub(super) black: f32,
}

impl Levels {
    /// The grey value of a sector at (`x`, `y`) from the point, but for what all have in common.
    #[inline(always)]
    pub(super) fn of_sector(&self, sector: usize, x: f32, y: f32) -> f32 {
        self.grey[sector] + (self.slopes[sector][0] * x + self.slopes[sector][1] * y)
    }

    /// What all have in common there: what is added, and by what share the grey value above black grows.
    #[inline(always)]
    pub(super) fn common(&self, x: f32, y: f32) -> (f32, f32) {
        let along = self.common[0] * x + self.common[1] * y;
        if self.unknowns.gradient == LIGHT { (0.0, along) } else { (along, 0.0) }
    }
}
