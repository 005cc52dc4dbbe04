//! Images to image coordinates: one operator a file.
//!
//! An operator sees an image and a [`Start`](calibench_model::Start) and nothing else: this crate does not depend on the one that knows the truth.
//! To add one, write its file, name it in [`builtin`](registry::Registry::builtin), and call [`conformance::check`] on it.

#[cfg(test)]
mod analytic;
pub mod blob;
pub mod board;
pub mod centroid;
pub mod chess_corners;
mod cholesky;
pub mod conformance;
mod contour;
pub mod ellipse;
pub mod ellipse_edges;
#[cfg(test)]
mod exact;
pub mod external;
pub mod forstner;
pub mod harris;
pub mod harris_paraboloid;
mod lanes;
pub mod lsm;
mod marquardt;
pub mod operator;
pub mod paraboloid;
pub mod parameter;
pub mod parametric_circle;
pub mod parametric_corner;
pub mod pixel;
pub mod precision;
pub mod registry;
pub mod saddle;
pub mod strength_noise;

pub use board::{Board, BoardDetector};
pub use operator::Operator;
pub use parameter::{Parameter, Settings};
pub use registry::{Configured, Method, MethodError, Registry};
