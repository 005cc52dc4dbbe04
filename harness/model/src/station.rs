//! Images and their exterior orientations, known or observed.

use crate::pose::Pose;

/// An image and its exterior orientation.
#[derive(Clone, Debug, PartialEq)]
pub struct StationRow {
    /// The image's name.
    pub image: String,
    /// Its pose.
    pub pose: Pose,
}

/// An image whose exterior orientation was observed, or a part of it.
#[derive(Clone, Debug, PartialEq)]
pub struct ObservedStation {
    /// The image and its pose.
    pub station: StationRow,
    /// Standard deviations of X0, Y0, Z0, object units; `None` where none is given.
    pub centre: Option<[f64; 3]>,
    /// Standard deviations of a small rotation about the camera's axes x, y, z, radians; `None` where none is given.
    pub rotation: Option<[f64; 3]>,
}
