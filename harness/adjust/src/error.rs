//! Why there is no solution.

use thiserror::Error;

use crate::defect::Defect;
use crate::network::NetworkError;

/// Why an adjustment has no result.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum AdjustError {
    /// What was given is not a network.
    #[error(transparent)]
    Network(#[from] NetworkError),
    /// A start value does not picture a point that was measured.
    #[error("the start values do not picture point {point} in image {image}: {why}")]
    NotPictured {
        /// Name of the image.
        image: String,
        /// Name of the point.
        point: String,
        /// The reason.
        why: calibench_model::camera::NoCounterpart,
    },
    /// The observations do not determine all unknowns.
    #[error("{0}")]
    Undetermined(Box<Defect>),
    /// The iteration did not come to rest.
    #[error("not converged after {iterations} iterations: a step would still change the sum of squares by {gain:.1e} of {cost:.3e}")]
    NotConverged {
        /// Iterations done.
        iterations: usize,
        /// What the next step promises to take off the weighted sum of squares.
        gain: f64,
        /// Weighted sum of squares reached, a number.
        cost: f64,
    },
    /// A result was asked for that this solution does not have.
    #[error("{0}")]
    NotAvailable(&'static str),
}
