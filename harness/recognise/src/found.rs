//! What was found in an image.

use std::fmt;

use calibench_model::{Affine, PixelPoint, TargetKind};

/// What was found in an image of the field.
#[derive(Clone, Debug, PartialEq)]
pub struct Recognition {
    /// The targets that were recognised, of those that the testfield lists: in its order, each once at most.
    pub targets: Vec<Recognised>,
    /// Every whole square of the grid in the image, row by row as seen.
    pub squares: Vec<SquareFound>,
    /// The lines of the grid.
    pub lines: Vec<LineFound>,
    /// What was not recognised of the whole squares, and why.
    pub rejected: Vec<Rejected>,
    /// How the grid lies in the image.
    pub grid: GridFound,
}

/// A recognised target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Recognised {
    /// An index into [`calibench_model::Testfield::targets`].
    pub target: usize,
    /// Its centre of gravity in the binary enlarged normal image, brought back to the image.
    pub position: PixelPoint,
    /// The map from its own axes (unit its size, v down) to the image, from the grid and the design's turn, px.
    pub affine: Affine,
    /// Its kind.
    pub kind: TargetKind,
    /// How well it looks like the design says: the correlation of the grey values of its cell with its drawing, -1 to 1.
    pub likeness: f64,
}

/// A size group: a rank of sizes within a square, four targets each.
///
/// Source: Vosselman & Förstner 1988, table 3.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum SizeGroup {
    /// Two small squares and two small triangles.
    SmallAngular,
    /// Two small crosses and two small discs.
    SmallRound,
    /// Two large squares and two large triangles.
    LargeAngular,
    /// Two large crosses and two large discs.
    LargeRound,
}

impl SizeGroup {
    /// All four, the smallest first.
    pub const ALL: [Self; 4] = [Self::SmallAngular, Self::SmallRound, Self::LargeAngular, Self::LargeRound];

    /// The two kinds in it, in the order of the codes.
    pub const fn kinds(self) -> [TargetKind; 2] {
        match self {
            Self::SmallAngular | Self::LargeAngular => [TargetKind::Square, TargetKind::Triangle],
            Self::SmallRound | Self::LargeRound => [TargetKind::Cross, TargetKind::Disc],
        }
    }

    /// The name in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::SmallAngular => "small squares and triangles",
            Self::SmallRound => "small crosses and discs",
            Self::LargeAngular => "large squares and triangles",
            Self::LargeRound => "large crosses and discs",
        }
    }
}

/// A whole square in the image.
#[derive(Clone, Debug, PartialEq)]
pub struct SquareFound {
    /// Its row from the top and column from the left on the field, counted from 0; `None` if it was not identified.
    pub place: Option<[usize; 2]>,
    /// Its corners in the image, where the middles of its lines meet, in the order of the field's as seen: top left, top right, bottom right, bottom left.
    pub corners: [PixelPoint; 4],
    /// Its code as the classifier alone reads it, of its large pairs; `None` if it does not hold sixteen targets.
    pub code: Option<u8>,
    /// What lies in it.
    pub blobs: Vec<Blob>,
}

/// Something dark in a whole square.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blob {
    /// Its centre of gravity.
    pub position: PixelPoint,
    /// Its area, as a fraction of the square's.
    pub area: f64,
    /// Its size group, by rank; `None` unless there are sixteen in the square.
    pub group: Option<SizeGroup>,
    /// What the classifier alone takes it for, of the two kinds of its group.
    pub single: Option<TargetKind>,
    /// What it is taken for together with the other three of its group, of which two are of either kind: the best of six.
    pub joint: Option<TargetKind>,
    /// Along how many pixels of its contour it has a blunt, a right, a sharp and a concave angle; `None` unless there are sixteen in the square.
    pub features: Option<[usize; 4]>,
    /// The target whose place on the design it has: an index into [`calibench_model::Testfield::targets`]; `None` without one, or one that is not listed.
    pub target: Option<usize>,
}

