//! Records, read for reports.

pub mod adjustments;
mod description;
mod error;
mod groups;
mod plain;
pub mod sweep;
pub(crate) mod theory;

pub use description::description;
pub use error::LoadError;
pub use groups::MOST_TARGETS;
pub use plain::{Loaded, load, recorded};
pub use sweep::{LoadedMethod, LoadedSweep};
