//! Poisson's numbers of small and changing means, exact to the rounding of f64.
//!
//! The number of mean n + d, n whole and d below 1, is the sum of independent ones of mean n and of mean d. The first is looked up in the table of its
//! distribution function, the second takes a step or two: each pixel may have its own mean without paying for a set-up.

use std::sync::LazyLock;

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::Rng;
use rand_distr::{Distribution, Poisson};

/// Means up to here are tabulated.
const TABULATED: usize = 100;
const GUIDES: usize = 256;

static TABLES: LazyLock<Vec<Table>> = LazyLock::new(|| (0..=TABULATED).map(Table::of_mean).collect());

/// The distribution of one whole mean.
struct Table {
    /// Probability of at most k, until it is 1 to the rounding of f64.
    cumulated: Vec<f64>,
    /// The least number that a uniform one from i / GUIDES on can stand for.
    guide: [u8; GUIDES],
}

impl Table {
    fn of_mean(mean: usize) -> Self {
        let mean = mean as f64;
        let (mut cumulated, mut probability, mut sum) = (Vec::new(), (-mean).exp(), 0.0);
        // Beyond mean + 12 sqrt(mean) + 20 there is less than 1e-17.
        for k in 0..(mean + 12.0 * mean.sqrt() + 20.0) as u32 {
            sum += probability;
            cumulated.push(sum);
            probability *= mean / f64::from(k + 1);
        }
        let guide = std::array::from_fn(|i| cumulated.partition_point(|&below| below <= i as f64 / GUIDES as f64) as u8);
        Self { cumulated, guide }
    }

    fn sample(&self, uniform: f64) -> usize {
        let from = usize::from(self.guide[(uniform * GUIDES as f64) as usize]);
        let more = self.cumulated[from.min(self.cumulated.len())..].iter().take_while(|&&below| below <= uniform);
        from + more.count()
    }
}

/// A Poisson number of `mean`; 0 if that is not positive.
pub(super) fn poisson(mean: f32, rng: &mut ChaCha8Rng) -> f32 {
    if mean <= 0.0 {
        return 0.0;
    }
    match TABLES.get(mean as usize) {
        Some(table) => (table.sample(uniform(rng)) + below_one(f64::from(mean.fract()), uniform(rng))) as f32,
        None => Poisson::new(f64::from(mean)).map_or(0.0, |poisson| poisson.sample(rng)) as f32,
    }
}

/// The number of a mean below 1 by its distribution function's inverse.
fn below_one(mean: f64, uniform: f64) -> usize {
    let (mut probability, mut k) = ((-mean).exp(), 0);
    let mut sum = probability;
    // The twentieth term is below 1e-18.
    while uniform >= sum && k < 20 {
        k += 1;
        probability *= mean / k as f64;
        sum += probability;
    }
    k
}

/// From 0 to below 1, 53 bits.
fn uniform(rng: &mut ChaCha8Rng) -> f64 {
    (rng.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
}

#[cfg(test)]
mod tests {
    use rand_chacha::rand_core::SeedableRng;
    use statrs::distribution::{ChiSquared, ContinuousCDF, Discrete, Poisson as Theory};

    use super::*;

    #[test]
    fn a_million_numbers_of_each_mean_follow_the_distribution() {
        let means = [0.01_f32, 0.3, 0.999, 1.0, 2.5, 7.77, 20.0, 42.6, 99.5, 100.99, 101.3, 500.0];
        let mut least: f64 = 1.0;
        for (i, mean) in means.into_iter().enumerate() {
            let (n, mut rng) = (1_000_000, ChaCha8Rng::seed_from_u64(40 + i as u64));
            let mut counts = vec![0_u32; 1000];
            (0..n).for_each(|_| counts[poisson(mean, &mut rng) as usize] += 1);
            least = least.min(fit(&counts, f64::from(mean), f64::from(n)));
        }
        // Twelve tests share one chance in a thousand.
        assert!(least > 1e-3 / means.len() as f64, "{least:e}");
    }

    /// Probability of a chi-square as large as the counts', cells of fewer than ten expected numbers put together.
    fn fit(counts: &[u32], mean: f64, n: f64) -> f64 {
        let theory = Theory::new(mean).unwrap();
        let (mut chi2, mut cells) = (0.0, 0);
        let mut rest = [0.0; 2];
        for (k, &count) in counts.iter().enumerate() {
            let cell = [rest[0] + f64::from(count), rest[1] + n * theory.pmf(k as u64)];
            if cell[1] < 10.0 {
                rest = cell;
            } else {
                rest = [0.0; 2];
                chi2 += (cell[0] - cell[1]).powi(2) / cell[1];
                cells += 1;
            }
        }
        assert!(rest[1] < 10.0 && rest[0] < 40.0, "the tail of {mean} holds {} for {}", rest[0], rest[1]);
        if cells < 2 { 1.0 } else { ChiSquared::new(f64::from(cells - 1)).unwrap().sf(chi2) }
    }

    #[test]
    fn no_light_no_electron() {
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        assert_eq!([0.0, -1.0, f32::NAN].map(|mean| poisson(mean, &mut rng)), [0.0; 3]);
    }
}
