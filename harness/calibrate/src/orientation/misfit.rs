//! Points of an image that do not fit its pose.

use calibench_adjust::approximate::{Control, Resection, Search, Tolerance, resect};
use calibench_model::camera::Camera;
use statrs::distribution::{ContinuousCDF, FisherSnedecor};
use statrs::function::factorial::ln_binomial;

use super::precision::Residuals;

/// Probability below which it is no chance that points do not fit.
pub(super) const ALPHA: f64 = 1e-4;
/// A standard deviation of image coordinates below which residuals are rounding, px.
pub(super) const ROUNDING: f64 = 1e-5;

/// Points without which the others fit better than chance makes them.
#[derive(Clone, Debug, PartialEq)]
pub struct Misfit {
    /// Indices of their targets, the worst first.
    pub targets: Vec<usize>,
    /// How far the worst is off, px; `None` where the camera does not picture it.
    pub worst: Option<f64>,
}

impl Misfit {
    /// Those points of `control`, of these targets, that a search against gross errors leaves out, where that lowers the sum of squares of `all`, the pose
    /// of all of them, by more than chance does, whichever of all choices it took (an F test with Bonferroni's bound over them).
    pub(super) fn of(camera: &Camera, control: &[Control], targets: &[usize], all: &Resection) -> Option<Self> {
        if all.sigma0 < ROUNDING {
            return None;
        }
        let rest = resect(camera, control, Some(&Search { seed: 1, tolerance: Tolerance::Unknown })).ok()?;
        if rest.rejected.is_empty() || ln_chance(control.len(), residuals(all), residuals(&rest)) >= ALPHA.ln() {
            return None;
        }
        let off = |place: usize| rest.residuals[place].map_or(f64::INFINITY, |[x, y]| x.hypot(y));
        let mut places = rest.rejected.clone();
        places.sort_by(|&a, &b| off(b).total_cmp(&off(a)));
        let worst = places.first().map(|&place| off(place)).filter(|off| off.is_finite());
        Some(Self { targets: places.into_iter().map(|place| targets[place]).collect(), worst })
    }
}

fn residuals(of: &Resection) -> Residuals {
    Residuals::new(of.sigma0, of.redundancy as f64)
}

/// The logarithm of the most that the probability can be of residuals as small as those of the `rest`, if all of `count` points were right: of any choice of as
/// many points, for any number of them.
fn ln_chance(count: usize, all: Residuals, rest: Residuals) -> f64 {
    let freedom = all.redundancy - rest.redundancy;
    let Ok(fisher) = FisherSnedecor::new(freedom, rest.redundancy) else { return 0.0 };
    let gain = (all.squares - rest.squares).max(0.0) / freedom;
    let variance = (rest.squares / rest.redundancy).max(f64::MIN_POSITIVE);
    let choices = ln_binomial(count as u64, (0.5 * freedom) as u64) + (count as f64).ln();
    fisher.sf(gain / variance).ln() + choices
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of Fisher's distribution with two and m degrees of freedom a value x is exceeded with the probability `(1 + 2 x / m)^(-m / 2)`.
    #[test]
    fn one_point_of_ten_is_held_against_any_of_them_and_any_number() {
        let rest = Residuals { squares: 3.0, redundancy: 12.0 };
        for gain in [0.5, 4.0, 40.0] {
            let all = Residuals { squares: 3.0 + gain, redundancy: 14.0 };
            let expected = -6.0 * (gain / 3.0).ln_1p() + 2.0 * 10_f64.ln();
            assert!((ln_chance(10, all, rest) - expected).abs() < 1e-9, "{gain}");
        }
        let none = Residuals { squares: 0.0, redundancy: 0.0 };
        assert_eq!(ln_chance(4, Residuals { squares: 1.0, redundancy: 2.0 }, none), 0.0);
    }
}
