//! The vocabulary of calibench: frames, images, targets, observations. No I/O, no randomness.

pub mod boards;
pub mod camera;
pub mod coded;
pub mod convert;
pub mod eccentricity;
pub mod escape;
pub mod frames;
pub mod image;
pub mod observation;
pub mod pose;
pub mod quadrature;
pub mod scene;
pub mod stop;
pub mod target;
pub mod testfield;
pub mod told;

pub use frames::{CornerPoint, Covariance, Frame, PixelPoint, SensorPoint};
pub use image::{Image, level};
pub use observation::{Gradient, Levels, Measurement, Rejection, Start, Unknowns};
pub use pose::Pose;
pub use scene::{Polygon, Scene, SceneTarget};
pub use target::{Affine, TargetKind, UnknownKind};
pub use testfield::{Area, Bend, Curve, ObjectTarget, Outline, Plate, Testfield};
pub use told::Told;

/// The example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
