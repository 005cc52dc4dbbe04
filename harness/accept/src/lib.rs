//! Acceptance of measuring: errors of calibrated lengths and of check points against limits, decided with what is known of the reference.

pub mod basis;
mod conformance;
mod decision;
pub mod lengths;
mod limit;
pub mod measured;
pub mod points;

pub use conformance::{Rule, conformance_probability};
pub use decision::Decision;
pub use lengths::{LengthAcceptance, LengthTest};
pub use limit::{Limit, LimitError};
pub use points::{PointAcceptance, PointTest};

/// The example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
