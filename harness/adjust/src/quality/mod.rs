//! What the result is worth.

mod counted;
mod covariance;
mod defect;
mod directions;
mod frame;
mod geometry;
mod names;
mod reliability;
mod residuals;
mod significance;
mod snooping;

pub(crate) use counted::counted;
pub use covariance::{Correlation, Covariances, Variance};
pub use defect::{Defect, Direction, Reason};
pub(crate) use directions::directions;
pub use frame::{Distance, Uncertainty, frame_uncertainty};
pub use reliability::{ObservedReliability, PointReliability, Reliability, Test};
pub use residuals::{Residual, Use};
pub use significance::{Comparison, Significance, compare};
pub use snooping::{Found, Snooping, snoop};
