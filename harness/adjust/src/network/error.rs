//! What a network can lack.

use thiserror::Error;

/// What is wrong with the description of a network.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum NetworkError {
    /// A camera has no parameter of that name.
    #[error("{camera} has no parameter {name}: it has {known}")]
    NoSuchParameter {
        /// Name of the camera.
        camera: String,
        /// What was asked for.
        name: String,
        /// The names that there are.
        known: String,
    },
    /// An index leads nowhere.
    #[error("{of} refers to {what} {index}, of which there are {count}")]
    NoSuch {
        /// The part of the network that it stands in.
        of: String,
        /// To what.
        what: &'static str,
        /// Its index.
        index: usize,
        /// How many there are.
        count: usize,
    },
    /// A number is not finite, or a standard deviation is not positive.
    #[error("{of}: {what}")]
    NotANumber {
        /// The part of the network that it stands in.
        of: String,
        /// The fault.
        what: &'static str,
    },
    /// A camera has more or fewer statuses than parameters.
    #[error("{camera} has {parameters} parameters and {given} statuses")]
    ParameterCount {
        /// Name of the camera.
        camera: String,
        /// Parameters of the model.
        parameters: usize,
        /// Statuses given.
        given: usize,
    },
    /// A point is measured twice in an image.
    #[error("point {point} is measured twice in image {image}")]
    Twice {
        /// Name of the image.
        image: String,
        /// Name of the point.
        point: String,
    },
    /// A number of each image's own changes a parameter that is held.
    #[error("{of} needs {parameter} to be solved for, and it is held")]
    Held {
        /// The number.
        of: String,
        /// The parameter.
        parameter: String,
    },
    /// The datum does not fit what is known.
    #[error("the datum does not fit: {0}")]
    Datum(String),
    /// A surface's points are not what they must be.
    #[error("surface {name}: {why}")]
    Surface {
        /// Its name.
        name: String,
        /// The reason.
        why: &'static str,
    },
    /// There is nothing to adjust.
    #[error("nothing is unknown")]
    NothingUnknown,
}
