//! What is pictured at a point.

use std::fmt;
use std::str::FromStr;

/// The kinds of target that operators and testfields know by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum TargetKind {
    /// The corner of one area: two edges meet.
    Corner,
    /// Two dark and two light sectors meet: a chessboard's inner corner.
    ChessCorner,
    /// Three or more edges meet between three or more areas.
    Junction,
    /// Two bars cross.
    Cross,
    /// A filled circle.
    Disc,
    /// A filled square.
    Square,
    /// A filled triangle.
    Triangle,
}

impl TargetKind {
    /// Every kind, in the order of the documentation.
    pub const ALL: [Self; 7] = [Self::Corner, Self::ChessCorner, Self::Junction, Self::Cross, Self::Disc, Self::Square, Self::Triangle];

    /// The name in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Corner => "corner",
            Self::ChessCorner => "chess_corner",
            Self::Junction => "junction",
            Self::Cross => "cross",
            Self::Disc => "disc",
            Self::Square => "square",
            Self::Triangle => "triangle",
        }
    }
}

impl fmt::Display for TargetKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for TargetKind {
    type Err = UnknownKind;

    fn from_str(name: &str) -> Result<Self, UnknownKind> {
        Self::ALL.into_iter().find(|kind| kind.name() == name).ok_or_else(|| UnknownKind(name.to_owned()))
    }
}

/// A kind of target that nobody knows.
#[derive(Clone, Debug, thiserror::Error, PartialEq, Eq)]
#[error("no kind of target is called `{0}`; known are {known}", known = TargetKind::ALL.map(TargetKind::name).join(", "))]
pub struct UnknownKind(pub String);

/// The affine part of the map from a target's own plane (unit: the target's size, y down) to the image, px.
///
/// `x = axx u + axy v`, `y = ayx u + ayy v`, from the target's reference point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Affine {
    /// dx/du.
    pub axx: f64,
    /// dx/dv.
    pub axy: f64,
    /// dy/du.
    pub ayx: f64,
    /// dy/dv.
    pub ayy: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_go_both_ways() {
        for kind in TargetKind::ALL {
            assert_eq!(kind.name().parse(), Ok(kind));
        }
        assert!("chess".parse::<TargetKind>().unwrap_err().to_string().contains("chess_corner"));
    }
}
