//! Pictures of a calibrated scenario.

pub mod distribution;
pub mod factors;
pub mod floor;
pub mod plan;
pub mod residuals;
