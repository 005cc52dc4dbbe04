//! Why an image does not show the field.

use thiserror::Error;

/// Why an image does not show the field, or not enough of it.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum NotRecognised {
    /// An image of no use for its size.
    #[error("the image has {width} x {height} px: expected at least {least} px a side")]
    TooSmall {
        /// Columns, px.
        width: usize,
        /// Rows, px.
        height: usize,
        /// The least of both, px.
        least: usize,
    },
    /// Grey values that are not numbers.
    #[error("the image has grey values that are no numbers")]
    NotFinite,
    /// One grey value, but for noise.
    #[error("the image shows nothing but noise")]
    Blank,
    /// Fewer straight dark lines than a square has.
    #[error("{found} straight dark lines found: expected at least two in each of two directions, the borders of a square")]
    TooFewLines {
        /// How many there are.
        found: usize,
    },
    /// Lines that are no perspective view of a grid.
    #[error("{found} straight lines found, and no two sets of them are a perspective view of a grid of equal squares")]
    NoGrid {
        /// How many there are.
        found: usize,
    },
    /// A grid of which no square is wholly in the image.
    #[error("a grid of lines found, and none of its squares lies wholly inside the image")]
    NoWholeSquare,
    /// A grid without the targets of a coded field.
    #[error("a grid of lines found, and in none of its {squares} whole squares are targets as of a coded field")]
    NoTargets {
        /// Whole squares.
        squares: usize,
    },
    /// The field's mirror image.
    #[error("the image is mirrored: its {squares} whole squares fit the mirror image of the field, not the field")]
    Mirrored {
        /// Whole squares that fit.
        squares: usize,
    },
    /// Coded squares that contradict the design.
    #[error(
        "another field: no place of the {squares} whole squares on the field's design explains them (the best explains {explained}); the \
         image is of a field made with another seed or other sizes, or too blurred or bent for its lines to be told from others"
    )]
    OtherField {
        /// Whole squares with targets.
        squares: usize,
        /// How many of them the best place explains.
        explained: usize,
    },
    /// Targets that are where the design has them, in other sizes.
    #[error(
        "another field: its targets have {times:.2} times the area of those of the field; the image is of a field made with other sizes"
    )]
    OtherSizes {
        /// By how much they are larger, in the median.
        times: f64,
    },
    /// More than one place on the design explains the squares.
    #[error("ambiguous: {places} places on the field's design explain the {squares} squares seen equally well")]
    Ambiguous {
        /// How many places.
        places: usize,
        /// Squares seen.
        squares: usize,
    },
}

impl NotRecognised {
    /// The reason's name in files.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::TooSmall { .. } => "too_small",
            Self::NotFinite => "not_finite",
            Self::Blank => "blank",
            Self::TooFewLines { .. } => "too_few_lines",
            Self::NoGrid { .. } => "no_grid",
            Self::NoWholeSquare => "no_whole_square",
            Self::NoTargets { .. } => "no_targets",
            Self::Mirrored { .. } => "mirrored",
            Self::OtherField { .. } => "other_field",
            Self::OtherSizes { .. } => "other_sizes",
            Self::Ambiguous { .. } => "ambiguous",
        }
    }

    /// How far the recognition came before it gave up: the farther, the more is said by the reason.
    pub(crate) const fn stage(&self) -> usize {
        match self {
            Self::TooSmall { .. } | Self::NotFinite => 0,
            Self::Blank => 1,
            Self::TooFewLines { .. } => 2,
            Self::NoGrid { .. } => 3,
            Self::NoWholeSquare => 4,
            Self::NoTargets { .. } => 5,
            Self::OtherField { .. } | Self::OtherSizes { .. } => 6,
            Self::Mirrored { .. } => 7,
            Self::Ambiguous { .. } => 8,
        }
    }
}
