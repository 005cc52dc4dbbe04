//! Whole calibration systems as methods: what they are told, what they answer, and how far that is from the truth. Ours is among them; others are programs.
//!
//! A calibrator gets what a user would know, and nothing of the truth. Its answer is a camera, or rays on a fixed grid of pixels, with what it says of its own
//! precision: whichever model a system has, all are compared by where they see what the true camera pictures.

mod answer;
mod calibrator;
mod conformance;
mod held_out;
mod own;
mod program;
mod score;
mod task;
#[cfg(test)]
mod tests;

pub use answer::{Answer, Lens, Precision, Scaled, Status};
pub use calibrator::{Calibrated, Calibrator, Listed};
pub use conformance::check;
pub use held_out::{HeldOut, Predicted};
pub use own::{OURS, own};
pub use program::{ReadCamera, programs};
pub use score::{Grid, LENGTH_MM, Score, Truth};
pub use task::{Start, Task, TaskImage};

/// The example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
