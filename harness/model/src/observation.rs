//! What an operator is given and what it returns.

use std::fmt;

use crate::{Affine, Covariance, PixelPoint, TargetKind, Warp};

/// Where an operator starts: an approximate position and, for operators that need one, a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// Approximate position.
    pub position: PixelPoint,
    /// What is pictured, if known.
    pub kind: Option<TargetKind>,
    /// The affine start of its picture, if known.
    pub affine: Option<Affine>,
    /// The covariance of the approximate position, px^2, if known.
    pub covariance: Option<Covariance>,
    /// What the lens does to its picture beyond an affine map, if known.
    pub warp: Option<Warp>,
}

impl Start {
    /// A start of which only the position is known.
    pub const fn at(position: PixelPoint) -> Self {
        Self { position, kind: None, affine: None, covariance: None, warp: None }
    }
}

/// A measured image point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measurement {
    /// Its position.
    pub position: PixelPoint,
    /// Its covariance (px^2) as the operator itself estimates it, where theory gives one.
    pub covariance: Option<Covariance>,
}

/// What an operator estimates beside the position.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Unknowns {
    /// The other four parameters of an affine map: directions and sizes.
    pub shape: bool,
    /// Grey levels.
    pub levels: Levels,
    /// The standard deviation of the blur.
    pub blur: bool,
    /// A linear change over the window.
    pub gradient: Gradient,
}

/// The grey levels that are estimated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Levels {
    /// None.
    #[default]
    None,
    /// A dark and a light one.
    Two,
    /// One for each area that the window shows.
    Areas,
}

/// What is estimated to change linearly over a window, beside the pattern itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Gradient {
    /// Nothing.
    #[default]
    None,
    /// A grey value that is added: two unknowns.
    Added,
    /// The light, which multiplies the grey values: two unknowns.
    Light,
    /// Both, or the dark and the light grey value each for itself, which is the same: four unknowns.
    Both,
}

/// Why a point was not measured. A missed point is data.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Rejection {
    /// The operator's window leaves the image.
    Border,
    /// A grey value in the window, or the start itself, is not a number.
    NotFinite,
    /// The window holds no corner: it is flat, or holds a single edge.
    NoCorner,
    /// The strength has no maximum inside the window.
    NoMaximum,
    /// The solution lies outside the window.
    LeftWindow,
    /// The iteration did not converge.
    NotConverged,
    /// The error ellipse of the solution is too large or too flat.
    ErrorEllipse,
    /// The detector found nothing near the target: no operator was given a start.
    NotDetected,
    /// What is pictured was not said, and the operator cannot tell.
    UnknownKind,
    /// What the model leaves of the grey values is no noise: something else is in the window.
    Misfit,
    /// A method from outside says itself that it cannot measure the point.
    Declined,
    /// A method from outside raised an error.
    Raised,
    /// The answer of a method from outside cannot be read, or is not about what was asked.
    Malformed,
    /// A method from outside took longer than it may.
    TooSlow,
    /// The program of a method from outside ended.
    Ended,
    /// The file that is the method has no position of the point.
    NotGiven,
    /// The file that is the method is of another image.
    OtherImage,
}

impl Rejection {
    /// Every reason.
    pub const ALL: [Self; 17] = [
        Self::Border,
        Self::NotFinite,
        Self::NoCorner,
        Self::NoMaximum,
        Self::LeftWindow,
        Self::NotConverged,
        Self::ErrorEllipse,
        Self::NotDetected,
        Self::UnknownKind,
        Self::Misfit,
        Self::Declined,
        Self::Raised,
        Self::Malformed,
        Self::TooSlow,
        Self::Ended,
        Self::NotGiven,
        Self::OtherImage,
    ];

    /// The name in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Border => "border",
            Self::NotFinite => "not_finite",
            Self::NoCorner => "no_corner",
            Self::NoMaximum => "no_maximum",
            Self::LeftWindow => "left_window",
            Self::NotConverged => "not_converged",
            Self::ErrorEllipse => "error_ellipse",
            Self::NotDetected => "not_detected",
            Self::UnknownKind => "unknown_kind",
            Self::Misfit => "misfit",
            Self::Declined => "declined",
            Self::Raised => "raised",
            Self::Malformed => "malformed",
            Self::TooSlow => "too_slow",
            Self::Ended => "ended",
            Self::NotGiven => "not_given",
            Self::OtherImage => "other_image",
        }
    }

    /// The reason in words.
    pub const fn meaning(self) -> &'static str {
        match self {
            Self::Border => "the window leaves the image",
            Self::NotFinite => "a grey value in the window, or the start, is not a number",
            Self::NoCorner => "the window is flat or holds a single edge",
            Self::NoMaximum => "the strength has no maximum inside the window",
            Self::LeftWindow => "the solution lies outside the window",
            Self::NotConverged => "the iteration did not converge",
            Self::ErrorEllipse => "the error ellipse is too large or too flat",
            Self::NotDetected => "the detector found nothing near the target",
            Self::UnknownKind => "what is pictured was not said (`kind`)",
            Self::Misfit => "something else is in the window",
            Self::Declined => "the method says that it cannot measure the point",
            Self::Raised => "the method raised an error",
            Self::Malformed => "the method's answer cannot be read",
            Self::TooSlow => "the method took longer than it may",
            Self::Ended => "the method's program ended",
            Self::NotGiven => "the method's file has no position of the point",
            Self::OtherImage => "the method's file is of another image",
        }
    }
}

impl fmt::Display for Rejection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
