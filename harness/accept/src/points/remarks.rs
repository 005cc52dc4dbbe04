//! What keeps a test by check points from being whole, and what it takes for granted.

use std::fmt;

use calibench_diagnostics::plain;

/// Check points, at least.
pub const POINTS: usize = 30;
/// Of the class, beyond which a mean error asks for its cause.
pub const OF_CLASS: f64 = 0.25;

/// So many check points were measured: too few, whatever their errors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TooFew(pub usize);

impl fmt::Display for TooFew {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} check points were measured; expected {POINTS} at least", self.0)
    }
}

/// What is to be known beside the decision.
#[derive(Clone, Debug, PartialEq)]
pub enum Remark {
    /// Of so many check points the survey's error is not stated.
    SurveyUntold(usize),
    /// So many check points were not measured.
    NotMeasured(usize),
    /// The mean error of an axis, and the class, in one unit.
    Bias {
        /// X, Y or Z.
        axis: &'static str,
        /// Its mean error.
        mean: f64,
        /// Of the class.
        class: f64,
    },
    /// The 95 % interval of this accuracy holds its class: other points could decide otherwise.
    Close(&'static str),
}

impl Remark {
    /// A word for programs.
    pub const fn subject(&self) -> &'static str {
        match self {
            Self::SurveyUntold(_) => "survey-untold",
            Self::NotMeasured(_) => "not-measured",
            Self::Bias { .. } => "bias",
            Self::Close(_) => "close",
        }
    }
}

impl fmt::Display for Remark {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::SurveyUntold(count) => write!(f, "the survey's error of {count} check points is not stated: taken as exact"),
            Self::NotMeasured(count) => write!(f, "{count} check points were not measured: left out of the test"),
            Self::Bias { axis, mean, class } => {
                let (mean, share) = (plain(*mean), 100.0 * mean.abs() / class);
                write!(f, "the mean error of {axis}, {mean}, is {share:.0} % of the class; beyond 25 % its cause is to be sought")
            }
            Self::Close(what) => write!(f, "the 95 % interval of the {what} accuracy holds its class: other points could decide otherwise"),
        }
    }
}
