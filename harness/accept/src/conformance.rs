//! Whether a value keeps a limit, of which more or less is known.

use statrs::distribution::{ContinuousCDF, Normal};

use crate::Decision;

/// The probability, 0 to 1, that a quantity lies within `-limit` and `limit`, where it was found as `value` with the standard uncertainty `sigma`: normal, in one
/// unit. Without uncertainty it is 1 or 0.
///
/// Source: JCGM 106:2012, section 7, for a symmetric interval of tolerance.
pub fn conformance_probability(value: f64, sigma: f64, limit: f64) -> f64 {
    if sigma > 0.0 {
        let beyond = |room: f64| Normal::standard().sf(room / sigma);
        1.0 - beyond(limit - value.abs()) - beyond(limit + value.abs())
    } else {
        f64::from(value.abs() <= limit)
    }
}

/// When a value is taken as within or beyond a limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rule {
    /// Where it is within, or beyond, at this probability at least, 0.5 to 1.
    Probability(f64),
    /// Where it is within, or beyond, by so many standard uncertainties; 0 takes values as they are.
    GuardBand(f64),
}

impl Rule {
    /// The rule where none other is agreed: 95 %, which is a guard band of 1.65 standard uncertainties where these are small beside the limit.
    ///
    /// Source: ISO 14253-1:2017, by ILAC-G8:09/2019, table 1.
    pub const DEFAULT: Self = Self::Probability(0.95);

    /// Of a value with a standard uncertainty and the limit of its size, in one unit.
    pub fn decide(self, value: f64, sigma: f64, limit: f64) -> Decision {
        let (within, beyond) = match self {
            Self::Probability(least) => {
                let probability = conformance_probability(value, sigma, limit);
                (probability >= least, 1.0 - probability >= least)
            }
            Self::GuardBand(factor) => (value.abs() <= limit - factor * sigma, value.abs() > limit + factor * sigma),
        };
        match (within, beyond) {
            (true, _) => Decision::Pass,
            (_, true) => Decision::Fail,
            _ => Decision::CannotTell,
        }
    }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    use super::*;

    /// What lies within 9 and 11: a mean and a standard deviation, and the share beyond, of a worksheet.
    ///
    /// Source: the tests of Sandia's uncertainty calculator (sandialabs/suncal, test/test_risk.py, `test_cpk`), which hold it against a spreadsheet of others.
    const PUBLISHED: [(f64, f64, f64); 3] = [(10.0, 0.4, 0.01242), (10.5, 0.4, 0.10574), (12.0, 0.4, 0.99379)];

    /// A guard band in expanded uncertainties (k = 2), and the printed bound of the probability that what just passes does not conform.
    ///
    /// Source: ILAC-G8:09/2019, table 1 (6 sigma, 3 sigma, ILAC-G8:2009, ISO 14253-1:2017, simple acceptance).
    const GUARD_BANDS: [(f64, f64); 5] = [(3.0, 1e-6), (1.5, 0.0016), (1.0, 0.025), (0.83, 0.05), (0.0, 0.5)];

    #[test]
    fn published_shares_come_back() {
        for (mean, sigma, beyond) in PUBLISHED {
            let ours = 1.0 - conformance_probability(mean - 10.0, sigma, 1.0);
            assert!((ours - beyond).abs() <= 0.000_006, "{mean}: {ours} and {beyond}");
        }
    }

    #[test]
    fn published_guard_bands_bound_the_risk_that_is_printed_with_them() {
        let mut before = 0.0;
        for (expanded, bound) in GUARD_BANDS {
            // An upper limit alone: the lower one is far.
            let (limit, sigma) = (1000.0, 1.0);
            let accepted = limit - 2.0 * expanded * sigma;
            let risk = 1.0 - conformance_probability(accepted, sigma, limit);
            // No more than is printed, and no better than the row above.
            assert!(risk <= bound + 1e-12 && risk > before, "{expanded} U: {risk} and {bound}");
            before = risk;
            let guard = Rule::GuardBand(2.0 * expanded);
            assert_eq!(guard.decide(accepted, sigma, limit), Decision::Pass);
            assert_ne!(guard.decide(accepted + 1e-6, sigma, limit), Decision::Pass);
        }
        // 95 % and a guard band of 1.65 standard uncertainties are one rule where the limit is far, to the digits of 1.65.
        for (off, decision) in
            [(-1.66, Decision::Pass), (-1.63, Decision::CannotTell), (1.63, Decision::CannotTell), (1.66, Decision::Fail)]
        {
            assert_eq!(Rule::DEFAULT.decide(-1000.0 - off, 1.0, 1000.0), decision, "{off}");
        }
    }

