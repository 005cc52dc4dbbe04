//! The two grey values and how they change over the window.

use super::model::BASE;
use crate::gradient::{ADDED, EVEN, LIGHT};

/// The grey value is `mean + mean_slope . d + (half + half_slope . d) f`, with d from the corner, px, and f from -1 to 1 by the model.
pub(super) struct Levels {
    /// Mean of the two grey values at the corner, above the black of no light.
    above_black: f32,
    pub(super) mean: f32,
    pub(super) half: f32,
    light_slope: [f32; 2],
    mean_slope: [f32; 2],
    half_slope: [f32; 2],
}

/// At one pixel.
pub(super) struct Level {
    pub(super) mean: f32,
    pub(super) half: f32,
    /// Of the light, that at the corner being 1.
    pub(super) gain: f32,
}

impl Levels {
    /// Those among the unknowns `x`, of which `black` is the grey value of no light.
    pub(super) fn of<const GRADIENT: u8>(x: &[f64], black: f64) -> Self {
        let pair = |first: usize| [x[first], x[first + 1]];
        let (mean, half, none) = (x[5], x[6], [0.0; 2]);
        let (light, of_mean, of_half) = match GRADIENT {
            EVEN => (none, none, none),
            ADDED => (none, pair(BASE), none),
            LIGHT => (pair(BASE), pair(BASE).map(|g| g * (mean - black)), pair(BASE).map(|g| g * half)),
            _ => (none, pair(BASE), pair(BASE + 2)),
        };
        let single = |pair: [f64; 2]| pair.map(|value| value as f32);
        let [light_slope, mean_slope, half_slope] = [light, of_mean, of_half].map(single);
        Self { above_black: (mean - black) as f32, mean: mean as f32, half: half as f32, light_slope, mean_slope, half_slope }
    }

    #[inline(always)]
    pub(super) fn at<const GRADIENT: u8>(&self, x: f32, y: f32) -> Level {
        let along = |slope: [f32; 2]| slope[0] * x + slope[1] * y;
        let mut level = Level { mean: self.mean, half: self.half, gain: 1.0 };
        if GRADIENT != EVEN {
            level.mean += along(self.mean_slope);
        }
        if GRADIENT >= LIGHT {
            level.half += along(self.half_slope);
        }
        if GRADIENT == LIGHT {
            level.gain += along(self.light_slope);
        }
        level
    }

    /// The derivative by the position, of what it does through the slopes; `axis` is x or y.
    #[inline(always)]
    pub(super) fn by_position<const GRADIENT: u8>(&self, axis: usize, f: f32) -> f32 {
        -(self.mean_slope[axis] + if GRADIENT >= LIGHT { self.half_slope[axis] * f } else { 0.0 })
    }

    /// The derivatives by the slopes of one axis, `d` px from the corner along it: the second where there are four of them.
    #[inline(always)]
    pub(super) fn by_slopes<const GRADIENT: u8>(&self, d: f32, f: f32) -> [f32; 2] {
        if GRADIENT == LIGHT { [d * (self.above_black + self.half * f), 0.0] } else { [d, d * f] }
    }
}
