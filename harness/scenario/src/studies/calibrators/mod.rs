//! `[calibrators]` and `[[calibrator]]`: whole calibration systems, each told the same points of every trial.

mod read;
#[cfg(test)]
mod tests;
pub mod wire;

pub(crate) use read::read;

use super::plan::StudyPlan;

/// Checked tables.
#[derive(Clone, Debug, PartialEq)]
pub struct Calibrators {
    /// The camera model asked for.
    pub model: String,
    /// The standard deviation of an image coordinate that calibrators are told, px; `None` where they are not.
    pub sigma_px: Option<f64>,
    /// Where coordinates are drawn: of each method, in the scenario's order, the standard deviation per axis, px.
    pub drawn: Option<Vec<(String, Option<f64>)>>,
    /// The focal length that is told as a start to those that want one, px.
    pub start_f: f64,
    /// At which distance lengths are compared, object units.
    pub distance: f64,
    /// What is wrong with what they are told.
    pub faults: Faults,
    /// The calibrators' names, each once.
    pub names: Vec<String>,
}

/// What calibrators are told wrongly, or what is not as they take it to be. Nothing by default.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Faults {
    /// The share of image points in gross error.
    pub gross: f64,
    /// From how many to how many pixels those are off, in any direction.
    pub gross_px: [f64; 2],
    /// The share of image points that bear the name of another of their image, whose point bears theirs.
    pub exchanged: f64,
    /// Object coordinates as told over those that are true.
    pub told_scale: f64,
    /// How far the camera moves along the frame's rows while an image is read out, object units.
    pub shutter: f64,
    /// Principal distance of the camera of every second image over that of the others.
    pub other_c: f64,
}

impl Default for Faults {
    fn default() -> Self {
        Self { gross: 0.0, gross_px: [3.0, 30.0], exchanged: 0.0, told_scale: 1.0, shutter: 0.0, other_c: 1.0 }
    }
}

impl StudyPlan for Calibrators {
    fn sets(&self) -> Vec<String> {
        self.names.clone()
    }

    fn is_random(&self) -> bool {
        let drawn = self.drawn.iter().flatten().any(|(_, sigma)| sigma.is_some_and(|sigma| sigma > 0.0));
        drawn || self.faults.gross > 0.0 || self.faults.exchanged > 0.0
    }

    fn drawn(&self) -> Option<&[(String, Option<f64>)]> {
        self.drawn.as_deref()
    }

    fn runs_apart(&self) -> bool {
        true
    }
}
