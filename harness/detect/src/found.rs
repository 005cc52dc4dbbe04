//! What was found in an image.

use std::fmt;

use calibench_model::{Affine, PixelPoint};

/// What was found of a board.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// Its points that are seen, in the order of the layout, each once.
    pub points: Vec<FoundPoint>,
    /// Markers or codes that were read and stand where the board has them; circles of a grid without codes.
    pub markers: usize,
    /// What was left out because it is in doubt.
    pub doubts: Vec<Doubt>,
    /// Whether it is a grid of circles that are lighter than what is around them.
    pub light: bool,
}

/// A point that is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FoundPoint {
    /// An index into [`calibench_model::boards::Layout::points`].
    pub index: usize,
    /// Where, to about a pixel.
    pub position: PixelPoint,
    /// The map from the target's own axes (unit its size, v down) to the image, px, to some per cent.
    pub affine: Affine,
}

/// What was seen and left out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Doubt {
    /// A mark that the board has, seen more than once: none of them is used.
    Twice {
        /// Its id.
        id: u32,
    },
    /// A mark that the board has, where the others say that it cannot be.
    Stray {
        /// Its id.
        id: u32,
    },
    /// A marker of the dictionary that the board does not have.
    Foreign {
        /// Its id.
        id: u32,
    },
    /// Corners of a board that are seen in two places: none of them is used.
    TwiceCorners {
        /// The first of them by name.
        first: String,
        /// How many.
        corners: usize,
    },
    /// Corners of a PuzzleBoard between dots most of which its pattern does not have there: left out.
    Dots {
        /// How many.
        corners: usize,
    },
    /// Corners of a chessboard or circles of a grid that are not seen where the others have them: left out.
    Unseen {
        /// How many.
        corners: usize,
    },
    /// Corners or circles of the pattern beyond those that the board has: left out.
    Beyond {
        /// How many.
        corners: usize,
    },
    /// Several such boards; these points are of one of them.
    Several {
        /// How many points of each are seen, from the left.
        points: Vec<usize>,
    },
    /// Circles unlike the others of a grid that is said to have none.
    Unlike {
        /// The first of them by name.
        first: String,
        /// How many.
        circles: usize,
        /// The board with circles as they are seen, in words.
        instead: Option<String>,
    },
}

impl Doubt {
    /// The doubt's name in files.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Twice { .. } | Self::TwiceCorners { .. } => "twice",
            Self::Stray { .. } | Self::Dots { .. } => "stray",
            Self::Foreign { .. } | Self::Beyond { .. } => "foreign",
            Self::Unseen { .. } => "unseen",
            Self::Several { .. } => "several",
            Self::Unlike { .. } => "unlike",
        }
    }
}

impl fmt::Display for Doubt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Twice { id } => write!(f, "mark {id} is seen more than once"),
            Self::Stray { id } => write!(f, "mark {id} is seen where the other marks say it cannot be"),
            Self::Foreign { id } => write!(f, "mark {id} is none of the board's"),
            Self::TwiceCorners { first, corners } => write!(f, "corners are seen more than once, {corners} in all, the first {first}"),
            Self::Dots { corners } => write!(f, "dots around corners are not the pattern's, {corners} corners left out"),
            Self::Unseen { corners } => write!(f, "points are not seen where the others have them, {corners} left out"),
            Self::Beyond { corners } => write!(f, "the pattern goes on beyond the board, {corners} points left out"),
            Self::Several { points } => {
                let counts = points.iter().map(usize::to_string).collect::<Vec<_>>().join(", ");
                write!(f, "{} boards of this kind are seen, from the left with {counts} points", points.len())
            }
            Self::Unlike { first, circles, instead } => {
                write!(
                    f,
                    "circles are unlike the others, {circles} in all, the first {first}: as the board is described nothing tells which end is which"
                )?;
                instead.as_ref().map_or(Ok(()), |board| write!(f, "; counted as here it is {board}"))
            }
        }
    }
}
