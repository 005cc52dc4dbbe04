//! By chance: how well dots that are none of a pattern's agree with one of its places.

/// Logarithms of binomial coefficients.
pub(super) struct Binomial(Vec<f64>);

impl Binomial {
    /// For up to `most` trials.
    pub(super) fn new(most: usize) -> Self {
        let mut sums = vec![0.0];
        for number in 1..=most {
            sums.push(sums[number - 1] + (number as f64).ln());
        }
        Self(sums)
    }

    fn ln_choose(&self, count: usize, of: usize) -> f64 {
        self.0[of] - self.0[count] - self.0[of - count]
    }

    /// The probability that at most `wrong` of `of` fair coins disagree.
    pub(super) fn chance(&self, wrong: usize, of: usize) -> f64 {
        let fair = of as f64 * 2_f64.ln();
        (0..=wrong.min(of)).map(|wrong| (self.ln_choose(wrong, of) - fair).exp()).sum()
    }

    /// The likelihood of a place with `wrong` of `of` dots misread, up to a factor that is the same for all places: the share of misread dots is not known, and any
    /// up to a half is as likely as another. (The integral of `e^wrong (1 - e)^right` over all shares is one over the binomial coefficient.)
    pub(super) fn likelihood(&self, wrong: usize, of: usize) -> f64 {
        (-self.ln_choose(wrong.min(of / 2), of)).exp()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chances_are_those_of_coins() {
        let binomial = Binomial::new(60);
        assert!((binomial.chance(1, 4) - 5.0 / 16.0).abs() < 1e-12);
        assert!((binomial.chance(4, 4) - 1.0).abs() < 1e-12);
        assert!((binomial.chance(0, 30) / 0.5_f64.powi(30) - 1.0).abs() < 1e-9);
        assert!((binomial.likelihood(2, 30) - 1.0 / 435.0).abs() < 1e-12);
        assert_eq!(binomial.likelihood(25, 30), binomial.likelihood(15, 30), "no dots are misread more often than not");
    }
}
