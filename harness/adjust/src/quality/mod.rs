//! What the result is worth.

mod covariance;
mod frame_uncertainty;
mod image_information;
mod lengths;
mod own;
mod projection_uncertainty;
mod reliability;
mod residual_length;
mod residuals;
mod robust;
mod significance;
mod snooping;

pub use covariance::{Correlation, Covariances, Variance};
pub(crate) use frame_uncertainty::by_turn;
pub use frame_uncertainty::{Distance, Uncertainty, frame_uncertainty, frame_weight};
pub use image_information::image_information;
pub use lengths::Length;
pub use own::OwnNumber;
pub use projection_uncertainty::Held;
pub use reliability::{ObservedReliability, PointReliability, Reliability, Test};
pub(crate) use reliability::{critical, image_point};
pub(crate) use residual_length::length;
pub(crate) use residuals::each;
pub use residuals::{Residual, Use};
pub use robust::{adjust_robustly, scale_of};
pub use significance::{Comparison, Significance, compare};
pub use snooping::{Found, Snooping, snoop};
