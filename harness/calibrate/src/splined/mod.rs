//! Cameras of splines before control that is known.

mod calibration;
mod doubted;
mod doubts;
mod grid;
mod gross;
mod prepared;
mod whole;

pub use calibration::SplinedCalibration;
pub use doubted::{SplinedDoubt, SplinedSubject};
pub use grid::{Core, SplineGrid};
pub use prepared::{SplinedPrepared, SplinedSettings, prepare_splined};
pub use whole::calibrate_splined;
