//! What the result is worth.

mod covariance;
mod defect;
mod defects_by_count;
mod directions;
mod frame_uncertainty;
mod geometry;
mod names;
mod projection_uncertainty;
mod reliability;
mod residuals;
mod robust;
mod significance;
mod snooping;

pub use covariance::{Correlation, Covariances, Variance};
pub use defect::{Defect, Direction, Reason};
pub(crate) use defects_by_count::counted;
pub(crate) use directions::directions;
pub use frame_uncertainty::{Distance, Uncertainty, frame_uncertainty};
pub use projection_uncertainty::Held;
pub use reliability::{ObservedReliability, PointReliability, Reliability, Test};
pub use residuals::{Residual, Use};
pub use robust::{adjust_robustly, scale_of};
pub use significance::{Comparison, Significance, compare};
pub use snooping::{Found, Snooping, snoop};
