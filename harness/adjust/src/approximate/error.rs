//! Why there are no start values.

use thiserror::Error;

/// Why a closed form or a search has no answer.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ApproximateError {
    /// Not enough points, rays or views.
    #[error("{task} needs at least {needed} {of}, found {found}")]
    TooFew {
        /// What was to be determined.
        task: &'static str,
        /// What is counted, as in "sights".
        of: &'static str,
        /// How many it takes.
        needed: usize,
        /// How many there are.
        found: usize,
    },
    /// A coordinate is not a number.
    #[error("a coordinate of point {index} is not a number")]
    NotFinite {
        /// The point, from 0.
        index: usize,
    },
    /// The points lie on a line, or all but one do, or coincide.
    #[error("the points lie on a line, or all but one of them do")]
    Collinear,
    /// The points lie in a plane and the task needs depth.
    #[error("the points lie in a plane: the object needs depth")]
    Coplanar,
    /// The points do not lie in a plane and the task needs one.
    #[error("the points do not lie in a plane")]
    NotCoplanar,
    /// The pictured points lie on a line, or coincide.
    #[error("the pictured points lie on a line, or coincide")]
    ImageCollinear,
    /// A pixel that no ray of this camera comes to.
    #[error("point {index} lies where the camera pictures nothing")]
    NotInCamera {
        /// The point, from 0.
        index: usize,
    },
    /// No view shows its plane in perspective: c cannot be told from the distance.
    #[error("no view of a plane is tilted enough to show perspective: the principal distance cannot be told from the distance")]
    NoPerspective,
    /// The views contradict a camera with square pixels and a central principal point.
    #[error("the views fit no camera with square pixels: are image and object points assigned rightly?")]
    NoInterior,
    /// The pictures show a rotation alone: there is no base.
    #[error("the pictures differ by a rotation alone: there is no base, or all points are too far away to show it")]
    NoBase,
    /// The rays are parallel within what their measurement tells.
    #[error("the rays are parallel: the largest angle between them is {angle_deg:.2e} degrees")]
    Parallel {
        /// The largest angle between two rays, degrees.
        angle_deg: f64,
    },
    /// The rays meet behind a camera.
    #[error("the rays meet behind camera {index}")]
    Behind {
        /// The ray, from 0.
        index: usize,
    },
    /// No solution has the points before the camera.
    #[error("no orientation has the points before the camera")]
    NoSolution,
    /// The points do not determine what was asked: they lie on a critical surface or curve, or too close to one.
    #[error("the points do not determine {what}: they are critical, on or close to a surface on which several solutions meet")]
    Critical {
        /// What is not determined.
        what: &'static str,
    },
    /// Too few points agree on anything.
    #[error("only {agreeing} of {found} points agree on an orientation, at least {needed} must")]
    NoConsensus {
        /// How many agree with the best.
        agreeing: usize,
        /// How many there are.
        found: usize,
        /// How many must agree.
        needed: usize,
    },
    /// A size or a number of a data sheet that cannot be.
    #[error("a camera needs a positive size, pitch and focal length")]
    DataSheet,
}

/// The error for fewer than `needed` of something.
pub(super) fn at_least(needed: usize, found: usize, of: &'static str, task: &'static str) -> Result<(), ApproximateError> {
    if found < needed { Err(ApproximateError::TooFew { task, of, needed, found }) } else { Ok(()) }
}
