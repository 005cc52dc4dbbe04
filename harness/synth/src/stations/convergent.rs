//! Convergent networks: stations on a ring around the field's normal, or on an arc before it.

use std::f64::consts::TAU;

use nalgebra::{Rotation3, Unit, Vector3};

use super::{Aim, Station, StationError, angle, length, named, rolls, within};

/// The steepest angle from the normal, degrees.
const STEEPEST: f64 = 85.0;

/// Stations on a ring around the field's normal, all looking at its middle.
#[derive(Clone, Debug, PartialEq)]
pub struct Ring {
    /// How many places, 1 to 1000.
    pub count: usize,
    /// The angle of the lines of sight from the normal, radians, 0 to 85 degrees: opposite stations converge at twice this.
    pub angle: f64,
    /// Where the ring begins, from the field's right towards its upper side, radians.
    pub start: f64,
    /// Distances from the middle, object units, taken in turn.
    pub distances: Vec<f64>,
    /// Rolls (kappa), radians; at every place one image for each.
    pub rolls: Vec<f64>,
}

impl Ring {
    /// The stations, `s01`, `s02`, ...; with several rolls `s01-r1`, `s01-r2`, ...
    ///
    /// # Errors
    /// A parameter out of its range.
    pub fn generate(&self, aim: &Aim) -> Result<Vec<Station>, StationError> {
        within("count", self.count as f64, 1.0, 1000.0)?;
        angle("angle", self.angle, 0.0, STEEPEST)?;
        angle("start", self.start, -360.0, 360.0)?;
        lengths("distances", &self.distances)?;
        let place = |i: usize| {
            let (sine, cosine) = (self.start + TAU * i as f64 / self.count as f64).sin_cos();
            let side = aim.right() * cosine + aim.up.into_inner() * sine;
            let towards = aim.facing.into_inner() * self.angle.cos() + side * self.angle.sin();
            towards * self.distances[i % self.distances.len()]
        };
        stations(aim, (0..self.count).map(place), &self.rolls)
    }
}

/// Stations on an arc before the field, from left to right, all looking at its middle.
#[derive(Clone, Debug, PartialEq)]
pub struct Arc {
    /// How many places, 1 to 1000.
    pub count: usize,
    /// The angle between the lines of sight of the first and the last, radians, 0 to 170 degrees.
    pub convergence: f64,
    /// Distances from the middle, before heights, object units, taken in turn.
    pub distances: Vec<f64>,
    /// Heights over the middle, along the field's upwards direction, object units, taken in turn.
    pub heights: Vec<f64>,
    /// Rolls (kappa), radians; at every place one image for each.
    pub rolls: Vec<f64>,
}

impl Arc {
    /// The stations, named as those of [`Ring`].
    ///
    /// # Errors
    /// A parameter out of its range.
    pub fn generate(&self, aim: &Aim) -> Result<Vec<Station>, StationError> {
        within("count", self.count as f64, 1.0, 1000.0)?;
        angle("convergence", self.convergence, 0.0, 2.0 * STEEPEST)?;
        lengths("distances", &self.distances)?;
        if self.heights.is_empty() {
            return Err(StationError::Empty("heights"));
        }
        self.heights.iter().try_for_each(|&height| within("heights", height, -1e9, 1e9))?;
        let place = |i: usize| {
            let part = if self.count > 1 { i as f64 / (self.count - 1) as f64 - 0.5 } else { 0.0 };
            let turn = Rotation3::from_axis_angle(&aim.up, part * self.convergence);
            let level = turn * aim.facing.into_inner() * self.distances[i % self.distances.len()];
            level + aim.up.into_inner() * self.heights[i % self.heights.len()]
        };
        stations(aim, (0..self.count).map(place), &self.rolls)
    }
}

fn lengths(parameter: &'static str, values: &[f64]) -> Result<(), StationError> {
    if values.is_empty() {
        return Err(StationError::Empty(parameter));
    }
    values.iter().try_for_each(|&value| length(parameter, value))
}

/// At each place (from the middle) one station for each roll.
fn stations(aim: &Aim, places: impl Iterator<Item = Vector3<f64>>, turns: &[f64]) -> Result<Vec<Station>, StationError> {
    rolls(turns)?;
    let up: Unit<Vector3<f64>> = aim.up;
    let mut stations = Vec::new();
    for (i, place) in places.enumerate() {
        for (k, &roll) in turns.iter().enumerate() {
            let name = named(i, k, turns.len());
            match calibench_model::Pose::looking_at(aim.middle + place, aim.middle, up.into_inner(), roll) {
                Some(pose) => stations.push(Station::new(name, pose)),
                None => return Err(StationError::Undetermined(name)),
            }
        }
    }
    Ok(stations)
}
