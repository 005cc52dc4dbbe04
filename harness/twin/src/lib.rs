//! Twins: scenarios that look like photographs of a chessboard. What images look like (levels, spread of edges, noise, raggedness) is measured in photographs and in their
//! twin alike; the twin is changed until both look the same.

mod design;
mod fitted;
mod geometry;
pub mod look;
mod made_of;
pub mod score;
mod tone;
mod written;

/// The example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

#[cfg(test)]
mod tests;

pub use design::{Design, Smear, ViewDesign};
pub use fitted::{Fitted, fitted};
pub use geometry::{Edge, Geometry, Square};
pub use look::{Look, ViewLook};
pub use made_of::{Part, made_of};
pub use tone::Tone;
pub use written::{Scene, written};
