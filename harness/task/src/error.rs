//! Why a task cannot be measured.

use thiserror::Error;

/// Why a task cannot be measured.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum TaskError {
    /// A point is in too few images.
    #[error("point {point} of what is measured lies in the frame of {found} images; expected {expected}")]
    NotSeen {
        /// Counted from 1.
        point: usize,
        /// Images that show it.
        found: usize,
        /// Images that it takes.
        expected: usize,
    },
    /// An image shows too few control points, or such as do not determine its pose.
    #[error("image {image} shows {found} control points, which do not determine its pose; expected 4 at least, not on a line")]
    Control {
        /// Counted from 1.
        image: usize,
        /// Those in its frame.
        found: usize,
    },
    /// A point does not lie in the known plane.
    #[error("point {point} of what is measured lies {off:.3e} off the known plane; expected all in it")]
    OffPlane {
        /// Counted from 1.
        point: usize,
        /// How far, object units.
        off: f64,
    },
    /// A bend of control that lies on no plane.
    #[error("flatness_sigma is that of a board, and the control points lie in no plane; leave it out, and state sX,sY,sZ of the points")]
    NoBoard,
    /// A covariance with a parameter that the camera does not have.
    #[error("the camera's covariance names `{0}`, which it does not have")]
    Parameter(String),
    /// Rays that do not meet, or meet a plane nowhere.
    #[error("the rays do not determine what is measured: {0}")]
    Geometry(String),
    /// Points from which the quantity does not follow.
    #[error("{0}")]
    Quantity(&'static str),
}
