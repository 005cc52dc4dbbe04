//! What the observations do not determine, by name.

mod defects_by_count;
mod directions;
mod far;
mod geometry;
mod names;

pub(crate) use defects_by_count::counted;
pub(crate) use directions::directions;
pub use far::far_points;
