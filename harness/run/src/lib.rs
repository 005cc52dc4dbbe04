//! Scenarios to results: truth-blind measuring, scored against the truth at the end.

mod bounded;
mod bounding;
mod bounds;
pub mod description;
mod detection;
mod error;
pub mod judgement;
pub mod league;
mod made;
mod measured;
mod order;
pub mod origin;
pub mod parts;
mod photographs;
mod place;
mod plan;
pub mod prepared;
pub mod reuse;
mod rmse;
mod scene;
mod setups;
pub mod shots;
pub mod store;
pub mod studies;
mod tally;
mod theory;
mod tools;
mod trials;
pub mod truth;
mod viewed;
mod views;

pub use error::RunError;
pub use order::Order;
pub use place::{Place, Ran};
pub use plan::Plan;
pub use scene::{VIEW, starts, trial_picture, trial_truth};
pub use tools::Tools;

/// The example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

#[cfg(test)]
mod tests;
