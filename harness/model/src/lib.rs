//! The vocabulary of calibench: frames, images, targets, observations. No I/O, no randomness.

pub mod boards;
pub mod camera;
pub mod coded;
pub mod control;
pub mod convert;
pub mod eccentricity;
pub mod escape;
pub mod frames;
pub mod image;
pub mod median;
pub mod named_camera;
pub mod observation;
pub mod points;
pub mod pose;
pub mod quadrature;
pub mod reconstruction;
pub mod reframing;
pub mod rig_difference;
pub mod scene;
pub mod station;
pub mod stop;
pub mod target;
pub mod testfield;
pub mod told;
pub mod views;
pub mod warp;

pub use control::{BoardCorner, ControlDisc, ControlRow, MeasuredDistance, TestLength};
pub use frames::{CornerPoint, Covariance, Frame, PixelPoint, SensorPoint};
pub use image::{Image, level};
pub use median::{median, upper_median};
pub use named_camera::NamedCamera;
pub use observation::{Gradient, Levels, Measurement, Rejection, Start, Unknowns};
pub use points::{LostRow, LostRows, PointRef, PointRow, Points};
pub use pose::Pose;
pub use reconstruction::Reconstruction;
pub use scene::{Polygon, Scene, SceneTarget};
pub use station::{ObservedStation, StationRow};
pub use target::{Affine, TargetKind, UnknownKind};
pub use testfield::{Area, Bend, Curve, ObjectTarget, Outline, Plate, Testfield};
pub use told::Told;
pub use warp::Warp;

/// The example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
