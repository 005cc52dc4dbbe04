//! Images to image coordinates: one operator a file.
//!
//! An operator sees an image and a [`Start`](calibench_model::Start) and nothing else: this crate does not depend on the one that knows the truth.
//! To add one, write its file and its two lines in [`operators`], and call [`conformance::check`] on it.

pub mod blob;
mod blurred_ellipse;
mod blurred_step;
pub mod board;
mod cholesky;
pub mod conformance;
pub mod coverage;
mod disc_fit;
pub mod ellipse;
mod error;
pub mod finder;
mod following;
mod gradient;
mod grey_window;
pub mod harris;
pub mod kinds;
mod lanes;
mod marquardt;
pub mod operator;
pub mod operators;
mod otsu;
mod owen;
pub mod paraboloid;
pub mod paraboloid_precision;
pub mod parameter;
mod photosite;
pub mod recorded;
pub mod registry;
mod residuals;
pub mod strength_noise;
/// The example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

#[cfg(test)]
mod tests;

pub use board::{Board, BoardDetector};
pub use coverage::KindsGap;
pub use error::MethodError;
pub use finder::{BoardFinder, BoardPointFound, Sought};
pub use kinds::{Kinds, KindsError};
pub use operator::{Finds, Operator};
pub use operators::*;
pub use parameter::{Parameter, Setting, Settings};
pub use recorded::{ImageId, Known, Recorded, RunId};
pub use registry::{Build, Configured, Method, Outside, Registry};
