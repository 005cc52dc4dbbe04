//! Image coordinates and control to orientations, object points and their covariance. Truth is not known here.

pub mod approximate;
mod counts;
mod datum;
mod error;
mod network;
mod normal;
mod quality;
mod solution;
mod solve;
mod state;

pub use counts::Counts;
pub use error::AdjustError;
pub use network::{Attitude, Centre, Datum, Exterior, ImageObservation, Interior, Network, NetworkError, ObjectPoint, Precision, Status};
pub use quality::{
    Comparison, Correlation, Covariances, Defect, Direction, Distance, Found, ObservedReliability, PointReliability, Reason, Reliability,
    Residual, Significance, Snooping, Test, Uncertainty, Use, Variance, compare, frame_uncertainty, snoop,
};
pub use solution::{Options, Solution, adjust};
