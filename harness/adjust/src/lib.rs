//! Image coordinates and control to orientations, object points and their covariance. Truth is not known here.
//!
//! A [`Network`] says what was measured, what is known beforehand and where the unknowns start; [`adjust`] returns a [`Solution`], or says by name what
//! the observations do not determine. Image coordinates are adjusted in pixels of each camera's own model, so that all models stand on equal terms.
//! Resection is a network with known points and camera, intersection one with known images, relative orientation one of two images and
//! [`Datum::Inner`].
//!
//! From a solution: [`Solution::covariances`] (blocks by selected inversion), [`Solution::full_covariance`], [`Solution::residuals`],
//! [`Solution::reliability`] (redundancy numbers, normalised residuals, minimal detectable biases), [`Solution::quality`] (both from one inverse),
//! [`Solution::significance`] of parameters, [`Solution::in_datum`] (S-transformation), [`Solution::length`], [`Solution::projection_uncertainty`],
//! [`frame_uncertainty`]; [`compare`] tells two sets of parameters apart, [`snoop`] looks for blunders, [`adjust_robustly`] holds them back.

pub mod approximate;
mod datum;
mod defect;
mod descent;
mod error;
mod network;
mod normal;
mod quality;
mod rig;
mod solution;
mod solve;
mod splined;
mod state;
mod undetermined;

pub use defect::{Defect, Direction, Reason};
pub use descent::{EXACT, ROUGH};
pub use error::AdjustError;
pub use network::{
    Attitude, Centre, Counts, Datum, DistanceObservation, Exterior, ImageObservation, Interior, Network, NetworkError, ObjectPoint,
    OnSurface, PerImage, Precision, Status, Surface,
};
pub use quality::{
    Comparison, Correlation, Covariances, Distance, Found, Held, Length, ObservedReliability, OwnNumber, PointReliability, Reliability,
    Residual, Significance, Snooping, Test, Uncertainty, Use, Variance, adjust_robustly, compare, frame_uncertainty, frame_weight,
    image_information, scale_of, snoop,
};
pub use rig::{Mount, Rig, RigCovariances, RigSolution, Station, adjoint, adjust_rig, mounted, relative, snoop_rig};
pub use solution::{Options, Solution, adjust};
pub use splined::{KnotPrior, SplinedFit, SplinedNetwork, SplinedPlace, SplinedQuality, SplinedSolution, adjust_splined};
pub use undetermined::far_points;

/// The example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
