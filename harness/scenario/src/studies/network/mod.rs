//! The `[calibration]` table: what is done with the measured points of every trial.

mod read;
#[cfg(test)]
mod tests;
pub mod wire;

use calibench_model::camera::Photogrammetric;

pub(crate) use read::read;

use super::plan::StudyPlan;
use crate::studies::acceptance::Classes;

/// The method whose image coordinates come from the hand alone.
pub const POINTED: &str = "pixel";

/// Interior parameters that are solved for together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ParameterSet {
    /// As written, as in `c,x0,y0,k1`.
    pub name: String,
    /// The parameters.
    pub parameters: Vec<String>,
}

/// A checked `[calibration]` table.
#[derive(Clone, Debug)]
pub struct Calibration {
    /// The first is scored in full.
    pub sets: Vec<ParameterSet>,
    /// Where the adjustment starts.
    pub start: Photogrammetric,
    /// A-priori standard deviation of an image coordinate, px.
    pub sigma_px: f64,
    /// Standard deviation per axis of the error that all methods share, px.
    pub floor_px: f64,
    /// Standard deviation per axis of each trial's survey, object units.
    pub survey_sigma: f64,
    /// What the adjustment is told of control, object units; 0 for fixed control.
    pub control_sigma: f64,
    /// Where coordinates are drawn: of each method, in the scenario's order, the standard deviation per axis, px; `None` for the hand.
    pub drawn: Option<Vec<(String, Option<f64>)>>,
    /// Whether the eccentricity of discs is taken out.
    pub eccentricity: bool,
    /// Whether the image points of every trial are kept.
    pub keep_points: bool,
    /// The second step.
    pub check: Option<CheckPlan>,
}

impl StudyPlan for Calibration {
    fn sets(&self) -> Vec<String> {
        self.sets.iter().map(|set| set.name.clone()).collect()
    }

    fn is_random(&self) -> bool {
        let drawn = self.drawn.iter().flatten().any(|(_, sigma)| sigma.is_some_and(|sigma| sigma > 0.0));
        drawn || self.floor_px > 0.0 || self.survey_sigma > 0.0
    }

    fn keeps_points(&self) -> bool {
        self.keep_points
    }

    fn drawn(&self) -> Option<&[(String, Option<f64>)]> {
        self.drawn.as_deref()
    }

    fn pitch_um(&self) -> Option<f64> {
        Some(self.start.pitch_um)
    }
}

/// The second step, by places in the lists of stations and targets.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckPlan {
    /// Stations.
    pub views: Vec<usize>,
    /// Control points.
    pub control: Vec<usize>,
    /// Check points.
    pub points: Vec<usize>,
    /// The accuracies that they must keep.
    pub acceptance: Option<Classes>,
}
