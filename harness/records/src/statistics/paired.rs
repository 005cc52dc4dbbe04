//! The tests behind the gate, all of them on paired differences.

use statrs::distribution::{Binomial, ContinuousCDF, DiscreteCDF, StudentsT};

/// The p-values of one comparison, 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PValues {
    /// Of a change in either direction.
    pub two_sided: f64,
    /// Of growth.
    pub growth: f64,
    /// Of a fall.
    pub fall: f64,
}

impl PValues {
    /// Nothing changed.
    pub const NONE: Self = Self { two_sided: 1.0, growth: 1.0, fall: 1.0 };

    fn from_growth(growth: f64, fall: f64) -> Self {
        Self { two_sided: (2.0 * growth.min(fall)).min(1.0), growth, fall }
    }
}

/// Student's t-test of the mean of `differences`, of any one unit, against zero.
///
/// Differences that are all alike and not zero are significant with p = 0. Fewer than two say nothing.
///
/// Under the null hypothesis a difference of two like runs is symmetric about zero, whatever the errors themselves are like;
/// heavy tails then make the test conservative, not prone to false alarms.
#[expect(clippy::missing_panics_doc, reason = "there is at least one degree of freedom")]
pub fn paired_t(differences: &[f64]) -> PValues {
    let n = differences.len() as f64;
    if n < 2.0 {
        return PValues::NONE;
    }
    let mean = mean(differences);
    let variance = differences.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / (n - 1.0);
    if mean == 0.0 {
        return PValues::NONE;
    }
    let t = mean / (variance / n).sqrt();
    if t.is_infinite() {
        let growth = if mean > 0.0 { 0.0 } else { 1.0 };
        return PValues::from_growth(growth, 1.0 - growth);
    }
    let student = StudentsT::new(0.0, 1.0, n - 1.0).expect("at least one degree of freedom");
    // The upper tail of |t|: no cancellation where it matters.
    let (tail, rest) = (student.sf(t.abs()), student.cdf(t.abs()));
    if mean > 0.0 { PValues::from_growth(tail, rest) } else { PValues::from_growth(rest, tail) }
}

/// The exact sign test on the trials whose count changed: `grew` of them up, `fell` of them down.
///
/// Source: the binomial distribution with probability 1/2; trials without a change say nothing (Dixon & Mood 1946).
#[expect(clippy::missing_panics_doc, reason = "one half is a probability")]
pub fn sign_test(grew: u64, fell: u64) -> PValues {
    let changed = grew + fell;
    if changed == 0 {
        return PValues::NONE;
    }
    let binomial = Binomial::new(0.5, changed).expect("a probability of one half");
    let at_least = |count: u64| if count == 0 { 1.0 } else { binomial.sf(count - 1) };
    PValues::from_growth(at_least(grew), at_least(fell))
}

/// The mean of at least one value, in the unit of the values.
pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(found: f64, expected: f64) {
        assert!((found / expected - 1.0).abs() < 1e-3, "{found} is not {expected}");
    }

    /// Student 1908, The probable error of a mean, Biometrika 6: additional hours of sleep by two drugs, t = 4.0621 on 9 degrees
    /// of freedom, two-sided p = 0.00283.
    #[test]
    fn the_sleep_data_of_student() {
        let p = paired_t(&[1.2, 2.4, 1.3, 1.3, 0.0, 1.0, 1.8, 0.8, 4.6, 1.4]);
        close(p.two_sided, 0.002_833);
        close(p.growth, 0.001_416);
        close(p.fall, 1.0 - 0.001_416);
    }

    #[test]
    fn the_far_tail_is_not_rounded_to_zero() {
        // With 3 degrees of freedom the tail has a closed form: 1/2 - (a/(1 + a^2) + atan a)/pi with a = t/sqrt(3).
        let p = paired_t(&[1.0, 1.001, 0.999, 1.0]);
        let a: f64 = 1.0 / (2e-6_f64 / 3.0 / 4.0).sqrt() / 3.0_f64.sqrt();
        // For large a: 2/(3 pi a^3).
        close(p.growth, 2.0 / (3.0 * std::f64::consts::PI * a.powi(3)));
    }

    #[test]
    fn equal_differences_need_no_test() {
        assert_eq!(paired_t(&[0.125; 20]).growth, 0.0);
        assert_eq!(paired_t(&[-0.125; 20]).fall, 0.0);
        assert_eq!(paired_t(&[0.0; 20]), PValues::NONE);
        assert_eq!(paired_t(&[0.3]), PValues::NONE);
    }

    #[test]
    fn signs_are_counted_exactly() {
        assert_eq!(sign_test(0, 0), PValues::NONE);
        close(sign_test(9, 1).growth, 11.0 / 1024.0);
        close(sign_test(1, 9).fall, 11.0 / 1024.0);
        close(sign_test(40, 0).growth, 0.5_f64.powi(40));
        assert_eq!(sign_test(0, 5).growth, 1.0);
    }
}
