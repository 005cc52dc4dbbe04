//! Doubts as JSON.

use calibench_calibrate::{Calibration, Doubt, Finding};
use schemars::JsonSchema;
use serde::Serialize;

/// Why a calibration is in doubt, for programs.
#[derive(Serialize, JsonSchema)]
pub(super) struct Doubted {
    /// What is in doubt: `precision` (of image points), `gross-errors`, `control` (its coordinates), `distances` (that were measured), `board` (whose corners were measured), `lens` (more than the model pictures), `shutter` (rows of an
    /// image exposed one after the other), `frame` (points outside of it), `residuals` (such as no operator leaves), `fold` (inside the frame), `implausible` (a
    /// camera that no lens makes), `crop` (images that are a part), `over-frame` (hardly known there), `together` (errors of an image) or `rival` (another camera fits).
    subject: &'static str,
    /// The name of the camera that it is about; null where it is about all.
    camera: Option<String>,
    /// Probability of residuals as uneven by chance; null where that is not what was asked.
    p: Option<f64>,
    /// By how many of its standard deviations over the frame the camera moves when the cause is allowed for; null where that cannot be said.
    moves: Option<f64>,
    /// In words: the most likely cause, and what to do.
    words: String,
}

impl Doubted {
    pub(super) fn new(calibration: &Calibration<'_>, doubt: &Doubt) -> Self {
        let finding: Option<Finding> = doubt.finding;
        Self {
            subject: doubt.subject.name(),
            camera: doubt.camera.map(|camera| calibration.name_of(camera).to_owned()),
            p: finding.map(|finding| finding.p),
            moves: finding.and_then(|finding| finding.moves),
            words: doubt.words.clone(),
        }
    }
}
