//! A checked sensor, and what its table does not say itself.

use calibench_model::PixelPoint;
use calibench_synth::sensor::Sensor;

/// What a sensor's table refers to and does not say itself.
#[derive(Clone, Copy, Debug, Default)]
pub struct Surroundings {
    /// The camera's principal distance, px.
    pub principal_distance: Option<f64>,
    /// The camera's principal point.
    pub principal_point: Option<PixelPoint>,
    /// Difference of light and dark targets before exposure, fraction of full scale.
    pub contrast: Option<f64>,
    /// Mean grey value before exposure, fraction of full scale.
    pub mean: Option<f64>,
}

/// A checked `[sensor]` table.
#[derive(Clone, Debug, PartialEq)]
pub struct SensorSetup {
    /// The sensor.
    pub sensor: Sensor,
    /// Standard deviation of the rows' shifts, px: for the renderer.
    pub row_jitter: f64,
}
