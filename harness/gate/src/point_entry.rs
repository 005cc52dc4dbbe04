//! One point of a run as the gate compares it.

use std::fmt;
use std::sync::Arc;

use calibench_model::Rejection;
use calibench_records::results::{LOST, Outcome, PointResult};

/// Decimals of a coordinate, px: what a baseline file keeps, and what a table is rounded to, so that both compare alike.
pub const DECIMALS: usize = 9;

/// Decimals of a standard deviation, px, for the same reason.
pub const SIGMA_DECIMALS: usize = 7;

/// What the two coordinates of a measured point are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coordinates {
    /// Measured less true position (dx, dy), px.
    Errors,
    /// The measured position (x, y), px, of which no truth is known.
    Positions,
}

impl Coordinates {
    /// What a run yields: errors where the truth is known, positions elsewhere.
    pub const fn of(truth_is_known: bool) -> Self {
        if truth_is_known { Self::Errors } else { Self::Positions }
    }

    /// The names of the columns.
    pub const fn names(self) -> [&'static str; 2] {
        match self {
            Self::Errors => ["dx", "dy"],
            Self::Positions => ["x", "y"],
        }
    }

    /// The name in the head of a baseline.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Errors => "errors",
            Self::Positions => "positions",
        }
    }
}

/// Which point of a run.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Place {
    /// The trial, from 0.
    pub trial: u64,
    /// The image.
    pub view: Arc<str>,
    /// The target.
    pub target: Arc<str>,
}

/// `view/target`, with the trial before it unless that is the first.
impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.trial > 0 {
            write!(f, "trial {} ", self.trial)?;
        }
        write!(f, "{}/{}", self.view, self.target)
    }
}

/// What was measured of a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    /// Its coordinates, px, as the table's [`Coordinates`] say; of an adjustment's check points RMSE_XY and RMSE_Z, mm.
    pub at: [f64; 2],
    /// The standard deviation that the method itself reports, px: the square root of the trace of its covariance.
    pub sigma: Option<f64>,
}

impl Found {
    /// Coordinates, as in [`Self::at`], without a standard deviation.
    pub const fn bare(at: [f64; 2]) -> Self {
        Self { at, sigma: None }
    }

    /// Whether a coordinate is not a number.
    pub const fn is_nan(&self) -> bool {
        self.at[0].is_nan() || self.at[1].is_nan()
    }
}

/// Whether a point was measured, and where.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Entry {
    /// Measured.
    Measured(Found),
    /// Measured, and more than [`LOST`] px from the truth, or not a number.
    Lost(Found),
    /// Rejected by the operator.
    Rejected(Rejection),
}

impl Entry {
    /// The entry of a point whose coordinates are read as `coordinates`.
    pub fn of(point: &PointResult, coordinates: Coordinates) -> Self {
        let sigma = point.predicted.map(|sigma| decimals(sigma, SIGMA_DECIMALS));
        let found = |x, y| Found { at: [rounded(x), rounded(y)], sigma };
        match (point.outcome, coordinates) {
            (Outcome::Rejected(why), _) => Self::Rejected(why),
            (Outcome::Measured { position, .. }, Coordinates::Positions) => {
                let found = found(position.x, position.y);
                if found.is_nan() { Self::Lost(found) } else { Self::Measured(found) }
            }
            (Outcome::Measured { error, .. }, Coordinates::Errors) => {
                let (dx, dy) = error.unwrap_or((f64::NAN, f64::NAN));
                if dx.hypot(dy) <= LOST { Self::Measured(found(dx, dy)) } else { Self::Lost(found(dx, dy)) }
            }
        }
    }

    /// The word in files.
    pub const fn status(&self) -> &'static str {
        match self {
            Self::Measured(_) => "measured",
            Self::Lost(_) => "lost",
            Self::Rejected(_) => "rejected",
        }
    }

    /// Status and reason in words.
    pub fn describe(&self) -> String {
        match self {
            Self::Rejected(why) => format!("rejected ({why})"),
            _ if self.is_nan() => "not a number".to_owned(),
            _ => self.status().to_owned(),
        }
    }

    /// What was measured, lost or not.
    pub const fn found(&self) -> Option<&Found> {
        match self {
            Self::Measured(found) | Self::Lost(found) => Some(found),
            Self::Rejected(_) => None,
        }
    }

    /// The coordinates, as in [`Found::at`], lost or not.
    pub fn coordinates(&self) -> Option<[f64; 2]> {
        self.found().map(|found| found.at)
    }

    /// The coordinates, as in [`Found::at`], of a point that was measured and not lost.
    pub const fn kept(&self) -> Option<[f64; 2]> {
        match self {
            Self::Measured(found) => Some(found.at),
            _ => None,
        }
    }

    /// Whether it was measured and not lost.
    pub const fn is_kept(&self) -> bool {
        matches!(self, Self::Measured(_))
    }

    /// Whether a coordinate is not a number.
    pub fn is_nan(&self) -> bool {
        self.found().is_some_and(Found::is_nan)
    }
}

/// The value that the file's decimals hold, without a negative zero.
pub(super) fn rounded(value: f64) -> f64 {
    decimals(value, DECIMALS)
}

fn decimals(value: f64, count: usize) -> f64 {
    format!("{value:.count$}").parse::<f64>().unwrap_or(f64::NAN) + 0.0
}
