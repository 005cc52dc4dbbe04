//! Scenarios to results: truth-blind measuring, scored against the truth at the end.

pub mod blocks;
mod bounded;
mod bounding;
mod bounds;
pub mod description;
mod detection;
mod error;
pub mod judgement;
mod made;
mod measured;
pub mod network;
mod order;
pub mod origin;
pub mod parts;
mod photographs;
mod plan;
mod planned;
pub mod prepared;
pub mod printed;
pub mod recognition;
pub mod reuse;
mod rmse;
mod scene;
pub mod shots;
pub mod store;
mod tally;
mod theory;
mod tools;
pub mod transfer;
mod trials;
pub mod truth;
mod viewed;
mod views;

pub use error::RunError;
pub use order::Order;
pub use plan::Plan;
pub use planned::{Place, Planned, Ran};
pub use scene::{VIEW, starts, trial_picture, trial_truth};
pub use tools::Tools;

/// The example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

#[cfg(test)]
mod tests;
