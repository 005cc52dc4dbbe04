//! What is done about image points in gross error.

use calibench_adjust::{Snooping, Test, Variance};

/// What is done about image points in gross error.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum GrossErrors {
    /// They are looked for where the residuals of all points are not those of normal errors, and left out where they are errors of single points
    /// ([`calibrate`](crate::calibrate) does that; [`Prepared::adjust`](crate::Prepared::adjust) keeps all).
    #[default]
    Sought,
    /// Nothing: all points count alike.
    Kept,
    /// What a test rejects is left out, whatever it is.
    Rejected(Risk),
    /// They have less weight: Huber's bound, in standard deviations of an image point as the residuals show them.
    Weighted(f64),
}

/// What a test may reject of good image points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Risk {
    /// One coordinate of a thousand: Baarda's test, by the standard deviation that was stated if one was.
    EachPoint,
    /// One of a thousand sets loses any: by the standard deviation that the residuals show.
    WholeSet,
}

/// Probability of a good coordinate, or of a good set.
const ALPHA: f64 = 1e-3;

/// Huber's bound of start values where image points are left out later.
const START: f64 = 2.0;

impl GrossErrors {
    /// Bound of Huber's weights on the way to start values, in a-priori standard deviations: where gross errors are looked for they must not lead it astray.
    pub(crate) fn of_start(self) -> Option<f64> {
        match self {
            Self::Sought | Self::Kept => None,
            Self::Rejected(_) => Some(START),
            Self::Weighted(bound) => Some(bound),
        }
    }

    /// Huber's bound, where it was asked for.
    pub(crate) fn huber(self) -> Option<f64> {
        if let Self::Weighted(bound) = self { Some(bound) } else { None }
    }
}

impl Risk {
    /// The search in a network of so many image points, tests being `tested` by the settings.
    pub(crate) fn snooping(self, points: usize, tested: Variance) -> Snooping {
        match self {
            Self::EachPoint => Snooping { test: Test { alpha: ALPHA, variance: tested, ..Test::default() }, ..Snooping::default() },
            Self::WholeSet => {
                let alpha = ALPHA / (2 * points.max(1)) as f64;
                Snooping { test: Test { alpha, variance: Variance::Estimated, ..Test::default() }, most: points }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_set_is_tested_once_as_a_whole() {
        let each = Risk::EachPoint.snooping(500, Variance::Apriori);
        assert_eq!((each.test, each.most), (Test::default(), 100));
        let whole = Risk::WholeSet.snooping(500, Variance::Apriori);
        assert!((whole.test.alpha * 1000.0 / ALPHA - 1.0).abs() < 1e-12);
        assert_eq!((whole.test.variance, whole.most), (Variance::Estimated, 500));
    }
}
