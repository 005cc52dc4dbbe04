//! The `[sensor]` table of a scenario: what the camera makes of the light. In the terms and units of EMVA 1288.

mod convert;
mod numbers;
mod setup;
#[cfg(test)]
mod tests;
mod wire;

use calibench_diagnostics::Problem;

use super::section::Section;
pub(crate) use numbers::{Exposure, Gradient, Numbers};
pub use setup::{SensorSetup, Surroundings};
pub use wire::{DemosaicWire, Filter, SensorWire};

/// Reads a `[sensor]` table. Every mistake becomes a problem at its key.
pub fn read_sensor(section: Section<'_>, surroundings: &Surroundings, problems: &mut Vec<Problem>) -> Option<SensorSetup> {
    let keys = convert::Keys::of(&section);
    let wire: SensorWire = section.read(&[], problems)?;
    convert::setup(&wire, &keys, surroundings, problems)
}
