//! What is pictured at a point.

use std::fmt;
use std::str::FromStr;

use crate::Outline;

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

    /// The target in its own plane: unit its size, v down, the reference point at (0, 0); the areas that its outlines enclose make it up.
    ///
    /// Disc, square and cross are centred; the bars of a cross lie along u and v and are [`BAR`] wide. The reference point of the (equilateral)
    /// triangle is its centroid; one vertex lies straight up. Of a corner and a chess corner the squares that meet at it are given; what is beyond
    /// them is for their user to know. A junction has no one shape.
    pub fn outlines(self) -> Vec<Outline> {
        let half = 0.5;
        match self {
            Self::Disc => vec![Outline::disc([0.0, 0.0], half)],
            Self::Square => vec![Outline::rectangle([-half, -half], [half, half])],
            Self::Triangle => {
                let height = 3_f64.sqrt() / 2.0;
                vec![Outline::polygon(&[[0.0, -height * 2.0 / 3.0], [half, height / 3.0], [-half, height / 3.0]])]
            }
            Self::Cross => {
                let b = BAR / 2.0;
                let quarter = [[half, -b], [half, b], [b, b]];
                let turned = |[u, v]: [f64; 2], turns: usize| [[u, v], [-v, u], [-u, -v], [v, -u]][turns];
                let vertices: Vec<[f64; 2]> = (0..4).flat_map(|turns| quarter.map(|vertex| turned(vertex, turns))).collect();
                vec![Outline::polygon(&vertices)]
            }
            Self::Corner => vec![Outline::rectangle([0.0, 0.0], [1.0, 1.0])],
            Self::ChessCorner => vec![Outline::rectangle([0.0, 0.0], [1.0, 1.0]), Outline::rectangle([-1.0, -1.0], [0.0, 0.0])],
            Self::Junction => Vec::new(),
        }
    }
}

/// The width of a cross's bars, as a fraction of their length.
pub const BAR: f64 = 1.0 / 3.0;

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
    /// dx/du, px per size of the target.
    pub axx: f64,
    /// dx/dv, px per size of the target.
    pub axy: f64,
    /// dy/du, px per size of the target.
    pub ayx: f64,
    /// dy/dv, px per size of the target.
    pub ayy: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Area and centroid by Green's theorem, the curves cut into short chords.
    fn area_and_centroid(kind: TargetKind) -> (f64, [f64; 2]) {
        let (mut area, mut moment) = (0.0, [0.0; 2]);
        for curve in kind.outlines().iter().flat_map(|outline| &outline.0) {
            for step in 0..1000 {
                let [a, b] = [step, step + 1].map(|i| curve.at(f64::from(i) / 1000.0));
                let cross = a[0] * b[1] - b[0] * a[1];
                area += cross / 2.0;
                moment = [0, 1].map(|i| moment[i] + cross * (a[i] + b[i]) / 6.0);
            }
        }
        (area, moment.map(|m| m / area))
    }

    #[test]
    fn outlines_have_their_area_and_reference_point() {
        use TargetKind::{ChessCorner, Corner, Cross, Disc, Square, Triangle};
        let bars = 2.0 * BAR - BAR * BAR;
        let centred =
            [(Disc, std::f64::consts::PI / 4.0), (Square, 1.0), (Triangle, 3_f64.sqrt() / 4.0), (Cross, bars), (ChessCorner, 2.0)];
        for (kind, area) in centred {
            let (found, [u, v]) = area_and_centroid(kind);
            // Chords of a circle: (2 pi / 4000)^2 / 6.
            assert!((found - area).abs() < 1e-6 && u.abs() < 1e-12 && v.abs() < 1e-12, "{kind}: {found} {u} {v}");
        }
        let (area, [u, v]) = area_and_centroid(Corner);
        // Four thousand chords are added up.
        assert!([area - 1.0, u - 0.5, v - 0.5].iter().all(|off| off.abs() < 1e-12), "{area} {u} {v}");
        assert!(TargetKind::Junction.outlines().is_empty());
    }

    #[test]
    fn names_go_both_ways() {
        for kind in TargetKind::ALL {
            assert_eq!(kind.name().parse(), Ok(kind));
        }
        assert!("chess".parse::<TargetKind>().unwrap_err().to_string().contains("chess_corner"));
    }
}
