//! Image points by image and target: what measuring gives and adjusting takes.

mod lost;
mod names;
mod table;

use crate::observation::Start;

pub use lost::{LostRow, LostRows};
pub use names::Names;
pub use table::{Groups, PointRef, Points};

/// An image point with names of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct PointRow {
    /// The image's file name.
    pub image: String,
    /// The target's name.
    pub target: String,
    /// Position, kind, affine start and covariance.
    pub start: Start,
}