    /// By hand: of a standard uncertainty as large as the limit 68.3 % at most is within, which is nowhere 95 %.
    #[test]
    fn what_is_known_too_little_never_passes() {
        assert!((conformance_probability(0.0, 1.0, 1.0) - 0.682_689_492_137).abs() < 1e-9);
        for (value, decision) in [(0.0, Decision::CannotTell), (2.0, Decision::CannotTell), (2.7, Decision::Fail)] {
            assert_eq!(Rule::DEFAULT.decide(value, 1.0, 1.0), decision, "{value}");
        }
        assert_eq!(Rule::GuardBand(2.0).decide(0.0, 1.0, 1.0), Decision::CannotTell);
        // Without uncertainty a value is its own truth.
        for (value, decision) in [(1.0, Decision::Pass), (-1.0, Decision::Pass), (1.0 + 1e-12, Decision::Fail)] {
            assert_eq!(Rule::DEFAULT.decide(value, 0.0, 1.0), decision);
            assert_eq!(Rule::GuardBand(2.0).decide(value, 0.0, 1.0), decision);
        }
    }

    /// Of drawn truths about a value so many are within the limit as its probability says; of what passes 95 in 100 or more are, of what fails 5 or fewer.
    #[test]
    fn drawn_truths_are_within_as_often_as_the_probability_says() {
        const DRAWS: usize = 20_000;
        let mut random = ChaCha8Rng::seed_from_u64(14253);
        for (value, sigma) in [(0.0, 0.3), (0.5, 0.3), (0.8, 0.3), (1.0, 0.3), (1.2, 0.7), (-0.6, 1.5), (-1.6, 0.3)] {
            let truths = (0..DRAWS).map(|_| value + sigma * Distribution::<f64>::sample(&StandardNormal, &mut random));
            let share = truths.filter(|truth| truth.abs() <= 1.0).count() as f64 / DRAWS as f64;
            let expected = conformance_probability(value, sigma, 1.0);
            let scatter = (expected * (1.0 - expected) / DRAWS as f64).sqrt();
            assert!((share - expected).abs() <= 4.0 * scatter + 1e-9, "{value}, {sigma}: {share} and {expected}");
            match Rule::DEFAULT.decide(value, sigma, 1.0) {
                Decision::Pass => assert!(expected >= 0.95),
                Decision::Fail => assert!(expected <= 0.05),
                Decision::CannotTell => assert!(expected > 0.05 && expected < 0.95),
            }
        }
    }

    /// A truth at the very limit passes in 5 of 100 measurements and fails in 5; one half way inside passes as the distance to the guard band says.
    #[test]
    fn decisions_come_as_often_as_their_risks_say() {
        const DRAWS: usize = 20_000;
        let (limit, sigma) = (1.0, 0.1);
        let mut random = ChaCha8Rng::seed_from_u64(2634);
        for (truth, pass, fail) in
            [(1.0, 0.05, 0.05), (0.9, Normal::standard().cdf(1.0 - 1.644_854), Normal::standard().sf(1.0 + 1.644_854)), (0.5, 1.0, 0.0)]
        {
            let mut counts = [0_usize; 2];
            for _ in 0..DRAWS {
                let value = truth + sigma * Distribution::<f64>::sample(&StandardNormal, &mut random);
                let decision = Rule::DEFAULT.decide(value, sigma, limit);
                counts[0] += usize::from(decision == Decision::Pass);
                counts[1] += usize::from(decision == Decision::Fail);
            }
            for (count, expected) in counts.into_iter().zip([pass, fail]) {
                let share = count as f64 / DRAWS as f64;
                let scatter = (expected * (1.0 - expected) / DRAWS as f64).sqrt();
                assert!((share - expected).abs() <= 4.0 * scatter + 1e-3, "{truth}: {share} and {expected}");
            }
        }
    }
}
