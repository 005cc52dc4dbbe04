//! What keeps a test by lengths from being whole, and what it takes for granted.

use std::fmt;

use calibench_diagnostics::plain;

/// Lines of at least [`LENGTHS_OF_LINE`] lengths.
pub const LINES: usize = 7;
/// Lengths of a line.
pub const LENGTHS_OF_LINE: usize = 5;
/// The longest length in diagonals of the volume, at least.
pub const OF_DIAGONAL: f64 = 2.0 / 3.0;

/// Why a test cannot be passed, whatever its errors.
#[derive(Clone, Debug, PartialEq)]
pub enum Unmet {
    /// So many lines have [`LENGTHS_OF_LINE`] lengths.
    Lines(usize),
    /// The longest tested length and the diagonal of the volume, in one unit.
    Longest {
        /// Of the lengths.
        longest: f64,
        /// Of the volume.
        diagonal: f64,
    },
    /// So many lengths were not measured.
    NotMeasured(usize),
}

impl Unmet {
    /// A word for programs.
    pub const fn subject(&self) -> &'static str {
        match self {
            Self::Lines(_) => "lines",
            Self::Longest { .. } => "longest",
            Self::NotMeasured(_) => "not-measured",
        }
    }
}

impl fmt::Display for Unmet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Lines(found) => {
                write!(f, "{found} measurement lines have {LENGTHS_OF_LINE} tested lengths; expected {LINES} such lines at least")
            }
            Self::Longest { longest, diagonal } => write!(
                f,
                "the longest tested length, {}, is {:.1} % of the volume's diagonal of {}; expected two thirds at least",
                plain(*longest),
                100.0 * longest / diagonal,
                plain(*diagonal)
            ),
            Self::NotMeasured(count) => {
                write!(f, "{count} lengths were not measured; measure them, or leave out what was never meant to be measured")
            }
        }
    }
}

/// What a test takes for granted, or leaves out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Assumed {
    /// So many calibrated lengths have no uncertainty.
    Exact(usize),
    /// Nobody said where the scale comes from.
    ScaleUntold,
    /// So many lengths gave the scale: they are no test of it.
    GaveScale(usize),
    /// Nobody said how large the volume is.
    VolumeUntold,
}

impl Assumed {
    /// A word for programs.
    pub const fn subject(&self) -> &'static str {
        match self {
            Self::Exact(_) => "exact",
            Self::ScaleUntold => "scale-untold",
            Self::GaveScale(_) => "gave-scale",
            Self::VolumeUntold => "volume-untold",
        }
    }
}

impl fmt::Display for Assumed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Exact(count) => write!(f, "{count} calibrated lengths have no uncertainty (sigma 0): taken as exact"),
            Self::ScaleUntold => f.write_str("where the scale comes from is not stated: taken as from none of these lengths"),
            Self::GaveScale(count) => write!(f, "{count} lengths gave the scale: left out of the test"),
            Self::VolumeUntold => f.write_str("the measuring volume is not stated: whether the longest length suits it is not tested"),
        }
    }
}
