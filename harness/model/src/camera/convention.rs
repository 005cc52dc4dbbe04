//! What a convention says, as data: for lists, and for messages that ask for the flag that decides an open point.

use serde::{Deserialize, Serialize};

/// Which way the polynomial of a model goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// The polynomial takes ideal coordinates and gives distorted ones.
    IdealToDistorted,
    /// The polynomial takes measured coordinates and gives ideal ones.
    MeasuredToIdeal,
}

/// What the position (0, 0) is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PixelOrigin {
    /// The centre of the top-left pixel.
    PixelCentre,
    /// The outer corner of the top-left pixel.
    PixelCorner,
    /// The centre of the frame.
    FrameCentre,
}

/// Where y points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Vertical {
    /// Up.
    Up,
    /// Down.
    Down,
}

/// Which of the two decentring terms is called p1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum TangentialOrder {
    /// p1 multiplies r^2 + 2 x^2 in x: Brown's.
    Brown,
    /// p1 multiplies 2 x y in x, p2 multiplies r^2 + 2 x^2: OpenCV's.
    OpenCv,
    /// The model has no such terms.
    Without,
}

/// How far a convention is confirmed by numbers of the tool itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verification {
    /// Numbers of the tool were reproduced: which.
    Verified(&'static str),
    /// Some point is open: which, and what is assumed.
    Unverified(&'static str),
    /// A definition of its own: nothing to reproduce.
    Definition,
}

/// A convention, described.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Convention {
    /// Name on the command line.
    pub name: &'static str,
    /// One line for lists.
    pub about: &'static str,
    /// Versions of the tool that it holds for; "" if there is but one.
    pub version: &'static str,
    /// Which way its polynomial goes.
    pub direction: Direction,
    /// The origin of its image coordinates.
    pub pixel_origin: PixelOrigin,
    /// What the principal point is counted from.
    pub principal_point_from: PixelOrigin,
    /// Where y points.
    pub y: Vertical,
    /// Order of p1 and p2.
    pub order: TangentialOrder,
    /// What coordinates are divided by before the polynomial, and units.
    pub normalisation: &'static str,
    /// Where this is published.
    pub source: &'static str,
    /// What of it was reproduced.
    pub verification: Verification,
}