/// A line of the grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineFound {
    /// 0 for the lines between the field's columns, 1 for those between its rows.
    pub family: usize,
    /// Which of its family, counted from 0 at the field's left or top border.
    pub index: i64,
    /// Where its found part begins and ends.
    pub ends: [PixelPoint; 2],
    /// The standard deviation of its position across, at its middle, px.
    pub sigma: f64,
    /// The root mean square distance of its points from it, px.
    pub rms: f64,
    /// How many points it was adjusted to.
    pub points: usize,
}

/// How the grid lies in the image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GridFound {
    /// From the field's (column, row), in squares from its top left corner, to places q (px) of the image without its bend, row by row.
    pub homography: [[f64; 3]; 3],
    /// The bend of straight lines: q is seen at `m + (q - m) 2 / (1 + sqrt(1 - 4 bend s^2))`, with s = |q - m| / `reach` (division model).
    pub bend: f64,
    /// m: the middle of the image.
    pub middle: PixelPoint,
    /// Half the diagonal of the image, px.
    pub reach: f64,
    /// The root mean square distance of the lines' points from the grid, px.
    pub rms: f64,
    /// The blur of its lines: the standard deviation of a Gaussian that holds optics, photosites and interpolation, px.
    pub blur: f64,
    /// The image was looked at so many times smaller.
    pub reduced: usize,
}

impl GridFound {
    /// Where a place of the field, in squares from its top left corner (column, row), is seen, px; `None` beyond the horizon or the bend.
    pub fn image(&self, [x, y]: [f64; 2]) -> Option<PixelPoint> {
        let row = |h: [f64; 3]| h[0] * x + h[1] * y + h[2];
        let [a, b, depth] = self.homography.map(row);
        let (qx, qy) = (a / depth - self.middle.x, b / depth - self.middle.y);
        let root = 1.0 - 4.0 * self.bend * (qx * qx + qy * qy) / (self.reach * self.reach);
        let times = 2.0 / (1.0 + root.sqrt());
        (depth > 0.0 && root >= 0.0).then(|| PixelPoint::new(self.middle.x + times * qx, self.middle.y + times * qy))
    }

    /// Where a point of the image, px, would be without the bend; the inverse of the bend in [`Self::image`].
    pub fn straight(&self, at: PixelPoint) -> PixelPoint {
        let (x, y) = (at.x - self.middle.x, at.y - self.middle.y);
        let times = 1.0 / (1.0 + self.bend * (x * x + y * y) / (self.reach * self.reach));
        PixelPoint::new(self.middle.x + times * x, self.middle.y + times * y)
    }
}

/// Something in a whole square that was not recognised.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rejected {
    /// Where in the image: a target's place, or the middle of a square.
    pub at: PixelPoint,
    /// The square's row and column on the field, counted from 0, if it was identified.
    pub square: Option<[usize; 2]>,
    /// The target that should be there: an index into [`calibench_model::Testfield::targets`].
    pub target: Option<usize>,
    /// Why.
    pub reason: Reason,
}

/// Why something was not recognised.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reason {
    /// Nothing dark where the design has a target.
    Missing,
    /// Something where the design has a target, and it does not look like it.
    Unlike {
        /// The correlation with its drawing.
        likeness: f64,
    },
    /// The classifier took it for another kind than the design has there.
    OtherKind {
        /// For which.
        taken_for: TargetKind,
    },
    /// A whole square that does not hold sixteen targets.
    Count {
        /// How many it holds.
        found: usize,
    },
    /// A square that is not where the design has one of its kind.
    Contradicts,
    /// A square of the grid outside the field.
    Outside,
}

impl Reason {
    /// The name in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Missing => "missing",
            Self::Unlike { .. } => "unlike",
            Self::OtherKind { .. } => "other_kind",
            Self::Count { .. } => "count",
            Self::Contradicts => "contradicts",
            Self::Outside => "outside",
        }
    }
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing => f.write_str("nothing dark at the place of a target"),
            Self::Unlike { likeness } => write!(f, "not like the target of this place (correlation {likeness:.2})"),
            Self::OtherKind { taken_for } => write!(f, "taken for a {taken_for}, which is not what the design has there"),
            Self::Count { found } => write!(f, "a square with {found} dark areas: expected 16 targets"),
            Self::Contradicts => f.write_str("a square whose targets are not those of its place on the field"),
            Self::Outside => f.write_str("a square outside the field"),
        }
    }
}
