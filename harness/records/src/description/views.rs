//! The views of a testfield, as pages of networks draw them.

use serde::{Deserialize, Serialize};

/// A testfield and its stations: those of the first trial where they change. Object space is right-handed.
#[derive(Clone, Debug, PartialEq)]
pub struct Views {
    /// Columns and rows of an image, px.
    pub size: [u32; 2],
    /// The object unit, `mm` or `m`.
    pub unit: String,
    /// A box around all sheets: lowest and highest coordinates, object units; `None` without a sheet.
    pub extent: Option<[[f64; 3]; 2]>,
    /// The normal of the first sheet's front, of unit length, object axes; `None` without a sheet.
    pub normal: Option<[f64; 3]>,
    /// In the order of reports.
    pub stations: Vec<Station>,
    /// In the order of the testfield.
    pub targets: Vec<Target>,
    /// How much room a target has before something else begins, where that is known.
    pub room: Option<Room>,
}

/// The half sides of the largest upright windows around targets in view that hold nothing else, px.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Room {
    /// The least.
    pub least: f64,
    /// The one in the middle.
    pub middle: f64,
}

/// A station.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Station {
    /// Its name.
    pub name: String,
    /// Its projection centre, object units.
    pub centre: [f64; 3],
    /// The direction in which it looks, of unit length, object axes.
    pub sight: [f64; 3],
    /// It is one of the second step, in which check points are intersected.
    pub second_step: bool,
}

/// A target of the testfield.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Target {
    /// Its name.
    pub id: String,
    /// Its kind, as in `chess_corner`.
    pub kind: String,
    /// Its surveyed position, object units.
    pub surveyed: [f64; 3],
    /// What it is in the second step, if it is in it.
    pub role: Option<Role>,
}

/// What a target is in the second step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Role {
    /// A control point.
    Control,
    /// A check point.
    Check,
}
