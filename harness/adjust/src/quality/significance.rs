//! Which additional parameters are needed.

use statrs::distribution::{ContinuousCDF, FisherSnedecor, StudentsT};

use super::covariance::Covariances;
use crate::AdjustError;
use crate::solution::Solution;
use calibench_model::camera::CameraModel;

/// A parameter against the hypothesis that it is zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Significance {
    /// Index of the camera.
    pub camera: usize,
    /// Name of the parameter.
    pub parameter: &'static str,
    /// Its value, in its own unit.
    pub value: f64,
    /// Its standard deviation, in the same unit, as the covariances say.
    pub sigma: f64,
    /// `value / sigma`: Student's distribution with the redundancy's degrees of freedom, if it is zero in truth.
    pub t: f64,
    /// Probability of a value as large or larger in absolute value, if it is zero in truth.
    pub p: f64,
}

/// Two adjustments of the same observations, the second with more parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comparison {
    /// Parameters that the second has more.
    pub more: usize,
    /// `((W1 - W2) / more) / (W2 / r2)`, with the weighted sums of squares W: Fisher's distribution if the parameters are zero in truth.
    pub f: f64,
    /// Probability of an f as large or larger, if they are zero in truth. It is a test of nested sets only.
    pub p: f64,
    /// Akaike's criterion of the first, `n ln(W / n) + 2 u`: the variance factor is unknown.
    pub first_aic: f64,
    /// That of the second, a number: the smaller is the better.
    pub second_aic: f64,
}

impl Solution<'_> {
    /// A t-test of each unknown interior parameter against zero, by covariances with the estimated variance factor. It means something for additional
    /// parameters, not for c.
    ///
    /// # Errors
    /// [`AdjustError::NotAvailable`] without redundancy.
    pub fn significance(&self, covariances: &Covariances) -> Result<Vec<Significance>, AdjustError> {
        let student = StudentsT::new(0.0, 1.0, self.counts().redundancy() as f64);
        let student = student.map_err(|_| AdjustError::NotAvailable("without redundancy there is no test"))?;
        let of = |(k, &(camera, parameter)): (usize, &(usize, &'static str))| {
            let all = self.cameras()[camera].parameters();
            let value = all.iter().find(|found| found.name == parameter).map_or(0.0, |found| found.value);
            let sigma = covariances.interior[(k, k)].sqrt();
            let t = if sigma > 0.0 { value / sigma } else { 0.0 };
            Significance { camera, parameter, value, sigma, t, p: 2.0 * student.sf(t.abs()) }
        };
        Ok(covariances.parameters.iter().enumerate().map(of).collect())
    }
}

/// Test of whether the second solution, with more parameters, fits better than by chance.
///
/// # Errors
/// [`AdjustError::NotAvailable`] if both do not adjust the same observations, or the second has no more parameters or no redundancy.
pub fn compare(first: &Solution, second: &Solution) -> Result<Comparison, AdjustError> {
    let (a, b) = (first.counts(), second.counts());
    if a.observations() != b.observations() || b.unknowns <= a.unknowns || b.redundancy() <= 0 {
        return Err(AdjustError::NotAvailable(
            "only solutions of the same observations compare, the second with more parameters and redundancy",
        ));
    }
    let (more, redundancy, n) = (b.unknowns - a.unknowns, b.redundancy() as f64, a.observations() as f64);
    let f = ((first.cost() - second.cost()).max(0.0) / more as f64) / (second.cost() / redundancy).max(f64::MIN_POSITIVE);
    let fisher = FisherSnedecor::new(more as f64, redundancy).map_err(|_| AdjustError::NotAvailable("no test"))?;
    let aic = |cost: f64, unknowns: usize| n * (cost.max(f64::MIN_POSITIVE) / n).ln() + 2.0 * unknowns as f64;
    Ok(Comparison { more, f, p: fisher.sf(f), first_aic: aic(first.cost(), a.unknowns), second_aic: aic(second.cost(), b.unknowns) })
}
