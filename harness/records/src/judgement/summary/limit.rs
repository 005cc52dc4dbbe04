//! How far a camera may be wrong over the whole frame.

use statrs::distribution::{ChiSquared, ContinuousCDF};

/// The chance (0 to 1) that a camera is within its limit.
const SURE: f64 = 0.95;

/// What is predicted of a camera's error over the whole frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Predicted {
    /// Standard deviation (2D), RMS over the frame, px, from the residuals of all photographs.
    pub formal: f64,
    /// The same from leaving photographs out, px, whether or not errors within a photograph depend on each other. `None` where that failed.
    pub by_views: Option<f64>,
    /// In how many modes of equal weight the camera is uncertain, a number.
    pub modes: f64,
}

impl Predicted {
    /// The larger of the two standard deviations, px.
    pub fn px(&self) -> f64 {
        self.by_views.map_or(self.formal, |own| own.max(self.formal))
    }

    /// The RMS over the frame below which the camera's error is in 95 of 100 cases, px: the quantile of chi-square with as many degrees of freedom as there are
    /// modes, of the formal variance and of the squared `doubt` (px) for want of knowing the right model.
    ///
    /// Source: the distribution of a sum of squares by its first two moments (Satterthwaite 1946).
    pub fn limit(&self, doubt: f64) -> Option<f64> {
        self.within(SURE, doubt)
    }

    /// The same for another chance than 95 of 100, 0 to 1.
    pub(super) fn within(&self, chance: f64, doubt: f64) -> Option<f64> {
        let chi = ChiSquared::new(self.modes).ok()?;
        Some((self.formal.powi(2) + doubt.powi(2)).sqrt() * (chi.inverse_cdf(chance) / self.modes).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_limit_is_the_quantile_of_a_root_of_squares() {
        let limit = |modes: f64, loss: f64| Predicted { formal: 0.3, by_views: None, modes }.limit(loss).unwrap();
        // One mode: 1.96 standard deviations. Two: exponential, sqrt(-ln 0.05).
        assert!((limit(1.0, 0.0) - 0.3 * 1.959_964).abs() < 1e-5);
        assert!((limit(2.0, 0.0) - 0.3 * (-0.05_f64.ln()).sqrt()).abs() < 1e-9);
        assert!((limit(2.0, 0.4) - 0.5 * (-0.05_f64.ln()).sqrt()).abs() < 1e-9);
    }
}
