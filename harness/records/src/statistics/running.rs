//! Sums over trials, paired with those of a reference method.

use statrs::distribution::{ContinuousCDF, StudentsT};

/// Mean and scatter of a row of numbers, whatever their count, in the unit of the numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Running {
    /// The number of values.
    pub count: u64,
    /// Their mean.
    pub mean: f64,
    /// Sum of squared deviations from the mean.
    squares: f64,
}

/// The 97.5 % quantile of Student's distribution, in standard deviations, for a scatter that comes from `count` numbers; `None` of fewer than two.
pub fn two_sided_95(count: u64) -> Option<f64> {
    Some(StudentsT::new(0.0, 1.0, count.checked_sub(1)? as f64).ok()?.inverse_cdf(0.975))
}

impl Running {
    /// Adds a number (Welford 1962).
    pub fn add(&mut self, value: f64) {
        self.count += 1;
        let off = value - self.mean;
        self.mean += off / self.count as f64;
        self.squares += off * (value - self.mean);
    }

    /// Standard deviation of a single number; `None` for fewer than two.
    pub fn deviation(&self) -> Option<f64> {
        (self.count > 1).then(|| (self.squares / (self.count - 1) as f64).sqrt())
    }

    /// Half the 95 % interval of the mean.
    pub fn half(&self) -> Option<f64> {
        Some(two_sided_95(self.count)? * self.deviation()? / (self.count as f64).sqrt())
    }

    /// The mean, unless there is no number.
    pub fn mean(&self) -> Option<f64> {
        (self.count > 0).then_some(self.mean)
    }
}

/// Squared errors of two methods in the same trials: the ratio of their root mean squares.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Paired {
    own: Running,
    reference: Running,
    /// Sum of products of deviations.
    product: f64,
}

impl Paired {
    /// Adds the errors of a trial, both in one unit.
    pub fn add(&mut self, own: f64, reference: f64) {
        let (a, b) = (own * own, reference * reference);
        let off = a - self.own.mean;
        self.own.add(a);
        self.reference.add(b);
        self.product += off * (b - self.reference.mean);
    }

    /// `sqrt(mean(a^2) / mean(b^2))`, a number, and half its 95 % interval by the delta method, the covariance of the two taken into account.
    pub fn ratio(&self) -> Option<(f64, Option<f64>)> {
        if self.own.count == 0 || self.reference.mean <= 0.0 {
            return None;
        }
        let (a, b) = (self.own.mean, self.reference.mean);
        let ratio = (a / b).sqrt();
        let half = match (self.own.deviation(), self.reference.deviation()) {
            (Some(da), Some(db)) if a > 0.0 => {
                let n = self.own.count as f64;
                let covariance = self.product / (n - 1.0);
                let relative = (da / a).powi(2) + (db / b).powi(2) - 2.0 * covariance / (a * b);
                two_sided_95(self.own.count).map(|t| t * 0.5 * ratio * (relative.max(0.0) / n).sqrt())
            }
            _ => None,
        };
        Some((ratio, half))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_that_are_carried_along_are_those_of_the_whole_row() {
        let row = [3.0, -1.0, 4.5, 2.25, 0.5];
        let mut running = Running::default();
        row.iter().for_each(|&value| running.add(value));
        let mean = row.iter().sum::<f64>() / 5.0;
        // The table of Student's distribution has 2.776 for four degrees of freedom.
        assert!((running.half().unwrap() / running.deviation().unwrap() * 5.0_f64.sqrt() - 2.776).abs() < 1e-3);
        let variance = row.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / 4.0;
        assert!((running.mean - mean).abs() < 1e-15 && (running.deviation().unwrap() - variance.sqrt()).abs() < 1e-15);
    }

    #[test]
    fn a_ratio_is_exact_where_one_row_is_a_multiple_of_the_other_and_covers_the_truth_elsewhere() {
        let mut multiple = Paired::default();
        (1..9).for_each(|i| multiple.add(0.7 * f64::from(i), f64::from(i)));
        let (ratio, half) = multiple.ratio().unwrap();
        assert!((ratio - 0.7).abs() < 1e-14 && half.unwrap() < 1e-7);
        // Errors of two normal methods, 0.6 against 1, from a low-discrepancy sequence through Box and Muller: the interval covers in about 95 of 100.
        let normal = |i: u32, k: u32| {
            let (u, v) = (
                (f64::from(i) * 0.754_877_666 + f64::from(k) * 0.1234).fract(),
                (f64::from(i) * 0.569_840_290 + f64::from(k) * 0.377).fract(),
            );
            (-2.0 * (u + 1e-12).ln()).sqrt() * (std::f64::consts::TAU * v).cos()
        };
        let covered = (0..200).filter(|run| {
            let mut paired = Paired::default();
            (0..100).for_each(|i| paired.add(0.6 * normal(run * 977 + i, 1), normal(run * 977 + i * 7 + 3, 2)));
            let (ratio, half) = paired.ratio().unwrap();
            (ratio - 0.6).abs() < half.unwrap()
        });
        assert!(covered.count() > 170);
    }

    /// Squares 1, 4, 9 against 4, 1, 4: means 14/3 and 3, variances 49/3 and 3, covariance 1, so that the relative variance of the ratio of means is
    /// (3/4 + 1/3 - 1/7) / 3; t(0.975, 2) = 4.302653.
    #[test]
    fn the_interval_of_a_ratio_has_the_scatter_of_both_and_what_they_share() {
        let mut paired = Paired::default();
        [(1.0, 2.0), (-2.0, 1.0), (3.0, -2.0)].into_iter().for_each(|(own, reference)| paired.add(own, reference));
        let (ratio, half) = paired.ratio().unwrap();
        assert!((ratio - 1.247_219_129).abs() < 1e-9, "sqrt(14 / 9): {ratio}");
        assert!((half.unwrap() / 1.502_319_6 - 1.0).abs() < 1e-6, "{half:?}");
        // A reference that scatters alone: half = t / 2 * ratio * (s / mean) / sqrt(n).
        let mut alone = Paired::default();
        [1.0, 2.0, 3.0].into_iter().for_each(|reference| alone.add(1.0, reference));
        let (ratio, half) = alone.ratio().unwrap();
        assert!((ratio - (3.0_f64 / 14.0).sqrt()).abs() < 1e-12);
        let by_hand = 4.302_652_73 / 2.0 * ratio * ((49.0_f64 / 3.0).sqrt() / (14.0 / 3.0)) / 3.0_f64.sqrt();
        assert!((half.unwrap() / by_hand - 1.0).abs() < 1e-6, "{half:?} {by_hand}");
    }

    #[test]
    fn a_ratio_of_nothing_is_none_and_one_trial_has_no_interval() {
        assert_eq!(Paired::default().ratio(), None);
        let mut zero = Paired::default();
        zero.add(1.0, 0.0);
        assert_eq!(zero.ratio(), None, "nothing is a multiple of an exact method");
        let mut one = Paired::default();
        one.add(3.0, 2.0);
        assert_eq!(one.ratio(), Some((1.5, None)));
        let mut exact = Paired::default();
        [1.0, 2.0].into_iter().for_each(|reference| exact.add(0.0, reference));
        assert_eq!(exact.ratio(), Some((0.0, None)));
        assert_eq!((Running::default().mean(), Running::default().deviation(), Running::default().half()), (None, None, None));
    }
}
