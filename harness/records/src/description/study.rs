//! What is made of the points of views, as pages need it.

use serde::{Deserialize, Serialize};

/// What is made of the points that are measured in views.
#[derive(Clone, Debug, PartialEq)]
pub enum Study {
    /// Each is scored against the truth.
    Points,
    /// They are adjusted with control.
    Network(Adjustment),
    /// Free networks are made of them.
    Blocks(Blocks),
    /// Nothing is measured: calibrations that are made elsewhere are applied here.
    Transfer,
}

/// What the adjustment of the measured points is told.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Adjustment {
    /// The pixel pitch, um.
    pub pitch_um: f64,
    /// Image coordinates are drawn at random, no image is rendered.
    pub drawn: bool,
}

/// What free networks of the measured points are told.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Blocks {
    /// The pixel pitch, um.
    pub pitch_um: f64,
    /// Pairs of images whose residuals are compared, by their names.
    pub pairs: Vec<[String; 2]>,
    /// The blocks whose residuals these are.
    pub compared: Vec<String>,
}
