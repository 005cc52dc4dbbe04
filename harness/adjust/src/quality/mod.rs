//! What the result is worth.

mod counted;
mod covariance;
mod defect;
mod directions;
mod geometry;
mod names;

pub(crate) use counted::counted;
pub use covariance::{Correlation, Covariances, Variance};
pub use defect::{Defect, Direction, Reason};
pub(crate) use directions::directions;
