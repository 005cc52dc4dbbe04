//! The frame of the object: similarities, constraints, and the change from one datum to another.

mod held_coordinates;
mod similarity;
mod transform;

pub(crate) use held_coordinates::{hold, undetermined};
pub(crate) use similarity::free;
pub(crate) use transform::{STransformation, transformed};
