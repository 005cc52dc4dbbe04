//! What the tables of a study are about.

use calibench_model::Testfield;
use calibench_model::camera::Camera;
use calibench_synth::stations::Station;

/// The views whose points are studied.
pub struct Seen<'a> {
    /// The true camera.
    pub camera: &'a Camera,
    /// The testfield.
    pub field: &'a Testfield,
    /// The stations.
    pub stations: &'a [Station],
    /// Whether the stations are others in each trial.
    pub redrawn: bool,
    /// Standard deviation per axis of the survey of `[testfield]`, object units: one for all trials.
    pub survey_sigma: Option<f64>,
}
