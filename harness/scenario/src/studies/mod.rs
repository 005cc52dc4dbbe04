//! What is made of what a scenario shows: a folder for each study. What is checked stands in its `mod.rs`, what is written in `wire.rs`, and the way from one to
//! the other in `read.rs`.

pub mod acceptance;
pub mod blocks;
pub mod calibrators;
mod named;
pub mod network;
pub mod networks;
mod plan;
mod points;
pub mod printed;
pub mod recognition;
mod seen;
pub mod tasks;
pub mod transfer;

/// The worked example of CONTRIBUTING, linked from `examples/`.
#[cfg(test)]
mod example;

pub(crate) use named::{check_model, filled, matched, places};
pub use plan::StudyPlan;
pub use points::Points;
pub(crate) use seen::Seen;
