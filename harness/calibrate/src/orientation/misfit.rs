//! Points of an image that do not fit its pose.

use calibench_adjust::approximate::{Control, Resection, Search, Tolerance, fit_pose, resect};
use calibench_model::Pose;
use calibench_model::camera::{Camera, CameraModel};
use statrs::distribution::{ContinuousCDF, FisherSnedecor};
use statrs::function::factorial::ln_binomial;

use super::precision::Residuals;
use crate::doubt::ALPHA;
use crate::start::spread;

/// A standard deviation of image coordinates below which residuals are rounding, px.
pub(super) const ROUNDING: f64 = 1e-5;
/// Points among which a search against gross errors is made.
const SEARCHED: usize = 300;
/// Times that all points are asked which fit.
const ROUNDS: usize = 20;

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
        let rest = Rest::of(camera, control)?;
        if rest.left_out.is_empty() || ln_chance(control.len(), residuals(all), rest.residuals) >= ALPHA.ln() {
            return None;
        }
        let mut places = rest.left_out;
        places.sort_by(|&a, &b| rest.off[b].total_cmp(&rest.off[a]));
        let worst = places.first().map(|&place| rest.off[place]).filter(|off| off.is_finite());
        Some(Self { targets: places.into_iter().map(|place| targets[place]).collect(), worst })
    }
}

/// What is left by a pose that few points do not turn aside.
struct Rest {
    /// How far each point is off, px.
    off: Vec<f64>,
    /// Places of those that are too far off, in their order.
    left_out: Vec<usize>,
    /// Of the others.
    residuals: Residuals,
}

impl Rest {
    /// The search is among some of many points; which fit is asked of all of them, until these stay the same.
    fn of(camera: &Camera, control: &[Control]) -> Option<Self> {
        let some: Vec<Control> = if control.len() <= SEARCHED {
            control.to_vec()
        } else {
            spread(control.len(), SEARCHED).map(|place| control[place]).collect()
        };
        let found = resect(camera, &some, Some(&Search { seed: 1, tolerance: Tolerance::Unknown })).ok()?;
        let (mut pose, mut before) = (found.pose, Vec::new());
        if some.len() == control.len() {
            return Some(Self { off: off(camera, &pose, control), left_out: found.rejected.clone(), residuals: residuals(&found) });
        }
        for _ in 0..ROUNDS {
            let off = off(camera, &pose, control);
            let limit = limit(&off);
            let (kept, left_out): (Vec<usize>, Vec<usize>) = (0..control.len()).partition(|&place| off[place] <= limit);
            let fitted = fit_pose(camera, &pose, &kept.iter().map(|&place| control[place]).collect::<Vec<_>>()).ok()?;
            if left_out == before {
                return Some(Self {
                    off,
                    left_out,
                    residuals: Residuals { squares: fitted.squares, redundancy: fitted.redundancy as f64 },
                });
            }
            (pose, before) = (fitted.pose, left_out);
        }
        None
    }
}

/// How far points are off, px; what the camera does not picture is infinitely far.
fn off(camera: &Camera, pose: &Pose, control: &[Control]) -> Vec<f64> {
    let of = |point: &Control| {
        camera.project(pose.ray(&point.object)).map_or(f64::INFINITY, |at| (at.x - point.image.x).hypot(at.y - point.image.y))
    };
    control.iter().map(of).collect()
}

/// The length that one right residual in a thousand exceeds, from the median, whose square is 1.386 times the variance of a coordinate.
fn limit(off: &[f64]) -> f64 {
    let mut sorted = off.to_vec();
    let middle = sorted.len() / 2;
    *sorted.select_nth_unstable_by(middle, f64::total_cmp).1 * (13.82_f64 / 1.386).sqrt()
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
