//! Residuals beside a standard deviation of image coordinates.

use statrs::distribution::{ChiSquared, ContinuousCDF};

/// Probability below which residuals do not fit.
pub(super) const MISFIT: f64 = 1e-3;

/// What is stated of image coordinates beforehand.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StatedPrecision {
    /// The residual beyond which a point is left out, px; `None`: all are kept.
    pub tolerance_px: Option<f64>,
    /// The standard deviation of an image coordinate, px; `None` where it is not known.
    pub sigma_px: Option<f64>,
}

/// What residuals say of an image coordinate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Residuals {
    /// Sum of squares, px^2.
    pub(super) squares: f64,
    pub(super) redundancy: f64,
}

impl Residuals {
    pub(super) fn new(sigma0: f64, redundancy: f64) -> Self {
        Self { squares: sigma0 * sigma0 * redundancy, redundancy }
    }

    /// Of several together.
    pub(super) fn pooled(each: impl Iterator<Item = Self>) -> Self {
        each.fold(Self::default(), |sum, one| Self { squares: sum.squares + one.squares, redundancy: sum.redundancy + one.redundancy })
    }

    /// The standard deviation, px; `None` without redundancy.
    pub(super) fn sigma0(self) -> Option<f64> {
        (self.redundancy > 0.0).then(|| (self.squares / self.redundancy).sqrt())
    }

    /// Whether they say what `sigma_px` does: chi squared, both sides, at a thousandth.
    pub(super) fn agree_with(self, sigma_px: f64) -> bool {
        let Ok(chi) = ChiSquared::new(self.redundancy) else { return true };
        let p = chi.cdf(self.squares / (sigma_px * sigma_px));
        (0.5 * MISFIT..=1.0 - 0.5 * MISFIT).contains(&p)
    }

    /// Whether they are larger than `sigma_px` lets expect with the probability `alpha`: chi squared.
    pub(super) fn exceed(self, sigma_px: f64, alpha: f64) -> bool {
        // Chi squared below its mean is never that rare: most of a million targets need no distribution.
        let is_larger = sigma_px > 0.0 && self.sigma0().is_some_and(|sigma0| sigma0 > sigma_px);
        is_larger && ChiSquared::new(self.redundancy).is_ok_and(|chi| chi.sf(self.squares / (sigma_px * sigma_px)) < alpha)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 5 %, 1 % and 0.1 % of chi squared of ten are 18.307, 23.209 and 29.588; 0.05 % on either side lie beyond 1.265 and 31.420 (tables).
    #[test]
    fn limits_are_those_of_the_tables() {
        let of = |squares: f64| Residuals { squares: 4.0 * squares, redundancy: 10.0 };
        for (alpha, limit) in [(0.05, 18.307), (0.01, 23.209), (0.001, 29.588)] {
            assert!(of(limit + 1e-3).exceed(2.0, alpha) && !of(limit - 1e-3).exceed(2.0, alpha), "{alpha}");
        }
        for (low, high) in [(1.266, 31.419), (1.264, 31.419), (1.266, 31.421)] {
            assert_eq!([low, high].map(|squares| of(squares).agree_with(2.0)), [low > 1.265, high < 31.42]);
        }
        assert!(Residuals::default().agree_with(1.0) && !Residuals::default().exceed(1e-9, 0.1));
        assert_eq!(Residuals::pooled([of(1.0), of(4.0)].into_iter()).sigma0(), Some(1.0));
    }
}
