//! What a task costs that a camera is to measure: a length, a point, an angle, a plane or a rotation with its 95 % interval, and what makes that up.

mod budget;
mod derivatives;
mod error;
mod exact;
mod known_camera;
mod map;
mod quantity;
mod read;
mod scene;
mod simulate;
mod source;
mod task;

pub use budget::{Budget, Component, HALF_95, Part};
pub use error::TaskError;
pub use exact::Exact;
pub use known_camera::KnownCamera;
pub use map::{Cell, Map, map};
pub use quantity::{Named, Quantity};
pub use read::parse;
pub use source::Source;
pub use task::{ControlErrors, KnownPlane, Station, Task, Temperature};

/// The example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

#[cfg(test)]
mod tests;
