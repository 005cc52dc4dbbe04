//! Stations: where cameras stand and what they look at.
//!
//! Each generator is a struct of checked parameters, angles in radians, that makes named stations around an [`Aim`]. Whether a station sees the field
//! is asked afterwards, with [`sees`] or [`check_sight`].

pub mod aim;
pub mod board;
pub mod convergent;
mod own;
pub mod random;
pub mod stand;
mod visibility;

use std::borrow::Cow;

use calibench_model::testfield::Bend;
use calibench_model::{Plate, Pose, Testfield};
use thiserror::Error;

pub use aim::Aim;
pub use board::BoardViews;
pub use convergent::{Arc, Ring};
pub use own::Own;
pub use random::RandomViews;
pub use stand::{Stand, StandBend};
pub use visibility::{check_sight, sees};

/// A camera's place, with a name for records and tables.
#[derive(Clone, Debug, PartialEq)]
pub struct Station {
    /// Its name.
    pub name: String,
    /// Exterior orientation.
    pub pose: Pose,
    /// How the field is bent before this camera, if what holds it bends it: in the axes of its one plate. `None` leaves the field as it is.
    pub bend: Option<Bend>,
    /// What its image has of its own.
    pub own: Own,
}

impl Station {
    /// A station before a field as it is.
    pub fn new(name: String, pose: Pose) -> Self {
        Self { name, pose, bend: None, own: Own::default() }
    }

    /// The field as it is before this camera.
    pub fn field<'a>(&self, field: &'a Testfield) -> Cow<'a, Testfield> {
        if self.bend.is_none() {
            return Cow::Borrowed(field);
        }
        let plates = field.plates.iter().map(|plate| Plate { bend: self.bend, ..plate.clone() }).collect();
        Cow::Owned(Testfield { plates, targets: field.targets.clone(), background: field.background })
    }
}

/// Why stations cannot be made or used.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum StationError {
    /// A parameter out of its range.
    #[error("`{parameter}` is {value}: expected {expected}")]
    Parameter {
        /// Its name in scenarios.
        parameter: &'static str,
        /// What it is; angles in degrees.
        value: f64,
        /// Values that are allowed.
        expected: String,
    },
    /// A list that is too long.
    #[error("`{parameter}` has {found} values: expected at most {most}, each is one digit of the names of stations")]
    Many {
        /// Its name in scenarios.
        parameter: &'static str,
        /// How many there are.
        found: usize,
        /// How many there may be.
        most: usize,
    },
    /// A field of several sheets, or of none, on a stand.
    #[error("a stand bends a testfield of one sheet: this one has {0}")]
    Plates(usize),
    /// A bent sheet on a stand that bends it.
    #[error("the stand bends plate `{0}`, which is bent itself: expected one of them, `bend = 0` in [testfield] makes it flat")]
    BentTwice(String),
    /// A list without elements.
    #[error("`{0}` is empty: expected at least one")]
    Empty(&'static str),
    /// A station whose pose is not determined.
    #[error("station `{0}` looks along the field's upwards direction, or stands where it looks: its pose is not determined")]
    Undetermined(String),
    /// Two stations of one name.
    #[error("station `{0}` stands here a second time; expected each name once")]
    Twice(String),
    /// A station that does not see the field.
    #[error("station `{name}` does not see the field: {seen} of {all} targets inside the frame, expected at least {least}")]
    Unseen {
        /// Its name.
        name: String,
        /// Targets that it sees.
        seen: usize,
        /// Targets that there are.
        all: usize,
        /// How many it should see.
        least: usize,
    },
    /// No station within the bounds sees the field.
    #[error("station `{name}`: none of {tries} random poses within the bounds sees enough of the field")]
    NoneSees {
        /// Its name.
        name: String,
        /// How many were tried.
        tries: usize,
    },
}

fn within(parameter: &'static str, value: f64, least: f64, most: f64) -> Result<(), StationError> {
    if value >= least && value <= most {
        return Ok(());
    }
    Err(StationError::Parameter { parameter, value, expected: format!("a number from {least} to {most}") })
}

/// An angle in radians, its bounds and messages in degrees.
fn angle(parameter: &'static str, value: f64, least: f64, most: f64) -> Result<(), StationError> {
    const ROUNDING: f64 = 1e-9;
    let degrees = value.to_degrees();
    if degrees >= least - ROUNDING && degrees <= most + ROUNDING {
        return Ok(());
    }
    Err(StationError::Parameter { parameter, value: degrees, expected: format!("{least} to {most} degrees") })
}

fn length(parameter: &'static str, value: f64) -> Result<(), StationError> {
    within(parameter, value, 1e-6, 1e9)
}

fn rolls(rolls: &[f64]) -> Result<(), StationError> {
    if rolls.is_empty() {
        return Err(StationError::Empty("rolls"));
    }
    rolls.iter().try_for_each(|&roll| angle("rolls", roll, -360.0, 360.0))
}

/// Whether all names differ.
///
/// # Errors
/// The first name that stands twice.
pub fn check_names(stations: &[Station]) -> Result<(), StationError> {
    let twice = stations.iter().enumerate().find(|(i, station)| stations[..*i].iter().any(|other| other.name == station.name));
    twice.map_or(Ok(()), |(_, station)| Err(StationError::Twice(station.name.clone())))
}

/// The name of place `index`, counted from 0, with roll number `roll` if there are several: `s01`, or `s01-r2`.
fn named(index: usize, roll: usize, rolls: usize) -> String {
    if rolls > 1 { format!("s{:02}-r{}", index + 1, roll + 1) } else { format!("s{:02}", index + 1) }
}

#[cfg(test)]
mod tests;
