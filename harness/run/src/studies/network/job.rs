//! What is true, and what the scenario says of the adjustment.

use calibench_model::Testfield;
use calibench_model::camera::Camera;
use calibench_scenario::{Calibration, Unit};
use calibench_synth::stations::Station;

/// What is true, and what the scenario says of the adjustment.
#[derive(Clone, Copy)]
pub struct Job<'a> {
    /// What to do.
    pub calibration: &'a Calibration,
    /// The wall as it is, with its coordinates as surveyed.
    pub field: &'a Testfield,
    /// The object unit.
    pub unit: Unit,
    /// The true camera.
    pub camera: &'a Camera,
    /// The true poses.
    pub stations: &'a [Station],
}
